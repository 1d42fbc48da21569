/// @file
/// Finds the parts of the boundary that are flat except for rounding or noise. Where the digits of
/// the coordinates show how they were rounded, what turns by no more than that explains is one part
/// if all of it is then near one plane; if not, it is curved. Where they do not, the noise is
/// measured.
#include <algorithm>
#include <cmath>
#include <functional>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/boundary_parts.hpp"

namespace ductile::meshadapt {
namespace {

template <int Dim>
class FlatParts {
 public:
  using Others = std::array<std::uint32_t, Dim>;
  using Part = std::vector<std::uint32_t>;  // facets

  FlatParts(BoundaryParts<Dim>& parts, std::span<const Others> across)
      : parts_(parts), across_(across) {}

  void find() {
    const bool rough = runtime::parallel_reduce(
        parts_.executor, parts_.facets.size(), false,
        [&](std::size_t f) {
          return is_rough(static_cast<std::uint32_t>(f), [&](std::uint32_t g) { return g > f; });
        },
        std::logical_or<>());
    if (!rough) return;
    if (parts_.rounding_tolerance() > 0) find_rounded();
    if (!(parts_.within.surface > 0)) parts_.rounding->noise = noise();
  }

 private:
  std::array<Vector<Dim>, Dim> corners(std::uint32_t f) const {
    std::array<Vector<Dim>, Dim> p;
    for (std::size_t i = 0; i < p.size(); ++i)
      p[i] = parts_.mesh.site_of[parts_.facets[f].corners[i]].position;
    return p;
  }
  Vector<Dim> normal(std::uint32_t f) const { return facet_normal(corners(f)); }

  bool turn_little(std::uint32_t f, std::uint32_t g) const {
    return turns_by_rounding(normal(f), normal(g));
  }

  /// Is a facet off the plane of a neighbour that counts, though they turn little?
  bool is_rough(std::uint32_t f, auto&& counts) const {
    const auto here = corners(f);
    const Vector<Dim> across = facet_normal(here);
    return std::any_of(across_[f].begin(), across_[f].end(), [&](std::uint32_t g) {
      if (g == none || !counts(g) || !turn_little(f, g)) return false;
      const auto there = corners(g);
      return std::any_of(there.begin(), there.end(), [&](const Vector<Dim>& p) {
        return std::abs(dot(p - here[0], across)) > parts_.within.flat * norm(across);
      });
    });
  }

  /// Calls visit(facets, seed_of) for parts that grow over neighbours for which joins(f, g) holds;
  /// facets of one part have one seed.
  void each_part(auto&& joins, auto&& visit) const {
    std::vector<std::uint32_t> seed_of(parts_.facets.size(), none);
    Part part;
    for (std::uint32_t seed = 0; seed < seed_of.size(); ++seed) {
      if (seed_of[seed] != none) continue;
      part.assign(1, seed);
      seed_of[seed] = seed;
      for (std::size_t i = 0; i < part.size(); ++i)
        for (const std::uint32_t g : across_[part[i]])
          if (g != none && seed_of[g] == none && joins(part[i], g)) {
            seed_of[g] = seed;
            part.push_back(g);
          }
      visit(part, seed_of);
    }
  }

  std::vector<Vector<Dim>> points_of(const Part& part) const {
    std::vector<VertexId> vertices;
    for (const std::uint32_t f : part)
      vertices.insert(vertices.end(), parts_.facets[f].corners.begin(),
                      parts_.facets[f].corners.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vector<Dim>> points;
    points.reserve(vertices.size());
    for (const VertexId v : vertices) points.push_back(parts_.mesh.site_of[v].position);
    return points;
  }

  // ---- Rounding that the digits of the coordinates show ----

  bool is_explained(std::uint32_t f, std::uint32_t g) const {
    if (!turn_little(f, g)) return false;
    const auto here = corners(f), there = corners(g);
    const auto all = [&](const auto& facet, const auto& points) {
      return std::all_of(points.begin(), points.end(), [&](const Vector<Dim>& p) {
        return explains<Dim>(facet, p, parts_.rounding->tolerance);
      });
    };
    return all(here, there) && all(there, here);
  }

  /// Makes patches of the parts that rounding explains, those that are flat by all digits among
  /// them. If none is rough, the coordinates are round numbers by choice.
  void find_rounded() {
    std::vector<std::pair<Part, Flat<Dim>>> found;
    bool any_rough = false;
    const auto joins = [&](std::uint32_t f, std::uint32_t g) { return is_explained(f, g); };
    each_part(joins, [&](Part part, const std::vector<std::uint32_t>& seed_of) {
      if (part.size() < 2) return;
      const auto plane = plane_near<Dim>(points_of(part), parts_.rounding->tolerance);
      if (!plane) return;
      const bool rough = std::any_of(part.begin(), part.end(), [&](std::uint32_t f) {
        return is_rough(f, [&](std::uint32_t g) { return seed_of[g] == part.front(); });
      });
      std::erase_if(
          part, [&](std::uint32_t f) { return !turns_by_rounding(normal(f), plane->direction); });
      if (part.size() < 2) return;
      any_rough = any_rough || rough;
      found.emplace_back(std::move(part), *plane);
    });
    if (!any_rough) return;
    auto& patches = parts_.mesh.patches;
    for (const auto& [part, plane] : found) {
      for (const std::uint32_t f : part)
        parts_.facets[f].patch = static_cast<PatchId>(patches.size());
      patches.push_back(parts_.facets[part.front()].data);
      patches.back().normal = plane.direction;
      parts_.rounding->plane_of.resize(patches.size());
      parts_.rounding->plane_of.back() = plane;
    }
  }

  // ---- Noise that they do not show ----

  /// The largest distance of noisy parts from their planes, if many facets are in such.
  double noise() const {
    constexpr double in_part = 0.25;  // of the facets
    double largest = 0;
    std::size_t noisy = 0;
    const auto joins = [&](std::uint32_t f, std::uint32_t g) { return turn_little(f, g); };
    each_part(joins, [&](const Part& part, const auto& seed_of) {
      const double noise = noise_of(part, seed_of);
      if (noise > 0) noisy += part.size();
      largest = std::max(largest, noise);
    });
    const auto all = static_cast<double>(parts_.facets.size());
    return static_cast<double>(noisy) < in_part * all ? 0 : largest;
  }

  /// The largest distance of a part from its plane if that is noise; else 0. It is if facets turn
  /// both ways, and neighbours are off each other's planes nearly as far as all are off that of the
  /// part: where it bends, that grows with the square of its size.
  double noise_of(const Part& part, const std::vector<std::uint32_t>& seed_of) const {
    constexpr std::size_t enough = Dim == 2 ? 12 : 24;  // vertices to tell
    constexpr double coarsest = 1e-3;                   // of the extent
    constexpr double most_times = 2.5;                  // the median of what neighbours are off
    constexpr double least_share = 0.25;                // of facets turning either way
    const std::vector<Vector<Dim>> points = points_of(part);
    if (points.size() < enough) return 0;
    const Flat<Dim> plane = best_plane<Dim>(points);
    double most = 0;
    for (const Vector<Dim>& p : points)
      most = std::max(most, std::abs(dot(p - plane.origin, plane.direction)));
    if (!(most > parts_.within.flat && most < coarsest * parts_.extent)) return 0;
    std::vector<double> turns = turns_in(part, seed_of, plane.direction);
    if (turns.empty()) return 0;
    const auto up = std::count_if(turns.begin(), turns.end(), [](double turn) { return turn > 0; });
    const double share = static_cast<double>(up) / static_cast<double>(turns.size());
    if (share < least_share || share > 1 - least_share) return 0;
    for (double& turn : turns) turn = std::abs(turn);
    const auto middle = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2);
    std::nth_element(turns.begin(), middle, turns.end());
    return most <= most_times * *middle ? most : 0;
  }

  /// How far neighbours are off each other's planes, where they are, by the side of the part to
  /// which they turn.
  std::vector<double> turns_in(const Part& part, const std::vector<std::uint32_t>& seed_of,
                               const Vector<Dim>& upwards) const {
    std::vector<double> turns;
    for (const std::uint32_t f : part)
      for (const std::uint32_t g : across_[f])
        if (g != none && f < g && seed_of[g] == seed_of[f] && turn_little(f, g)) {
          const double one = height(f, g, upwards), other = height(g, f, upwards);
          const double turn = std::abs(one) < std::abs(other) ? one : other;
          if (std::abs(turn) > parts_.within.flat) turns.push_back(turn);
        }
    return turns;
  }

  /// The height of the corner of `other` that is not in `facet` above the plane of `facet`.
  double height(std::uint32_t facet, std::uint32_t other, const Vector<Dim>& upwards) const {
    const auto here = corners(facet);
    Vector<Dim> n = facet_normal(here);
    n *= (dot(n, upwards) < 0 ? -1 : 1) / norm(n);
    for (const VertexId v : parts_.facets[other].corners)
      if (!contains(parts_.facets[facet].corners, v))
        return dot(parts_.mesh.site_of[v].position - here[0], n);
    return 0;
  }

  BoundaryParts<Dim>& parts_;
  std::span<const Others> across_;  // [facet][side], where what is flat goes on, or none
};

}  // namespace

template <int Dim>
void find_flat_parts(BoundaryParts<Dim>& parts,
                     std::span<const std::array<std::uint32_t, Dim>> across) {
  FlatParts<Dim>(parts, across).find();
}

template void find_flat_parts<2>(BoundaryParts<2>&, std::span<const std::array<std::uint32_t, 2>>);
template void find_flat_parts<3>(BoundaryParts<3>&, std::span<const std::array<std::uint32_t, 3>>);

}  // namespace ductile::meshadapt
