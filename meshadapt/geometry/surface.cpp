#include "geometry/surface.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/boundary_parts.hpp"
#include "geometry/divided.hpp"
#include "geometry/projection.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
class SurfaceMaker {
 public:
  SurfaceMaker(const BoundaryParts<Dim>& parts, std::span<const CurveEdge> edges)
      : parts_(parts), mesh_(parts.mesh), facets_(parts.facets), edges_(edges) {}

  std::shared_ptr<const Surface<Dim>> make() const {
    ModelInput<Dim> input = model_input();
    SmoothModel<Dim> model(parts_.executor, input);
    hold_facing(input, model);
    std::vector<typename Sheets<Dim, Dim>::Part> facet_parts(facets_.size());
    runtime::parallel_for(parts_.executor, facets_.size(), [&](std::size_t f) {
      const auto i = static_cast<std::uint32_t>(f);
      facet_parts[f] = {points(corners(facets_[f])), facets_[f].patch, facets_[f].other != none,
                        parts_.is_noise(i) ? parts_.noise_normals[f] : Vector<Dim>{}};
    });
    std::vector<typename Sheets<Dim, 2>::Part> edge_parts;
    typename SmoothModel<Dim>::template Pieces<2> edge_pieces;
    std::vector<typename Samples<Dim, 2>::Facet> sampled_edges;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!mesh_.curves[edges_[e].curve].smooth) continue;
      edge_parts.push_back(
          {points(std::array{edges_[e].a, edges_[e].b}), edges_[e].curve, true, {}});
      edge_pieces.push_back(model.edges[e]);
      sampled_edges.push_back(model.edge_samples.facets[e]);
    }
    model.edge_samples.facets = std::move(sampled_edges);
    model.edge_samples.connect();
    model.facet_samples.connect();
    const auto on_patches =
        projections_of_patches(mesh_, parts_.options.functions, {reach(), parts_.within.surface});
    expect_on(on_patches);
    const double tolerance = parts_.within.surface;
    return std::shared_ptr<const Surface<Dim>>(new Surface<Dim>{
        {parts_.executor,
         {facet_parts, tolerance, model.facets, on_patches, parts_.within.least_turn}},
        {parts_.executor, {edge_parts, tolerance, edge_pieces, on_curves(on_patches)}},
        std::move(model.facet_samples),
        std::move(model.edge_samples)});
  }

 private:
  /// Outwards, however the file has them.
  Facet<Dim> corners(const TaggedFacet<Dim>& facet) const {
    return facet_of<Dim>(mesh_.corners_of[facet.element], facet.facet);
  }

  // ---- Surfaces that are functions ----

  /// How far points of the model may be from them: as far as its largest facet goes, because that
  /// may be part of a small ball.
  double reach() const {
    double longest = 0;
    if (parts_.options.functions.empty()) return longest;
    for (const TaggedFacet<Dim>& facet : facets_) {
      const auto p = points(facet.corners);
      for (std::size_t i = 1; i < p.size(); ++i) longest = std::max(longest, norm(p[i] - p[i - 1]));
    }
    return longest + fitting * parts_.within.surface;
  }

  /// Throws InputError unless the vertices of the mesh are on them, where they are known.
  void expect_on(const std::vector<Projection<Dim>>& on_patches) const {
    if (on_patches.empty()) return;
    for (const TaggedFacet<Dim>& facet : facets_) {
      if (!on_patches[facet.patch]) continue;
      for (const VertexId v : facet.corners) {
        const Vector<Dim>& at = mesh_.site_of[v].position;
        const double distance = norm(on_patches[facet.patch](at) - at);
        if (distance > fitting * parts_.within.surface)
          throw InputError("the function of the surface with the reference " +
                           std::to_string(facet.data.reference) + ": expected vertex " +
                           std::to_string(v + 1) + " of its facets within " +
                           number(fitting * parts_.within.surface) + " of it, found " +
                           number(distance));
      }
    }
  }

  std::vector<Projection<Dim>> on_curves(const std::vector<Projection<Dim>>& on_patches) const {
    if constexpr (Dim == 3) return projections_of_curves(mesh_, on_patches, edges_);
    return {};
  }

  /// The unit normal of a facet of the model.
  Vector<Dim> direction(std::uint32_t facet) const {
    return parts_.is_noise(facet) ? parts_.noise_normals[facet]
                                  : direction_of(points(corners(facets_[facet])));
  }

  template <std::size_t N>
  std::array<Vector<Dim>, N> points(const std::array<VertexId, N>& vertices) const {
    std::array<Vector<Dim>, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = parts_.place(vertices[i]);
    return result;
  }

  bool is_denoised(const Facet<Dim>& corners) const {
    return std::any_of(corners.begin(), corners.end(),
                       [&](VertexId v) { return parts_.is_denoised(v); });
  }

  ModelInput<Dim> model_input() const {
    ModelInput<Dim> input;
    std::tie(input.flat, input.tolerance, input.least_turn) =
        std::tie(parts_.within.flat, parts_.within.surface, parts_.within.least_turn);
    std::vector<std::uint32_t> number_of(mesh_.vertex_slots(), none);
    const auto number = [&](VertexId v) {
      if (number_of[v] == none) {
        number_of[v] = static_cast<std::uint32_t>(input.points.size());
        input.points.push_back(parts_.place(v));
        input.ends.push_back(mesh_.kind_of[v].corner ? 1 : 0);
      }
      return number_of[v];
    };
    input.facets.reserve(facets_.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      ModelFacet<Dim> facet{corners(facets_[f]), facets_[f].patch, parts_.plane_of[f],
                            mesh_.patches[facets_[f].patch].smooth};
      if (facet.smooth && is_denoised(facet.corner))
        facet.plane = static_cast<std::uint32_t>(mesh_.patches.size() + f);  // no longer that
      for (std::uint32_t& corner : facet.corner) corner = number(corner);
      input.facets.push_back(facet);
    }
    for (const CurveEdge& edge : edges_) {
      const Curve& curve = mesh_.curves[edge.curve];
      input.edges.push_back({{number(edge.a), number(edge.b)}, curve.smooth, curve.ridge});
    }
    return input;
  }

  /// Holds facets of which the model might come close to what they face, across a gap or a thin
  /// part of the domain: at least half of the way there is shall remain. Walls whose two sides,
  /// not joined smoothly at a nose, bend the same way keep it. A facet that is held takes the bend
  /// of those around it away, so this is asked again; the last time walls do not count.
  void hold_facing(ModelInput<Dim>& input, SmoothModel<Dim>& model) const {
    constexpr int rounds = 4;
    const std::vector<Vector<Dim>> bends = bends_of(model);
    const BoxHierarchy<Dim> index(parts_.executor, facets_.size(), [&](std::size_t f) {
      return box_around(points(corners(facets_[f])));
    });
    for (int round = 1; round <= rounds; ++round) {
      const auto is_wall = [&](std::uint32_t f, std::uint32_t g) {
        return round < rounds && facets_[f].patch != facets_[g].patch &&
               dot(bends[f], bends[g]) > 0;
      };
      const auto is_held = [&](std::size_t at) {
        const auto f = static_cast<std::uint32_t>(at);
        if (!model.facets[f] || facets_[f].other != none) return false;
        const double reach = 4 * bend(*model.facets[f]);
        bool held = input.facets[f].held;
        index.each_meeting(
            grown(box_around(points(corners(facets_[f]))), reach), [&](std::uint32_t g) {
              held =
                  held || (is_facing(f, g, reach) && (!is_wall(f, g) || comes_closer(model, f, g)));
            });
        input.facets[f].held = held;
        return held;
      };
      if (!runtime::parallel_reduce(parts_.executor, facets_.size(), false, is_held,
                                    std::logical_or<>()))
        return;
      model = SmoothModel<Dim>(parts_.executor, input);
    }
  }

  /// The model is no farther than that from the facet.
  static double bend(const CurvedSimplex<Dim, Dim>& piece) {
    double most = 0;
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t j = 0; j < i; ++j) most = std::max(most, piece.bend(i, j));
    return most;
  }

  /// Is another facet turned the other way, not joined to this one, and within reach of it?
  bool is_facing(std::uint32_t facet, std::uint32_t other, double reach) const {
    if (facets_[other].other != none) return false;
    const Facet<Dim> own = corners(facets_[facet]), others = corners(facets_[other]);
    for (const VertexId v : own)
      if (contains(others, v)) return false;
    const auto p = points(own), q = points(others);
    return dot(direction(facet), direction(other)) < -0.01 && gap(p, q) <= reach;
  }

  /// Is there less than half of the way between the models of two facets that is between the
  /// facets?
  bool comes_closer(const SmoothModel<Dim>& model, std::size_t facet, std::uint32_t other) const {
    const auto parts_of = [&](std::size_t f) {
      const auto flat = points(corners(facets_[f]));
      if (!model.facets[f]) return std::vector{flat};
      std::vector<std::array<Vector<Dim>, Dim>> parts;
      Divider<Dim, Dim>(*model.facets[f], parts_.within.surface / 8).each([&](const auto& part) {
        parts.push_back(part.corner);
      });
      return parts;
    };
    const double least =
        0.5 * gap(points(corners(facets_[facet])), points(corners(facets_[other])));
    if (!(least > 1e-6 * parts_.within.surface)) return true;
    const auto own = parts_of(facet), others = parts_of(other);
    return std::any_of(own.begin(), own.end(), [&](const auto& p) {
      return std::any_of(others.begin(), others.end(), [&](const auto& q) {
        return meet(grown(box_around(p), least), box_around(q)) && gap(p, q) < least;
      });
    });
  }

  /// [facet], which way its model bends.
  std::vector<Vector<Dim>> bends_of(const SmoothModel<Dim>& model) const {
    std::vector<Vector<Dim>> bends(facets_.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (!model.facets[f]) continue;
      const CurvedSimplex<Dim, Dim>& piece = *model.facets[f];
      for (std::size_t i = 0; i < Dim; ++i)
        for (std::size_t j = 0; j < Dim; ++j)
          if (i != j)
            bends[f] += piece.control[i][j] - piece.even(piece.corner(i), piece.corner(j));
    }
    return bends;
  }

  /// How far corners, middles of sides, and the centre of each of two facets are from the other.
  static double gap(const std::array<Vector<Dim>, Dim>& p, const std::array<Vector<Dim>, Dim>& q) {
    return std::min(least_distance(p, q), least_distance(q, p));
  }
  static double least_distance(const std::array<Vector<Dim>, Dim>& from,
                               const std::array<Vector<Dim>, Dim>& to) {
    const auto distance = [&](const Vector<Dim>& p) { return norm(closest_point(to, p) - p); };
    Vector<Dim> centre;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < Dim; ++i) {
      centre += (1.0 / Dim) * from[i];
      least = std::min({least, distance(from[i]), distance(0.5 * (from[i] + from[(i + 1) % Dim]))});
    }
    return std::min(least, distance(centre));
  }

  const BoundaryParts<Dim>& parts_;
  const Mesh<Dim>& mesh_;
  std::span<const TaggedFacet<Dim>> facets_;
  std::span<const CurveEdge> edges_;
};

}  // namespace

template <int Dim>
std::shared_ptr<const Surface<Dim>> make_surface(const BoundaryParts<Dim>& parts,
                                                 std::span<const CurveEdge> edges) {
  const auto is_smooth = [](const auto& of) { return of.smooth; };
  const auto& patches = parts.mesh.patches;
  const auto& curves = parts.mesh.curves;
  if (std::none_of(patches.begin(), patches.end(), is_smooth) &&
      std::none_of(curves.begin(), curves.end(), is_smooth))
    return nullptr;
  return SurfaceMaker<Dim>(parts, edges).make();
}

template std::shared_ptr<const Surface<2>> make_surface(const BoundaryParts<2>&,
                                                        std::span<const CurveEdge>);
template std::shared_ptr<const Surface<3>> make_surface(const BoundaryParts<3>&,
                                                        std::span<const CurveEdge>);

}  // namespace ductile::meshadapt
