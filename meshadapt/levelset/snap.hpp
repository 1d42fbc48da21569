/// @file
/// Snapping<Dim, Space>: puts vertices near the surface onto it, so that no edge is cut close to
/// its end. Vertices of a surface alone, where Space is more than Dim, stay where they are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "core/orientation.hpp"
#include "core/quality.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/discs.hpp"
#include "levelset/divide.hpp"
#include "levelset/slides.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

/// The surface as vertices and edges see it.
template <int Space>
struct Snapped {
  std::vector<Vector<Space>> place_of;  // [vertex]
  std::vector<std::int8_t> sign_of;     // [vertex] -1, 1, or 0 on the surface
  std::vector<VertexOrigin> origin_of;  // [vertex]
  std::vector<Crossing> crossings;      // sorted by their vertices
  std::size_t moved = 0, taken = 0;     // vertices, see CutReport
};

template <int Dim, int Space>
class Snapping {
 public:
  Snapping(const runtime::Executor& executor, const CutDomain<Dim>& domain, Snapped<Space>& snapped)
      : executor_(executor),
        domain_(domain),
        snapped_(snapped),
        discs_(domain, snapped.sign_of),
        is_refused_(snapped.sign_of.size()),
        is_close_(snapped.sign_of.size()) {}

  /// Moves vertices along crossing edges, the nearest first. Thread safety: one caller; runs on the
  /// executor.
  void run() {
    std::vector<Candidate> candidates;
    for (const auto& [a, b, t, square] : snapped_.crossings)
      candidates.push_back(t < 0.5 ? Candidate{t, a, b} : Candidate{1 - t, b, a});
    runtime::parallel_sort<Candidate>(executor_, candidates);
    if constexpr (Space == Dim)
      for (const Candidate& c : candidates)
        if (are_open(c.near, c.far) && (c.t < most_moved || is_close_[c.near] != 0)) move(c);
    for (const Candidate& c : candidates)
      if (are_open(c.near, c.far) && c.t < least_part / 2 && is_disc(c.near)) take(c.near);
    drop_closed();
    for (auto& [a, b, t, square] : snapped_.crossings)
      t = std::clamp(t, least_part_at(a), 1 - least_part_at(b));
    if constexpr (Space == Dim) make_volumes_certain();
  }

 private:
  /// A vertex moves by at most this fraction of an edge, or by half of it if it is closer to the
  /// surface than least_part on another one, along which it must not move.
  static constexpr double most_moved = 0.2;
  /// Where vertices do not move, crossings keep this fraction of the edge from its ends, or go onto
  /// the end if they are closer than half of it.
  static constexpr double least_part = 0.08;
  /// The same at vertices that the surface must not go through, around which it bends within an
  /// element: there shapes matter more than where it is.
  static constexpr double least_part_at_bends = 0.2;
  /// Moves do not make elements worse than this, or than half as good as they were.
  static constexpr double poor = 0.15;

  /// A vertex, and how far along an edge the surface is from it.
  struct Candidate {
    double t;
    VertexId near, far;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
  };

  std::int8_t& sign(VertexId v) { return snapped_.sign_of[v]; }
  bool are_open(VertexId a, VertexId b) { return sign(a) != 0 && sign(b) != 0; }

  bool is_disc(VertexId v) {
    const bool is = discs_.at(v);
    is_refused_[v] = is ? 0 : 1;
    return is;
  }

  double least_part_at(VertexId v) const {
    return is_refused_[v] != 0 ? least_part_at_bends : least_part;
  }

  void take(VertexId v) {
    sign(v) = 0;
    ++snapped_.taken;
  }

  void move(const Candidate& c) {
    if (!is_disc(c.near)) return;
    Vector<Dim>& place = snapped_.place_of[c.near];
    const Vector<Dim> from = place;
    const Vector<Dim> to = from + c.t * (snapped_.place_of[c.far] - from);
    if (to == from) return take(c.near);
    if (c.t < least_part) is_close_[c.near] = 1;
    if (!may_slide(domain_, snapped_.place_of, c.near, c.far)) return;
    place = to;
    if (!keeps_shapes(c.near)) {
      place = from;
      return;
    }
    sign(c.near) = 0;
    ++snapped_.moved;
    snapped_.origin_of[c.near] = {c.near, c.far, c.t};
  }

  /// Are the elements around a vertex as good as moves must leave them?
  bool keeps_shapes(VertexId v) const {
    double before = 1, after = 1;
    for (const ElementId e : domain_.mesh.elements_of(v)) {
      std::array<Vector<Dim>, Dim + 1> moved;
      for (std::size_t i = 0; i <= Dim; ++i)
        moved[i] = snapped_.place_of[domain_.mesh.corners_of[e][i]];
      before = std::min(before, shape_of(domain_.mesh.points(e)));
      after = std::min(after, shape_of(moved));
    }
    return after > 0 && after > std::min(poor, 0.5 * before);
  }

  /// Quality, see core/quality.hpp; 0 or less unless the volume is certain.
  static double shape_of(const std::array<Vector<Dim>, Dim + 1>& p) {
    double squares = 0;
    for (const auto& [i, j] : Simplex<Dim>::edge) {
      const Vector<Dim> d = p[static_cast<std::size_t>(i)] - p[static_cast<std::size_t>(j)];
      squares += dot(d, d);
    }
    return quality_from<Dim>(certain_determinant<Dim>(p), squares);
  }

  void drop_closed() {
    std::erase_if(snapped_.crossings,
                  [&](const Crossing& edge) { return !are_open(edge.a, edge.b); });
  }

  // ---- Elements as flat as rounding errors ----

  /// New vertices are not exactly on their edges. Where that would turn an element over, they are
  /// put elsewhere on them, and in the end the surface goes through the ends of the edges.
  void make_volumes_certain() {
    constexpr int most_tries = 40;
    constexpr double golden_ratio = 0.6180339887498949;  // spreads the places evenly
    auto bad = inverted();
    for (int k = 0; k < most_tries && !bad.empty(); ++k, bad = inverted()) {
      const double other = std::fmod(0.5 + k * golden_ratio, 1.0);
      each_cut(bad, [&](Crossing& edge) { edge.t = 0.2 + 0.6 * other; });
    }
    for (; !bad.empty(); bad = inverted()) {
      const std::size_t before = snapped_.crossings.size();
      each_cut(bad, [&](Crossing& edge) {
        for (const VertexId v : {edge.a, edge.b})
          if (are_open(edge.a, edge.b) && discs_.at(v)) take(v);
      });
      drop_closed();
      if (snapped_.crossings.size() == before)
        refuse(name_of(domain_.any) + ": " +
               entry(elements_array<Dim>(), element_name<Dim>(), bad[0]) +
               " is too flat to be cut; remove or repair it");
    }
  }

  /// The elements that would be divided into some whose volumes are not positive.
  runtime::UnsetVector<ElementId> inverted() const {
    const Divider divider(snapped_.crossings, snapped_.sign_of);
    return runtime::parallel_collect<ElementId>(
        executor_, domain_.mesh.element_count(), [&](std::size_t e, auto&& append) {
          const auto pieces = divider.divide(domain_.mesh.corners_of[e]);
          if (pieces.count > 1 && std::ranges::any_of(pieces, [&](const Corners<Dim>& piece) {
                return orientation<Dim>(divider.places(snapped_.place_of, piece)) <= 0;
              }))
            append(static_cast<ElementId>(e));
        });
  }

  void each_cut(std::span<const ElementId> elements, auto&& visit) {
    const Divider divider(snapped_.crossings, snapped_.sign_of);
    for (const ElementId e : elements)
      for (std::size_t k = 0; k < Simplex<Dim>::edge.size(); ++k) {
        const auto [a, b] = ends_of_edge<Dim>(domain_.mesh.corners_of[e], k);
        if (const Crossing* edge = divider.find(a, b))
          visit(snapped_.crossings[static_cast<std::size_t>(edge - snapped_.crossings.data())]);
      }
  }

  const runtime::Executor& executor_;
  const CutDomain<Dim>& domain_;
  Snapped<Space>& snapped_;
  Discs<Dim> discs_;
  std::vector<std::uint8_t> is_refused_;  // [vertex] 1: the surface must not go through it
  std::vector<std::uint8_t> is_close_;    // [vertex] 1: see most_moved
};

}  // namespace ductile::meshadapt
