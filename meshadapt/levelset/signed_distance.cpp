#include "ductile/meshadapt/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/surface.hpp"
#include "mesh/wording.hpp"
#include "transfer/locator.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// References of the facets of the part of a mesh that is inside.
constexpr std::int32_t interface = 1, domain_boundary = 2;

template <int Dim>
class DistanceToInterface {
 public:
  DistanceToInterface(const Executor& executor, const AnyMesh& any,
                      const SignedDistanceOptions& options)
      : executor_(executor),
        any_(any),
        mesh_(make_fixed_mesh<Dim>(executor, any)),
        on_interface_(mesh_.vertex_count()) {
    mark_inside(options.inside);
    make_sheets(part_inside(), options);
  }

  std::vector<double> at_vertices() const {
    std::vector<double> distance_of(mesh_.vertex_count());
    std::unique_ptr<Locator<Dim>> locator;
    if (has_unused_vertices()) locator = std::make_unique<Locator<Dim>>(executor_, mesh_);
    runtime::parallel_for(executor_, distance_of.size(), [&](std::size_t v) {
      const auto around = mesh_.elements_of(static_cast<VertexId>(v));
      const Vector<Dim>& point = mesh_.position_of[v];
      if (around.empty())
        distance_of[v] = at(point, locator->find(point, none).element);
      else if (on_interface_[v] == 0)
        distance_of[v] = (is_inside_[around[0]] != 0 ? -1 : 1) * nearest(point).distance;
    });
    return distance_of;
  }

  std::vector<double> at_points(std::span<const double> coordinates) const {
    if (coordinates.size() % Dim != 0)
      throw InputError("points: expected " + std::to_string(Dim) + " coordinates for each, found " +
                       std::to_string(coordinates.size()) + " numbers");
    const std::size_t bad = first_bad(executor_, coordinates.size(), [&](std::size_t i) {
      return !(std::abs(coordinates[i]) <= 1e150);
    });
    if (bad != no_index)
      refuse(entry("points", "coordinate", bad) + ": expected a number within 1e150 of 0, found " +
             number(coordinates[bad]));
    std::vector<double> distance_at(coordinates.size() / Dim);
    const Locator<Dim> locator(executor_, mesh_);
    walk_in_blocks(executor_, distance_at.size(), [&](std::size_t i, ElementId near) {
      Vector<Dim> point;
      std::copy_n(&coordinates[i * Dim], Dim, point.x.begin());
      const ElementId element = locator.find(point, near).element;
      distance_at[i] = at(point, element);
      return element;
    });
    return distance_at;
  }

 private:
  void mark_inside(const std::vector<std::int32_t>& references) {
    const auto& reference_of = elements_in<Dim>(any_).reference;
    for (const std::int32_t reference : references)
      if (std::find(reference_of.begin(), reference_of.end(), reference) == reference_of.end())
        throw InputError(name_of(any_) + ": no element has the reference " +
                         std::to_string(reference) + ", which is to be inside");
    is_inside_.resize(reference_of.size());
    runtime::parallel_for(executor_, is_inside_.size(), [&](std::size_t e) {
      is_inside_[e] = std::count(references.begin(), references.end(), reference_of[e]) > 0;
    });
  }

  /// The elements inside, as a mesh of their own. Marks the vertices of the interface.
  AnyMesh part_inside() {
    AnyMesh part;
    part.dimension = Dim;
    part.name = any_.name;
    part.coordinates = any_.coordinates;
    part.vertex_reference.resize(any_.vertex_count());
    for (std::size_t e = 0; e < is_inside_.size(); ++e) {
      if (is_inside_[e] == 0) continue;
      elements_in<Dim>(part).add(mesh_.corners_of[e], 1);
      for (std::size_t i = 0; i <= Dim; ++i) {
        const ElementId other = mesh_.neighbour_of[e][i];
        if (other != none && is_inside_[other] != 0) continue;
        const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], static_cast<int>(i));
        facets_in<Dim>(part).add(facet, other != none ? interface : domain_boundary);
        for (const VertexId v : facet)
          if (other != none) on_interface_[v] = 1;
      }
    }
    for (const auto& listed : {any_.corners, any_.required_vertices})
      for (const std::uint32_t v : listed)
        if (v < on_interface_.size() && on_interface_[v] != 0) part.corners.push_back(v);
    if (std::count(on_interface_.begin(), on_interface_.end(), 1) == 0)
      throw InputError(name_of(any_) +
                       ": expected facets between elements inside and others, found none");
    return part;
  }

  double mean_edge(const AnyMesh& part) const {
    double sum = 0, count = 0;
    const auto& facets = facets_in<Dim>(part);
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (std::size_t i = 1; i < Dim && facets.reference[f] == interface; ++i, ++count)
        sum += norm(mesh_.position_of[facets.vertices[f][i]] -
                    mesh_.position_of[facets.vertices[f][i - 1]]);
    return sum / count;
  }

  void make_sheets(const AnyMesh& part, const SignedDistanceOptions& options) {
    constexpr double share = 0.1;
    MakeMeshOptions make;
    make.hausdorff_tolerance = tolerance_ =
        options.tolerance != 0 ? options.tolerance : share * mean_edge(part);
    make.ridge_angle = options.ridge_angle;
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    const Mesh<Dim> curved = make_mesh<Dim>(executor_, part, make, neighbours, warnings);
    surface_ = curved.surface;
    if (surface_) {
      for (const Patch<Dim>& patch : curved.patches)
        is_wanted_.push_back(patch.reference == interface ? 1 : 0);
      sheets_ = &surface_->facets;
      return;
    }
    std::vector<typename Sheets<Dim, Dim>::Part> flat;
    const auto& facets = facets_in<Dim>(part);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (facets.reference[f] != interface) continue;
      flat.push_back({{}, 0, false, {}});
      for (std::size_t i = 0; i < Dim; ++i)
        flat.back().corner[i] = mesh_.position_of[facets.vertices[f][i]];
    }
    is_wanted_ = {1};
    flat_ = std::make_unique<const Sheets<Dim, Dim>>(flat, tolerance_);
    sheets_ = flat_.get();
  }

  bool has_unused_vertices() const {
    return first_bad(executor_, mesh_.vertex_count(), [&](std::size_t v) {
             return mesh_.elements_of(static_cast<VertexId>(v)).empty();
           }) != no_index;
  }

  auto nearest(const Vector<Dim>& point) const { return *sheets_->nearest(point, is_wanted_); }

  /// Close to a facet, the point may be between it and the curved surface, on the other side of
  /// which the elements are: then the surface's normal tells the side.
  double at(const Vector<Dim>& point, ElementId element) const {
    constexpr double steep = 0.7;
    const auto there = nearest(point);
    bool inside = is_inside_[element] != 0;
    const double along = dot(point - there.point, there.direction);
    if (there.distance <= tolerance_ && std::abs(along) >= steep * there.distance)
      inside = along < 0;
    return inside ? -there.distance : there.distance;
  }

  const Executor& executor_;
  const AnyMesh& any_;
  FixedMesh<Dim> mesh_;
  std::vector<std::uint8_t> is_inside_;     // [element]
  std::vector<std::uint8_t> on_interface_;  // [vertex]
  double tolerance_ = 0;
  std::shared_ptr<const Surface<Dim>> surface_;   // null if nothing is curved
  std::unique_ptr<const Sheets<Dim, Dim>> flat_;  // then these
  const Sheets<Dim, Dim>* sheets_ = nullptr;      // either
  std::vector<std::uint8_t> is_wanted_;           // [sheet], 1: of the interface
};

template <int Dim>
std::vector<double> distances(const Executor& executor, const AnyMesh& mesh,
                              const SignedDistanceOptions& options,
                              std::span<const double> points) {
  const DistanceToInterface<Dim> distance(executor, mesh, options);
  return points.data() == nullptr ? distance.at_vertices() : distance.at_points(points);
}

}  // namespace

std::vector<double> signed_distance(const Executor& executor, const AnyMesh& mesh,
                                    const SignedDistanceOptions& options,
                                    std::span<const double> points) {
  return runtime::with_team(executor, [&] {
    return mesh.dimension == 2 ? distances<2>(executor, mesh, options, points)
                               : distances<3>(executor, mesh, options, points);
  });
}

}  // namespace ductile::meshadapt
