/// @file
/// Rough parts: facets, or edges of curves, that are flat, or straight, but for how precisely their
/// coordinates were written. What turns by no more than that explains is one part if all of it is
/// then near one plane, or line; if not, it is curved.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "geometry/classify.hpp"
#include "geometry/rounding.hpp"

namespace ductile::meshadapt {

/// The cosine of how far rounding may turn facets, at most.
inline constexpr double most_turn_by_rounding = 0.9;

/// Do two facets, or edges, turn by more than none but little enough that rounding may explain it?
template <int Dim>
bool turns_by_rounding(const Vector<Dim>& u, const Vector<Dim>& v) {
  return std::abs(dot(u, v)) > most_turn_by_rounding * norm(u) * norm(v);
}

/// `across` is [facet][side], the next facet or none.
template <int Dim, class Across>
class RoughParts {
 public:
  RoughParts(const Mesh<Dim>& mesh, std::span<const TaggedFacet<Dim>> facets, const Across& across)
      : mesh_(mesh), facets_(facets), across_(across) {}

  /// Is a facet off the plane of a neighbour of a higher number, though they turn little?
  bool is_rough(std::uint32_t f, double tolerance) const {
    return std::any_of(across_[f].begin(), across_[f].end(), [&](std::uint32_t g) {
      return g != none && g > f && is_off(f, g, tolerance);
    });
  }

  struct Part {
    std::vector<std::uint32_t> facets;  ///< their numbers, more than one
    Flat<Dim> plane;                    ///< near which they are
    bool rough = false;                 ///< not exactly flat
  };

  /// All parts that rounding explains, those that are flat to the tolerance among them.
  std::vector<Part> all(double rounding, double tolerance) const {
    std::vector<Part> parts;
    std::vector<std::uint32_t> seed_of(facets_.size(), none);
    std::vector<std::uint32_t> part;
    for (std::uint32_t seed = 0; seed < facets_.size(); ++seed) {
      if (seed_of[seed] != none) continue;
      grow(seed, rounding, seed_of, part);
      if (part.size() < 2) continue;
      const auto plane = plane_of(part, rounding);
      if (!plane) continue;
      const bool rough = std::any_of(part.begin(), part.end(), [&](std::uint32_t f) {
        return std::any_of(across_[f].begin(), across_[f].end(), [&](std::uint32_t g) {
          return g != none && seed_of[g] == seed && is_off(f, g, tolerance);
        });
      });
      std::erase_if(part, [&](std::uint32_t f) {
        return !turns_by_rounding(facet_normal(corners(f)), plane->direction);
      });
      if (part.size() > 1) parts.push_back({part, *plane, rough});
    }
    return parts;
  }

 private:
  std::array<Vector<Dim>, Dim> corners(std::uint32_t f) const {
    std::array<Vector<Dim>, Dim> p;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = mesh_.site_of[facets_[f].corners[i]].position;
    return p;
  }

  /// Is a facet off the plane of another, though they turn little?
  bool is_off(std::uint32_t f, std::uint32_t g, double tolerance) const {
    if (!turn_little(f, g)) return false;
    const auto here = corners(f), there = corners(g);
    const Vector<Dim> normal = facet_normal(here);
    return std::any_of(there.begin(), there.end(), [&](const Vector<Dim>& p) {
      return std::abs(dot(p - here[0], normal)) > tolerance * norm(normal);
    });
  }

  bool turn_little(std::uint32_t f, std::uint32_t g) const {
    return turns_by_rounding(facet_normal(corners(f)), facet_normal(corners(g)));
  }

  bool explained(std::uint32_t f, std::uint32_t g, double tolerance) const {
    if (!turn_little(f, g)) return false;
    const auto here = corners(f), there = corners(g);
    const auto all = [&](const auto& facet, const auto& points) {
      return std::all_of(points.begin(), points.end(),
                         [&](const Vector<Dim>& p) { return explains<Dim>(facet, p, tolerance); });
    };
    return all(here, there) && all(there, here);
  }

  void grow(std::uint32_t seed, double rounding, std::vector<std::uint32_t>& seed_of,
            std::vector<std::uint32_t>& part) const {
    part.assign(1, seed);
    seed_of[seed] = seed;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const std::uint32_t g : across_[part[i]])
        if (g != none && seed_of[g] == none && explained(part[i], g, rounding)) {
          seed_of[g] = seed;
          part.push_back(g);
        }
  }

  /// Near which all of the part is.
  std::optional<Flat<Dim>> plane_of(std::span<const std::uint32_t> part, double tolerance) const {
    std::vector<VertexId> vertices;
    for (const std::uint32_t f : part)
      vertices.insert(vertices.end(), facets_[f].corners.begin(), facets_[f].corners.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vector<Dim>> points;
    points.reserve(vertices.size());
    for (const VertexId v : vertices) points.push_back(mesh_.site_of[v].position);
    return plane_near<Dim>(points, tolerance);
  }

  const Mesh<Dim>& mesh_;
  std::span<const TaggedFacet<Dim>> facets_;
  const Across& across_;
};

}  // namespace ductile::meshadapt
