#include "levelset/snap.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/determinant.hpp"
#include "core/quality.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "levelset/discs.hpp"
#include "levelset/slides.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// A vertex moves by at most this fraction of an edge.
constexpr double most_moved = 0.2;
/// Elsewhere, zeros closer than this fraction to the ends of their edges are pushed away, or onto
/// the end if they are closer than half of it.
constexpr double least_part = 0.08;
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
      : executor_(executor), domain_(domain), snapped_(snapped), discs_(domain, snapped.sign_of) {}

  void run() {
    std::vector<Candidate> candidates;
    for (const Crossing& edge : snapped_.crossings) {
      if (edge.t < most_moved) candidates.push_back({edge.t, edge.a, edge.b});
      if (1 - edge.t < most_moved) candidates.push_back({1 - edge.t, edge.b, edge.a});
    }
    runtime::parallel_sort<Candidate>(executor_, candidates);
    for (const Candidate& c : candidates)
      if (are_open(c)) move(c);
    for (const Candidate& c : candidates)
      if (c.t < least_part / 2 && are_open(c) && discs_.at(c.near)) take(c.near);
    std::erase_if(snapped_.crossings,
                  [&](const Crossing& edge) { return sign(edge.a) == 0 || sign(edge.b) == 0; });
    for (Crossing& edge : snapped_.crossings)
      edge.t = std::clamp(edge.t, least_part, 1 - least_part);
  }

 private:
  std::int8_t& sign(VertexId v) { return snapped_.sign_of[v]; }
  bool are_open(const Candidate& c) { return sign(c.near) != 0 && sign(c.far) != 0; }

  void take(VertexId v) {
    sign(v) = 0;
    ++snapped_.taken;
  }

  void move(const Candidate& c) {
    Vector<Dim>& place = domain_.mesh.position_of[c.near];
    const Vector<Dim> from = place;
    const Vector<Dim> to = from + c.t * (domain_.mesh.position_of[c.far] - from);
    if (to != from && !may_slide(domain_, c.near, c.far)) return;
    if (!discs_.at(c.near)) return;
    if (to == from) return take(c.near);
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

  const Executor& executor_;
  CutDomain<Dim>& domain_;
  Snapped& snapped_;
  Discs<Dim> discs_;
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
