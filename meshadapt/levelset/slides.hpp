/// @file
/// may_slide(): may a vertex move towards another one without changing a boundary, an interface
/// between materials, a listed facet or a listed edge?
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// An edge from a vertex, on facets or curves that the vertex must stay on.
struct Spoke {
  VertexId end;
  std::int64_t kind;  // of its facets: listed ones differ by reference, in 2D also by ridge
  int facets = 0;
  bool is_curve = false;  // must the vertex stay on it?
};

template <int Dim>
class Slide {
 public:
  Slide(const CutDomain<Dim>& domain, const std::vector<Vector<Dim>>& place_of, VertexId vertex,
        VertexId towards)
      : domain_(domain), place_of_(place_of), vertex_(vertex), towards_(towards) {}

  /// True if each facet is flat in the direction of the other vertex, and so is the curve, if any.
  bool is_allowed() {
    if (domain_.is_fixed[vertex_] != 0) return false;
    for (const ElementId e : domain_.mesh.elements_of(vertex_))
      for (std::size_t i = 0; i <= Dim; ++i) {
        const ElementId other = domain_.mesh.neighbour_of[e][i];
        const bool is_seen = other != none && other < e;
        if (domain_.mesh.corners_of[e][i] != vertex_ && !is_seen &&
            (domain_.listed_of[e][i] != 0 || domain_.is_border(e, i)))
          if (!add(e, i)) return false;
      }
    find_curves();
    const auto ahead = std::ranges::find(spokes_, towards_, &Spoke::end);
    if (ahead == spokes_.end()) return spokes_.empty();
    const auto curves = std::ranges::count(spokes_, true, &Spoke::is_curve);
    if (curves == 0) return true;
    const auto back = std::ranges::find_if(
        spokes_, [&](const Spoke& s) { return s.is_curve && s.end != towards_; });
    return curves == 2 && ahead->is_curve && back->kind == ahead->kind && is_opposite(back->end);
  }

 private:
  /// Sine of an angle that rounding may explain.
  static constexpr double flat = 1e-9;

  Vector<Dim> to(VertexId v) const { return place_of_[v] - place_of_[vertex_]; }

  Spoke& spoke(VertexId end, std::int64_t kind) {
    const auto at = std::ranges::find(spokes_, end, &Spoke::end);
    return at != spokes_.end() ? *at : spokes_.emplace_back(Spoke{end, kind});
  }

  /// Adds a facet; false if it is not flat.
  bool add(ElementId element, std::size_t i) {
    constexpr std::int64_t unlisted = std::int64_t{1} << 40;
    const std::uint32_t listed = domain_.listed_of[element][i];
    std::int64_t kind = unlisted;
    if (listed != 0) kind = 2 * std::int64_t{facets_in<Dim>(domain_.any).reference[listed - 1]};
    if (Dim == 2 && listed != 0) kind += domain_.is_ridge[listed - 1];
    std::array<Vector<Dim>, Dim - 1> sides;
    std::size_t n = 0;
    for (const VertexId v : facet_of<Dim>(domain_.mesh.corners_of[element], static_cast<int>(i))) {
      if (v == vertex_) continue;
      Spoke& s = spoke(v, kind);
      ++s.facets;
      s.is_curve |= s.kind != kind;
      sides[n++] = to(v);
    }
    if constexpr (Dim == 2)
      return true;
    else {
      const Vector<3> normal = cross(sides[0], sides[1]);
      return std::abs(dot(to(towards_), normal)) <= flat * norm(to(towards_)) * norm(normal);
    }
  }

  /// An edge belongs to a curve where facets of one kind do not go on behind it, or if it is
  /// listed. In 2D all facets are curves.
  void find_curves() {
    for (Spoke& s : spokes_) {
      s.is_curve |= Dim == 2 || s.facets != 2;
      if (Dim == 3) s.kind = -1;
    }
    for (const auto& [from, end, edge] : domain_.spokes_of(vertex_)) {
      Spoke& s = spoke(end, 0);
      s.is_curve = true;
      s.kind = 2 * std::int64_t{domain_.any.edges.reference[edge]} + domain_.is_ridge[edge];
    }
  }

  bool is_opposite(VertexId back) const {
    const Vector<Dim> u = to(towards_), w = to(back);
    return dot(u, w) < 0 && norm(w - (dot(u, w) / dot(u, u)) * u) <= flat * norm(w);
  }

  const CutDomain<Dim>& domain_;
  const std::vector<Vector<Dim>>& place_of_;
  VertexId vertex_, towards_;
  std::vector<Spoke> spokes_;
};

/// See the top of this file. Thread safety: any thread.
template <int Dim>
bool may_slide(const CutDomain<Dim>& domain, const std::vector<Vector<Dim>>& place_of,
               VertexId vertex, VertexId towards) {
  return Slide<Dim>(domain, place_of, vertex, towards).is_allowed();
}

}  // namespace ductile::meshadapt
