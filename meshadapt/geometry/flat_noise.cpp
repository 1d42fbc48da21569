#include "geometry/flat_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/rough_parts.hpp"
#include "geometry/rounding.hpp"

namespace ductile::meshadapt {
namespace {

constexpr double flat = 1e-10;  // of the extent

template <int Dim>
class FlatNoise {
 public:
  FlatNoise(const runtime::Executor& executor, const AnyMesh& mesh)
      : mesh_(mesh), extent_(extent()) {
    const Cells<Dim>& cells = facets_in<Dim>(mesh);
    facets_.resize(cells.size());
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      facets_[f].corners = cells.vertices[f];
      facets_[f].data.reference = cells.reference[f];
    }
    find_neighbours(executor);
  }

  double find() const {
    constexpr double in_part = 0.25;  // of the facets
    double largest = 0;
    std::size_t noisy = 0;
    std::vector<std::uint8_t> seen(facets_.size());
    std::vector<std::uint32_t> face;
    for (std::uint32_t seed = 0; seed < facets_.size(); ++seed) {
      if (seen[seed] != 0) continue;
      grow(seed, seen, face);
      const double noise = noise_of(face);
      if (!(noise > 0)) continue;
      noisy += face.size();
      largest = std::max(largest, noise);
    }
    return static_cast<double>(noisy) < in_part * static_cast<double>(facets_.size()) ? 0 : largest;
  }

 private:
  Vector<Dim> place(VertexId v) const {
    Vector<Dim> p;
    for (std::size_t i = 0; i < Dim; ++i) p[i] = mesh_.coordinates[Dim * v + i];
    return p;
  }

  double extent() const {
    double most = 0;
    for (VertexId v = 0; v < mesh_.vertex_count(); ++v)
      most = std::max(most, norm(place(v) - place(0)));
    return most;
  }

  Vector<Dim> normal(std::uint32_t f) const {
    std::array<Vector<Dim>, Dim> p;
    for (std::size_t i = 0; i < Dim; ++i) p[i] = place(facets_[f].corners[i]);
    return facet_normal(p);
  }

  /// Two facets are neighbours where only they meet, if they have one reference and turn little.
  void find_neighbours(const runtime::Executor& executor) {
    std::array<std::uint32_t, Dim> nobody;
    nobody.fill(none);
    across_.assign(facets_.size(), nobody);
    const FacetSides<Dim> sides(executor, facets_.size(),
                                [&](std::size_t f) { return facets_[f].corners; });
    sides.each_run([&](std::span<const FacetSide> both) {
      if (both.size() != 2) return;
      const std::uint32_t f = both[0].facet, g = both[1].facet;
      if (facets_[f].data.reference != facets_[g].data.reference ||
          !turns_by_rounding(normal(f), normal(g)))
        return;
      across_[f][both[0].number] = g;
      across_[g][both[1].number] = f;
    });
  }

  void grow(std::uint32_t seed, std::vector<std::uint8_t>& seen,
            std::vector<std::uint32_t>& face) const {
    face.assign(1, seed);
    seen[seed] = 1;
    for (std::size_t i = 0; i < face.size(); ++i)
      for (const std::uint32_t g : across_[face[i]])
        if (g != none && seen[g] == 0) {
          seen[g] = 1;
          face.push_back(g);
        }
  }

  /// The largest distance of a face from its plane if that is noise; else 0. It is if facets turn
  /// both ways, and neighbours are off each other's planes nearly as far as all are off that of the
  /// face: where it bends, that grows with the square of its size.
  double noise_of(std::span<const std::uint32_t> face) const {
    constexpr std::size_t enough = Dim == 2 ? 12 : 24;  // vertices to tell
    constexpr double coarsest = 1e-3;                   // of the extent
    constexpr double most_times = 2.5;                  // the median of what neighbours are off
    constexpr double least_share = 0.25;                // of facets turning either way
    const std::vector<Vector<Dim>> points = points_of(face);
    if (points.size() < enough) return 0;
    const Flat<Dim> plane = best_plane<Dim>(points);
    double most = 0;
    for (const auto& p : points)
      most = std::max(most, std::abs(dot(p - plane.origin, plane.direction)));
    if (!(most > flat * extent_ && most < coarsest * extent_)) return 0;
    std::vector<double> turns = turns_in(face, plane.direction);
    if (turns.empty()) return 0;
    const auto up = std::count_if(turns.begin(), turns.end(), [](double turn) { return turn > 0; });
    const double share = static_cast<double>(up) / static_cast<double>(turns.size());
    if (share < least_share || share > 1 - least_share) return 0;
    for (double& turn : turns) turn = std::abs(turn);
    const auto middle = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2);
    std::nth_element(turns.begin(), middle, turns.end());
    return most <= most_times * *middle ? most : 0;
  }

  std::vector<Vector<Dim>> points_of(std::span<const std::uint32_t> face) const {
    std::vector<VertexId> vertices;
    for (const std::uint32_t f : face)
      vertices.insert(vertices.end(), facets_[f].corners.begin(), facets_[f].corners.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vector<Dim>> points;
    points.reserve(vertices.size());
    for (const VertexId v : vertices) points.push_back(place(v));
    return points;
  }

  /// How far neighbours are off each other's planes, where they are, by the side of the face to
  /// which they turn.
  std::vector<double> turns_in(std::span<const std::uint32_t> face,
                               const Vector<Dim>& upwards) const {
    std::vector<double> turns;
    for (const std::uint32_t f : face)
      for (const std::uint32_t g : across_[f])
        if (g != none && f < g) {
          const double one = height(f, g, upwards), other = height(g, f, upwards);
          const double turn = std::abs(one) < std::abs(other) ? one : other;
          if (std::abs(turn) > flat * extent_) turns.push_back(turn);
        }
    return turns;
  }

  /// The height of the corner of `other` that is not in `facet` above the plane of `facet`.
  double height(std::uint32_t facet, std::uint32_t other, const Vector<Dim>& upwards) const {
    Vector<Dim> n = normal(facet);
    n *= (dot(n, upwards) < 0 ? -1 : 1) / norm(n);
    for (const VertexId v : facets_[other].corners)
      if (!contains(facets_[facet].corners, v))
        return dot(place(v) - place(facets_[facet].corners[0]), n);
    return 0;
  }

  const AnyMesh& mesh_;
  double extent_;
  std::vector<TaggedFacet<Dim>> facets_;
  std::vector<std::array<std::uint32_t, Dim>> across_;  // [facet][side], the neighbour or none
};

}  // namespace

template <int Dim>
double noise_in_flat_faces(const runtime::Executor& executor, const AnyMesh& mesh) {
  return FlatNoise<Dim>(executor, mesh).find();
}

template double noise_in_flat_faces<2>(const runtime::Executor&, const AnyMesh&);
template double noise_in_flat_faces<3>(const runtime::Executor&, const AnyMesh&);

}  // namespace ductile::meshadapt
