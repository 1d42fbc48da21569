#include "operators/refine.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

using runtime::few_nanoseconds;
using runtime::parallel_for;
using runtime::PhaseTimer;

namespace {

/// Edges whose elements are looked at before other threads would have begun.
constexpr std::size_t few_to_look_at = 16;

}  // namespace

template <int Dim, int Space>
runtime::RoundsReport Refine<Dim, Space>::run(runtime::UnsetVector<LongEdge> edges) {
  edges_ = std::move(edges);
  report_.planned = edges_.size();
  if (edges_.empty()) return report_;
  {
    const PhaseTimer timer(report_.plan_seconds);
    plan();
  }
  {
    const PhaseTimer timer(report_.conflict_seconds);
    refuse();
  }
  {
    const PhaseTimer timer(report_.apply_seconds);
    number();
  }
  grow();
  return report_;
}

/// Prefetches the points of elements soon after the one at this place.
template <int Dim, int Space>
[[gnu::always_inline]] inline void Refine<Dim, Space>::prefetch_points_after(
    std::size_t place) const {
  constexpr std::size_t ahead = 3;
  if (place + 2 * ahead < elements_.size())
    __builtin_prefetch(&mesh_.corners_of[elements_[place + 2 * ahead]]);
  if (place + ahead >= elements_.size()) return;
  for (const VertexId v : mesh_.corners_of[elements_[place + ahead]]) prefetch_site(mesh_, v);
  for (const std::uint32_t split : cuts_[place + ahead].split)  // no branches: any may be cut
    __builtin_prefetch(&splits_[std::max(split, 1U) - 1].site);
}

/// As if edges were split one after the other, the longest first: an edge is refused only when it
/// is known which edges before it are refused.
template <int Dim, int Space>
void Refine<Dim, Space>::refuse() {
  const auto look_ahead = [&](std::size_t place) {
    prefetch_points_after(place);
    look(place);
  };
  parallel_for(executor_, elements_.size(), look_ahead);
  for (auto refused = take_refused(); !refused.empty(); refused = take_refused())
    parallel_for(executor_, refused.size(),
                 [&](std::size_t i) {
                   visit_cuts(refused[i], [&](std::size_t place) {
                     if (first_refused_of(cuts_[place], refused[i])) look(place);
                   });
                 },
                 {.serial_below = few_to_look_at});
  report_.rounds = round_;
  around_ = {};
  around_begin_ = {};
}

/// Refuses the edges that elements ask to refuse, except where this may still change; returns them.
template <int Dim, int Space>
runtime::UnsetVector<std::uint32_t> Refine<Dim, Space>::take_refused() {
  ++round_;
  using runtime::parallel_collect;
  const auto find_asked = [&](std::size_t i, auto&& append) {
    const auto number = static_cast<std::uint32_t>(i);
    if (asked_[i] != 0 && is_split(number)) append(number);
  };
  const auto asked = parallel_collect<std::uint32_t>(executor_, edges_.size(), find_asked,
                                                     few_nanoseconds.serial_below);
  parallel_for(executor_, asked.size(),
               [&](std::size_t i) { asked_[asked[i]] = is_asked(asked[i]); },
               {.serial_below = few_to_look_at});
  const auto find_first = [&](std::size_t i, auto&& append) {
    if (asked_[asked[i]] != 0 && goes_first(asked[i])) append(asked[i]);
  };
  auto refused =
      parallel_collect<std::uint32_t>(executor_, asked.size(), find_first, few_to_look_at);
  parallel_for(
      executor_, refused.size(), [&](std::size_t i) { refused_in_[refused[i]] = round_; },
      few_nanoseconds);
  return refused;
}

/// Does an element still ask to refuse this edge?
template <int Dim, int Space>
bool Refine<Dim, Space>::is_asked(std::uint32_t number) const {
  bool any = false;
  visit_cuts(number, [&](std::size_t place) {
    for (std::size_t k = 0; k < cuts_[place].split.size(); ++k)
      any = any || (cuts_[place].split[k] == number + 1 && (cuts_[place].asks >> k & 1U) != 0);
  });
  return any;
}

/// Is this the first edge that the elements around it ask to refuse? Their other requests may
/// depend on it.
template <int Dim, int Space>
bool Refine<Dim, Space>::goes_first(std::uint32_t number) const {
  bool first = true;
  visit_cuts(number, [&](std::size_t place) {
    for (const std::uint32_t split : cuts_[place].split)
      if (split != 0 && asked_[split - 1] != 0 && is_split(split - 1))
        first = first && !goes_before(split - 1, number);
  });
  return first;
}

/// Visits the places of the elements around an edge.
template <int Dim, int Space>
void Refine<Dim, Space>::visit_cuts(std::uint32_t number, auto&& visit) const {
  for (std::size_t i = around_begin_[number]; i < around_.size() && around_[i].number == number;
       ++i)
    visit(around_[i].place);
}

/// An element that several edges refused in this round cut looks again once.
template <int Dim, int Space>
bool Refine<Dim, Space>::first_refused_of(const Cuts& cuts, std::uint32_t number) const {
  for (const std::uint32_t split : cuts.split)
    if (split != 0 && split - 1 < number && refused_in_[split - 1] == round_) return false;
  return true;
}

/// Tries to cut an element, and asks to refuse the edges along which it may not be cut.
template <int Dim, int Space>
void Refine<Dim, Space>::look(std::size_t place) {
  const ElementId element = elements_[place];
  Cuts& cuts = cuts_[place];
  const Order order = order_of(cuts);
  const Points points = points_of(element, cuts);
  cuts.asks = 0;
  if (cut_freely(cuts, order, points)) return;
  Pieces<Dim> pieces;
  cuts.quality[0] = mesh_.quality_of[element];
  for (std::size_t i = 0; i < order.size; ++i) {
    const std::uint32_t number = cuts.split[order.edge[i]] - 1;
    if (cut(pieces, cuts.quality, order.edge[i], splits_[number], points)) continue;
    cuts.asks |= 1U << order.edge[i];
    runtime::atomic_mark(asked_[number]);
  }
  cuts.pieces = static_cast<std::uint32_t>(pieces.size());
}

template <int Dim, int Space>
auto Refine<Dim, Space>::order_of(const Cuts& cuts) const -> Order {
  Order order;
  for (std::size_t k = 0; k < cuts.split.size(); ++k) {
    if (cuts.split[k] == 0 || !is_split(cuts.split[k] - 1)) continue;
    std::size_t at = order.size++;
    for (; at != 0 && goes_before(cuts.split[k] - 1, cuts.split[order.edge[at - 1]] - 1); --at)
      order.edge[at] = order.edge[at - 1];
    order.edge[at] = static_cast<std::uint8_t>(k);
  }
  return order;
}

template <int Dim, int Space>
auto Refine<Dim, Space>::points_of(ElementId element, const Cuts& cuts) const -> Points {
  Points points{element, {}, {}};
  for (std::size_t i = 0; i <= Dim; ++i)
    points.site[i] = &mesh_.site_of[mesh_.corners_of[element][i]];
  for (std::size_t k = 0; k < cuts.split.size(); ++k)
    if (cuts.split[k] != 0) points.set_middle(k, splits_[cuts.split[k] - 1]);
  return points;
}

template <int Dim, int Space>
static std::array<const Site<Space>*, Dim + 1> sites_of(
    const Piece<Dim>& piece, const std::array<const Site<Space>*, points_of_cut<Dim>>& points) {
  std::array<const Site<Space>*, Dim + 1> sites;
  for (std::size_t i = 0; i <= Dim; ++i) sites[i] = points[piece.corners[i]];
  return sites;
}

/// Cuts an element into pieces that every rule accepts, whatever the element was like; returns
/// false if one of them is not.
template <int Dim, int Space>
bool Refine<Dim, Space>::cut_freely(Cuts& cuts, const Order& order, const Points& points) const {
  Pieces<Dim> pieces;
  for (std::size_t i = 0; i < order.size; ++i) {
    if (!keeps_distance(pieces, order.edge[i], points)) return false;
    pieces.cut(order.edge[i]);
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    cuts.quality[p] =
        static_cast<float>(quality<Dim>(sites_of<Dim, Space>(pieces[p], points.site)));
    if (!(cuts.quality[p] >= rules_.accepted_quality)) return false;
  }
  cuts.pieces = static_cast<std::uint32_t>(pieces.size());
  return true;
}

/// Cuts pieces along one edge, unless the rules refuse an edge or a quality that this makes; then
/// the pieces stay as they are.
template <int Dim, int Space>
bool Refine<Dim, Space>::cut(Pieces<Dim>& pieces, Qualities& qualities, std::size_t edge,
                             const Split& split, const Points& points) const {
  if (!keeps_distance(pieces, edge, points)) return false;
  Pieces<Dim> halves = pieces;
  halves.cut(edge);
  Qualities after = qualities;
  const auto is_fine = [&](std::size_t half, double before) {
    const double value = quality<Dim>(sites_of<Dim, Space>(halves[half], points.site));
    after[half] = static_cast<float>(value);
    return value > 0 && value >= least_quality(std::min<double>(before, split.worst_around), split);
  };
  std::size_t second = pieces.size();
  for (std::size_t first = 0; first < pieces.size(); ++first)
    if (pieces.has_edge(first, edge) &&
        (!is_fine(first, qualities[first]) || !is_fine(second++, qualities[first])))
      return false;
  pieces = halves;
  qualities = after;
  return true;
}

/// Is the middle of an edge far enough from the other corners of the pieces that it cuts?
template <int Dim, int Space>
bool Refine<Dim, Space>::keeps_distance(const Pieces<Dim>& pieces, std::size_t edge,
                                        const Points& points) const {
  const auto [a, b] = Simplex<Dim>::edge[edge];
  const Site<Space>& middle = *points.site[middle_of<Dim>(edge)];
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!pieces.has_edge(p, edge)) continue;
    for (const PointOfCut c : pieces[p].corners)
      if (c != a && c != b && shorter_than(*points.site[c], middle, rules_.shortest_split) &&
          !is_across(pieces[p], edge, c, points))
        return false;
  }
  return true;
}

/// Does a corner of a piece lie on another side of a layer, or of a strip of a patch, than the edge
/// that is cut? Their distance follows from the layer's thickness, and no collapse may join them.
template <int Dim, int Space>
bool Refine<Dim, Space>::is_across(const Piece<Dim>& piece, std::size_t edge, PointOfCut corner,
                                   const Points& points) const {
  const auto class_of = [&](PointOfCut point) -> int {
    return point > Dim ? points.class_of_middle[point - Dim - 1U]
                       : mesh_.kind_of[mesh_.corners_of[points.element][point]].class_dimension;
  };
  const int highest = std::max(class_of(middle_of<Dim>(edge)), class_of(corner));
  if (Dim == 2 || highest != 2) return highest == 1;
  const auto [a, b] = Simplex<Dim>::edge[edge];
  const auto& patches = mesh_.patches_of[points.element];
  for (std::size_t i = 0; i <= Dim; ++i) {
    const PointOfCut other = piece.corners[i];
    if (other == a || other == b || other == corner) continue;
    return piece.facet_of[i] >= patches.size() || patches[piece.facet_of[i]] == 0;
  }
  return false;
}

/// Along overlong edges the metric changes so much over an element that its quality means little.
template <int Dim, int Space>
double Refine<Dim, Space>::least_quality(double before, const Split& split) const {
  if (before < rules_.poor_quality)
    return split.in_layer ? rules_.layer_split_keeps * before : before;
  const double excess = std::max(1.0, split.length / rules_.overlong_edge);
  return std::min(rules_.split_keeps * before, rules_.accepted_quality) / (excess * excess);
}

template class Refine<2>;
template class Refine<2, 3>;
template class Refine<3>;

}  // namespace ductile::meshadapt
