#include "levelset/snap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "core/orientation.hpp"
#include "core/quality.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/discs.hpp"
#include "levelset/divide.hpp"
#include "levelset/slides.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// A vertex moves by at most this fraction of an edge, or by half of it if it is closer to the
/// surface than least_part on another one, along which it must not move.
constexpr double most_moved = 0.2;
/// Where vertices do not move, zeros keep this fraction of the edge from its ends, or go onto the
/// end if they are closer than half of it.
constexpr double least_part = 0.08;
/// The same at vertices that the surface must not go through, around which it bends within an
/// element: there shapes matter more than where it is.
constexpr double least_part_at_bends = 0.2;
/// Moves do not make elements worse than this, or than half as good as they were.
constexpr double poor = 0.15;

/// A vertex, and how far along an edge the surface is from it.
struct Candidate {
  double t;
  VertexId near, far;
  friend auto operator<=>(const Candidate&, const Candidate&) = default;
};

/// Quality of an element, see core/quality.hpp; 0 or less unless its volume is certain.
template <int Dim>
double shape_of(const std::array<Vector<Dim>, Dim + 1>& p) {
  double squares = 0;
  for (const auto& [i, j] : Simplex<Dim>::edge) {
    const Vector<Dim> d = p[static_cast<std::size_t>(i)] - p[static_cast<std::size_t>(j)];
    squares += dot(d, d);
  }
  return quality_from<Dim>(certain_determinant<Dim>(p), squares);
}

template <int Dim>
class Snapping {
 public:
  Snapping(const Executor& executor, CutDomain<Dim>& domain, Snapped& snapped)
      : executor_(executor),
        domain_(domain),
        snapped_(snapped),
        discs_(domain, snapped.sign_of),
        is_refused_(snapped.sign_of.size()),
        is_close_(snapped.sign_of.size()) {}

  void run() {
    std::vector<Candidate> candidates;
    for (const Crossing& edge : snapped_.crossings) {
      candidates.push_back(edge.t < 0.5 ? Candidate{edge.t, edge.a, edge.b}
                                        : Candidate{1 - edge.t, edge.b, edge.a});
    }
    runtime::parallel_sort<Candidate>(executor_, candidates);
    for (const Candidate& c : candidates)
      if (are_open(c) && (c.t < most_moved || is_close_[c.near] != 0)) move(c);
    for (const Candidate& c : candidates)
      if (are_open(c) && c.t < least_part / 2 && is_disc(c.near)) take(c.near);
    drop_closed();
    for (Crossing& edge : snapped_.crossings)
      edge.t = std::clamp(edge.t, least_part_at(edge.a), 1 - least_part_at(edge.b));
    make_volumes_certain();
  }

 private:
  std::int8_t& sign(VertexId v) { return snapped_.sign_of[v]; }
  bool are_open(const Candidate& c) { return sign(c.near) != 0 && sign(c.far) != 0; }

  bool is_disc(VertexId v) {
    const bool is = discs_.at(v);
    is_refused_[v] = is ? 0 : 1;
    return is;
  }
  double least_part_at(VertexId v) const {
    return is_refused_[v] != 0 ? least_part_at_bends : least_part;
  }

  void drop_closed() {
    std::erase_if(snapped_.crossings,
                  [&](const Crossing& edge) { return sign(edge.a) == 0 || sign(edge.b) == 0; });
  }

  void take(VertexId v) {
    sign(v) = 0;
    ++snapped_.taken;
  }

  void move(const Candidate& c) {
    Vector<Dim>& place = domain_.mesh.position_of[c.near];
    const Vector<Dim> from = place;
    const Vector<Dim> to = from + c.t * (domain_.mesh.position_of[c.far] - from);
    if (!is_disc(c.near)) return;
    if (to == from) return take(c.near);
    if (c.t < least_part) is_close_[c.near] = 1;
    if (!may_slide(domain_, c.near, c.far)) return;
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
      std::array<Vector<Dim>, Dim + 1> old;
      for (std::size_t i = 0; i <= Dim; ++i)
        old[i] = position_in<Dim>(domain_.any, domain_.mesh.corners_of[e][i]);
      before = std::min(before, shape_of<Dim>(old));
      after = std::min(after, shape_of<Dim>(domain_.mesh.points(e)));
    }
    return after > 0 && after > std::min(poor, 0.5 * before);
  }

  // ---- Elements as flat as rounding errors ----

  /// New vertices are not exactly on their edges. Where that would turn an element over, they are
  /// put elsewhere on them, and in the end the surface goes through the ends of the edges.
  void make_volumes_certain() {
    constexpr std::array<double, 7> other_parts = {0.5, 0.25, 0.75, 0.375, 0.625, 0.3125, 0.6875};
    runtime::UnsetVector<ElementId> bad = inverted();
    for (std::size_t k = 0; k < other_parts.size() && !bad.empty(); ++k) {
      for (const ElementId e : bad) each_cut(e, [&](Crossing& edge) { edge.t = other_parts[k]; });
      bad = inverted();
    }
    while (!bad.empty()) {
      for (const ElementId e : bad)
        each_cut(e, [&](Crossing& edge) {
          for (const VertexId v : {edge.a, edge.b})
            if (sign(edge.a) != 0 && sign(edge.b) != 0 && discs_.at(v)) take(v);
        });
      const std::size_t before = snapped_.crossings.size();
      drop_closed();
      if (snapped_.crossings.size() == before) refuse_flat(bad[0]);
      bad = inverted();
    }
  }

  [[noreturn]] void refuse_flat(ElementId e) const {
    refuse(name_of(domain_.any) + ": " + entry(elements_array<Dim>(), element_name<Dim>(), e) +
           " is too flat to be cut; remove or repair it");
  }

  /// The elements that would be divided into some whose volumes are not positive.
  runtime::UnsetVector<ElementId> inverted() const {
    const Divider divider(snapped_.crossings, snapped_.sign_of);
    return runtime::parallel_collect<ElementId>(
        executor_, domain_.mesh.element_count(), [&](std::size_t e, auto&& append) {
          const auto pieces = divider.divide(domain_.mesh.corners_of[e]);
          if (pieces.count == 1) return;
          for (const Corners<Dim>& piece : pieces) {
            std::array<Vector<Dim>, Dim + 1> p;
            for (std::size_t i = 0; i <= Dim; ++i) p[i] = divider.place(domain_, piece[i]);
            if (orientation<Dim>(p) <= 0) return append(static_cast<ElementId>(e));
          }
        });
  }

  void each_cut(ElementId e, auto&& visit) {
    const Divider divider(snapped_.crossings, snapped_.sign_of);
    for (std::size_t k = 0; k < Simplex<Dim>::edge.size(); ++k) {
      const auto [a, b] = ends_of_edge<Dim>(domain_.mesh.corners_of[e], k);
      if (const Crossing* edge = divider.find(a, b))
        visit(snapped_.crossings[static_cast<std::size_t>(edge - snapped_.crossings.data())]);
    }
  }

  const Executor& executor_;
  CutDomain<Dim>& domain_;
  Snapped& snapped_;
  Discs<Dim> discs_;
  std::vector<std::uint8_t> is_refused_;  // [vertex] 1: the surface must not go through it
  std::vector<std::uint8_t> is_close_;    // [vertex] 1: see most_moved
};

}  // namespace

template <int Dim>
Snapped snap(const Executor& executor, CutDomain<Dim>& domain, const std::vector<double>& value_of,
             std::vector<Crossing> crossings) {
  Snapped snapped;
  snapped.sign_of.resize(value_of.size());
  snapped.origin_of.resize(value_of.size());
  runtime::parallel_for(executor, value_of.size(), [&](std::size_t v) {
    const auto vertex = static_cast<VertexId>(v);
    snapped.sign_of[v] = value_of[v] < 0 ? -1 : 1;
    snapped.origin_of[v] = {vertex, vertex, 0};
  });
  snapped.crossings = std::move(crossings);
  Snapping<Dim>(executor, domain, snapped).run();
  return snapped;
}

template Snapped snap(const Executor&, CutDomain<2>&, const std::vector<double>&,
                      std::vector<Crossing>);
template Snapped snap(const Executor&, CutDomain<3>&, const std::vector<double>&,
                      std::vector<Crossing>);

}  // namespace ductile::meshadapt
