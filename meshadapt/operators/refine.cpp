#include "operators/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

using runtime::few_nanoseconds;
using runtime::make_filled;
using runtime::parallel_for;
using runtime::PhaseTimer;

namespace {

/// Elements around edges that are noted together.
constexpr std::size_t together = 32;
/// Edges whose elements are looked at before other threads would have begun.
constexpr std::size_t few_to_look_at = 16;

/// Where along a-b its two halves have the same metric length, the size varying geometrically.
template <int Dim>
double metric_middle(const Site<Dim>& a, const Site<Dim>& b) {
  const Vector<Dim> d = b.position - a.position;
  const double ratio = std::sqrt(squared_length(b.metric, d) / squared_length(a.metric, d));
  if (std::abs(ratio - 1) < 1e-3) return 0.5;
  return std::clamp(std::log(0.5 * (1 + ratio)) / std::log(ratio), 0.2, 0.8);
}

/// Which edge of an element a-b is.
template <int Dim>
std::size_t edge_of(const Corners<Dim>& corners, VertexId a, VertexId b) {
  std::size_t k = 0;
  for (; k + 1 < Simplex<Dim>::edges; ++k) {
    const auto [p, q] = ends_of_edge<Dim>(corners, k);
    if ((p == a && q == b) || (p == b && q == a)) break;
  }
  return k;
}

/// Square of twice the metric area of the triangle that two vectors span.
template <int Dim>
double squared_area(const Metric<Dim>& metric, const Vector<Dim>& u, const Vector<Dim>& v) {
  const double uu = squared_length(metric, u), vv = squared_length(metric, v);
  const double uv = (uu + vv - squared_length(metric, u - v)) / 2;
  return uu * vv - uv * uv;
}

/// Metric length of the least height of a triangle.
template <int Dim>
double least_height_of_triangle(const std::array<Vector<Dim>, 3>& p, const Metric<Dim>& metric) {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    longest = std::max(longest, squared_length(metric, p[(i + 1) % 3] - p[i]));
  return std::sqrt(std::max(0.0, squared_area(metric, p[1] - p[0], p[2] - p[0])) / longest);
}

/// Metric length of the least height of an element.
double least_height(const std::array<Vector<2>, 3>& p, const Site<2>& judge) {
  return least_height_of_triangle(p, judge.metric);
}
double least_height(const std::array<Vector<3>, 4>& p, const Site<3>& judge) {
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector<3>& origin = p[(i + 1) % 4];
    largest = std::max(
        largest, squared_area(judge.metric, p[(i + 2) % 4] - origin, p[(i + 3) % 4] - origin));
  }
  return metric_volume<3>(certain_determinant<3>(p), judge.scale) / std::sqrt(largest);
}

template <int Dim, std::size_t n>
std::array<Vector<Dim>, n> positions_of(const Mesh<Dim>& mesh,
                                        const std::array<VertexId, n>& vertices) {
  std::array<Vector<Dim>, n> positions;
  for (std::size_t i = 0; i < n; ++i) positions[i] = mesh.site_of[vertices[i]].position;
  return positions;
}

}  // namespace

template <int Dim>
bool Refine<Dim>::splits(const LongEdge& edge) const {
  Split split;
  Shell shell;
  shell_of(mesh_, edge.a, edge.b, shell);
  if (!locate(edge, shell, split)) return false;
  return std::all_of(shell.begin(), shell.end(), [&](ElementId element) {
    Cuts cuts{};
    const std::size_t k = edge_of<Dim>(mesh_.corners_of[element], edge.a, edge.b);
    Points points = points_of(element, cuts);
    points.set_middle(k, split);
    Pieces<Dim> pieces;
    Qualities qualities{mesh_.quality_of[element]};
    return cut(pieces, qualities, k, split, points);
  });
}

template <int Dim>
runtime::RoundsReport Refine<Dim>::run(runtime::UnsetVector<LongEdge> edges) {
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

// ---- Where the new vertices go ----

/// Has what is around edges soon after this one brought into the cache.
template <int Dim>
[[gnu::always_inline]] inline void Refine<Dim>::prefetch_shells_after(std::size_t number) const {
  for (const int stage : {2, 1}) {
    const std::size_t ahead = number + 3 * static_cast<std::size_t>(stage);
    if (ahead >= edges_.size()) continue;
    const auto [a, b] = std::pair(edges_[ahead].a, edges_[ahead].b);
    prefetch_shell(mesh_, a, b, stage);
    if (stage == 2) {
      __builtin_prefetch(&mesh_.host_of[a]);
      __builtin_prefetch(&mesh_.host_of[b]);
    } else {
      prefetch_site(mesh_, a);
      prefetch_site(mesh_, b);
      background_.prefetch(mesh_.host_of[a]);
    }
  }
}

/// Sets what becomes of the edges, and which of them cut which elements.
template <int Dim>
void Refine<Dim>::plan() {
  runtime::FreshMemory fresh;
  splits_.resize_for_overwrite(edges_.size(), fresh);
  fresh.touch(executor_);
  refused_in_ = make_filled<std::uint32_t>(executor_, edges_.size());
  asked_ = make_filled<std::uint8_t>(executor_, edges_.size());
  auto is_cut = make_filled<std::uint8_t>(executor_, mesh_.element_slots());
  around_ = runtime::parallel_collect<Around>(
      executor_, edges_.size(), [&](std::size_t i, auto&& append) {
        const auto number = static_cast<std::uint32_t>(i);
        prefetch_shells_after(i);
        Shell shell;
        shell_of(mesh_, edges_[i].a, edges_[i].b, shell);
        refused_in_[i] = !locate(edges_[i], shell, splits_[i]);
        if (!is_split(number)) return;
        for (const ElementId element : shell) {
          runtime::atomic_mark(is_cut[element]);
          append({element, number});
        }
      });
  if (around_.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("more elements around long edges than 32-bit numbers can count");
  elements_ = MarkedSet(executor_, is_cut);
  cuts_ = runtime::make_unset_vector<Cuts>(executor_, elements_.size());
  parallel_for(
      executor_, elements_.size(), [&](std::size_t place) { cuts_[place].split.fill(0); },
      few_nanoseconds);
  around_begin_ = make_filled<std::uint32_t>(executor_, edges_.size());
  const auto note = [this](std::size_t, std::size_t begin, std::size_t end) {
    note_splits(begin, end);
  };
  runtime::parallel_for_blocks(executor_, around_.size(), together, note, {});
}

/// Tells elements which of their edges are split, those of a block of around_. Where that is noted
/// is asked for ahead, block by block, as what is around other blocks may be changing.
template <int Dim>
void Refine<Dim>::note_splits(std::size_t begin, std::size_t end) {
  std::array<ElementId, together> elements;
  for (std::size_t i = begin; i < end; ++i) {
    elements[i - begin] = std::exchange(around_[i].place, elements_.place_of(around_[i].place));
    __builtin_prefetch(&mesh_.corners_of[elements[i - begin]]);
    __builtin_prefetch(&cuts_[around_[i].place], 1);
  }
  for (std::size_t i = begin; i < end; ++i) {
    const auto [place, number] = around_[i];
    const LongEdge& edge = edges_[number];
    const Corners<Dim>& corners = mesh_.corners_of[elements[i - begin]];
    cuts_[place].split[edge_of<Dim>(corners, edge.a, edge.b)] = number + 1;
    if (i == 0 || around_[i - 1].number != number)
      around_begin_[number] = static_cast<std::uint32_t>(i);
  }
}

/// False, and little is set, where the edge is refused for what it is or where it lies.
template <int Dim>
bool Refine<Dim>::locate(const LongEdge& edge, const Shell& shell, Split& split) const {
  if (!may_split(edge, shell)) return false;
  const Site<Dim>& a = mesh_.site_of[edge.a];
  const Site<Dim>& b = mesh_.site_of[edge.b];
  // Off the middle by up to 5 %, lest a regular mesh be refined into a regular mesh of worse
  // qualities, in which no single change is an improvement.
  const double chance = runtime::mix32(edge.a * 31 + edge.b) * (2.0 / 4294967296.0) - 1;
  const double t = metric_middle(a, b) + 0.05 * chance;
  const Vector<Dim> position = (1 - t) * a.position + t * b.position;
  const auto sample = background_.sample(position, mesh_.host_of[t < 0.5 ? edge.a : edge.b]);
  split.site = make_site(position, sample.metric);
  split.host = sample.host;
  // Where metrics are as thin as rounding is fine, what is between them may be no metric.
  if (!(split.site.scale > 0)) return false;
  classify(edge, shell, split);
  return !shorter_than(a, split.site, rules_.shortest_split) &&
         !shorter_than(b, split.site, rules_.shortest_split) &&
         !leads_through_layer(edge, shell, split);
}

/// Required elements, facets and edges stay as they are.
template <int Dim>
bool Refine<Dim>::may_split(const LongEdge& edge, const Shell& shell) const {
  for (const ElementId e : shell) {
    if (mesh_.required_element(e)) return false;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const VertexId opposite = mesh_.corners_of[e][i];
      if (opposite != edge.a && opposite != edge.b &&
          mesh_.patches[mesh_.patches_of[e][i]].required)
        return false;
    }
  }
  if constexpr (Dim == 3) {
    const CurveId curve = mesh_.curve_of(edge.a, edge.b);
    if (curve != 0 && mesh_.curves[curve].required) return false;
  }
  return true;
}

template <int Dim>
void Refine<Dim>::classify(const LongEdge& edge, const Shell& shell, Split& split) const {
  split.kind = {.class_dimension = Dim};
  split.entity = 0;
  split.length = edge.length;
  split.worst_around = 1;
  for (const ElementId e : shell) {
    split.worst_around = std::min(split.worst_around, mesh_.quality_of[e]);
    if (const PatchId patch = patch_of_edge(mesh_, e, edge.a, edge.b)) {
      split.entity = patch;
      split.kind.class_dimension = Dim - 1;
    }
  }
  if constexpr (Dim == 3)
    if (const CurveId curve = mesh_.curve_of(edge.a, edge.b)) {
      split.entity = curve;
      split.kind.class_dimension = 1;
    }
  const auto is_fine_or_spans = [&](ElementId e) {
    return mesh_.quality_of[e] >= rules_.poor_quality || spans_layer(e);
  };
  split.in_layer =
      split.kind.class_dimension < Dim && std::all_of(shell.begin(), shell.end(), is_fine_or_spans);
  // The references of corners mark points, and are of these only.
  const auto is_corner = [&](VertexId v) {
    return mesh_.kind_of[v].corner || mesh_.kind_of[v].required;
  };
  const std::int32_t reference = mesh_.reference_of[edge.a];
  const bool same = reference == mesh_.reference_of[edge.b];
  split.reference = same && !(is_corner(edge.a) && is_corner(edge.b)) ? reference : 0;
}

/// Does an element reach from one side of a layer to the other? None of its corners is inside.
template <int Dim>
bool Refine<Dim>::spans_layer(ElementId element) const {
  const Corners<Dim>& corners = mesh_.corners_of[element];
  return std::none_of(corners.begin(), corners.end(),
                      [&](VertexId v) { return mesh_.kind_of[v].class_dimension == Dim; });
}

/// Does an edge lead from one side of a thin layer to the other, or of a thin strip of a patch? A
/// vertex inside would be in the way of splits of the sides, after which swaps make the edge
/// shorter.
template <int Dim>
bool Refine<Dim>::leads_through_layer(const LongEdge& edge, const Shell& shell,
                                      const Split& split) const {
  const int inside = split.kind.class_dimension;
  const auto on_side = [&](VertexId v) { return mesh_.kind_of[v].class_dimension < inside; };
  if (inside < 2 || !on_side(edge.a) || !on_side(edge.b)) return false;
  return std::all_of(shell.begin(), shell.end(), [&](ElementId e) {
    const Corners<Dim>& corners = mesh_.corners_of[e];
    if (inside == Dim)
      return std::all_of(corners.begin(), corners.end(), on_side) &&
             least_height(positions_of(mesh_, corners), split.site) < rules_.short_edge;
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (mesh_.patches_of[e][i] == 0 || corners[i] == edge.a || corners[i] == edge.b) continue;
      const auto facet = facet_of<Dim>(corners, static_cast<int>(i));
      if (!std::all_of(facet.begin(), facet.end(), on_side)) return false;
      if constexpr (Dim == 3)
        if (!(least_height_of_triangle(positions_of(mesh_, facet), split.site.metric) <
              rules_.short_edge))
          return false;
    }
    return true;
  });
}

// ---- Who refuses ----

/// Has the points of elements soon after the one at this place brought into the cache.
template <int Dim>
[[gnu::always_inline]] inline void Refine<Dim>::prefetch_points_after(std::size_t place) const {
  constexpr std::size_t ahead = 3;
  if (place + 2 * ahead < elements_.size())
    __builtin_prefetch(&mesh_.corners_of[elements_[place + 2 * ahead]]);
  if (place + ahead >= elements_.size()) return;
  for (const VertexId v : mesh_.corners_of[elements_[place + ahead]]) prefetch_site(mesh_, v);
  for (const std::uint32_t split : cuts_[place + ahead].split)  // no branches: any may be cut
    __builtin_prefetch(&splits_[std::max(split, 1U) - 1].site);
}

/// As if edges were split one after the other, the longest first: one is refused only once it is
/// known which of those before it are.
template <int Dim>
void Refine<Dim>::refuse() {
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

/// Refuses what elements ask to, but where that may still change; returns the edges refused.
template <int Dim>
runtime::UnsetVector<std::uint32_t> Refine<Dim>::take_refused() {
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
template <int Dim>
bool Refine<Dim>::is_asked(std::uint32_t number) const {
  bool any = false;
  visit_cuts(number, [&](std::size_t place) {
    for (std::size_t k = 0; k < cuts_[place].split.size(); ++k)
      any = any || (cuts_[place].split[k] == number + 1 && (cuts_[place].asks >> k & 1U) != 0);
  });
  return any;
}

/// Is this the first edge that the elements around it ask to refuse? What they do with the others
/// may depend on it.
template <int Dim>
bool Refine<Dim>::goes_first(std::uint32_t number) const {
  bool first = true;
  visit_cuts(number, [&](std::size_t place) {
    for (const std::uint32_t split : cuts_[place].split)
      if (split != 0 && asked_[split - 1] != 0 && is_split(split - 1))
        first = first && !goes_before(split - 1, number);
  });
  return first;
}

/// Visits the places of the elements around an edge.
template <int Dim>
void Refine<Dim>::visit_cuts(std::uint32_t number, auto&& visit) const {
  for (std::size_t i = around_begin_[number]; i < around_.size() && around_[i].number == number;
       ++i)
    visit(around_[i].place);
}

/// An element that several edges refused in this round cut looks again once.
template <int Dim>
bool Refine<Dim>::first_refused_of(const Cuts& cuts, std::uint32_t number) const {
  for (const std::uint32_t split : cuts.split)
    if (split != 0 && split - 1 < number && refused_in_[split - 1] == round_) return false;
  return true;
}

/// Cuts an element for trial, and asks to refuse the edges by which it may not be cut.
template <int Dim>
void Refine<Dim>::look(std::size_t place) {
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

template <int Dim>
auto Refine<Dim>::order_of(const Cuts& cuts) const -> Order {
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

template <int Dim>
auto Refine<Dim>::points_of(ElementId element, const Cuts& cuts) const -> Points {
  Points points{element, {}, {}};
  for (std::size_t i = 0; i <= Dim; ++i)
    points.site[i] = &mesh_.site_of[mesh_.corners_of[element][i]];
  for (std::size_t k = 0; k < cuts.split.size(); ++k)
    if (cuts.split[k] != 0) points.set_middle(k, splits_[cuts.split[k] - 1]);
  return points;
}

template <int Dim>
static std::array<const Site<Dim>*, Dim + 1> sites_of(
    const Piece<Dim>& piece, const std::array<const Site<Dim>*, points_of_cut<Dim>>& points) {
  std::array<const Site<Dim>*, Dim + 1> sites;
  for (std::size_t i = 0; i <= Dim; ++i) sites[i] = points[piece.corners[i]];
  return sites;
}

/// Cuts an element into pieces that any rule accepts, whatever came before; false if there are
/// others.
template <int Dim>
bool Refine<Dim>::cut_freely(Cuts& cuts, const Order& order, const Points& points) const {
  Pieces<Dim> pieces;
  for (std::size_t i = 0; i < order.size; ++i) {
    if (!keeps_distance(pieces, order.edge[i], points)) return false;
    pieces.cut(order.edge[i]);
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    cuts.quality[p] = static_cast<float>(quality<Dim>(sites_of<Dim>(pieces[p], points.site)));
    if (!(cuts.quality[p] >= rules_.accepted_quality)) return false;
  }
  cuts.pieces = static_cast<std::uint32_t>(pieces.size());
  return true;
}

/// Cuts pieces along one edge, unless that makes an edge or a quality that the rules refuse; they
/// stay as they are then.
template <int Dim>
bool Refine<Dim>::cut(Pieces<Dim>& pieces, Qualities& qualities, std::size_t edge,
                      const Split& split, const Points& points) const {
  if (!keeps_distance(pieces, edge, points)) return false;
  Pieces<Dim> halves = pieces;
  halves.cut(edge);
  Qualities after = qualities;
  const auto is_fine = [&](std::size_t half, double before) {
    const double value = quality<Dim>(sites_of<Dim>(halves[half], points.site));
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
template <int Dim>
bool Refine<Dim>::keeps_distance(const Pieces<Dim>& pieces, std::size_t edge,
                                 const Points& points) const {
  const auto [a, b] = Simplex<Dim>::edge[edge];
  const Site<Dim>& middle = *points.site[middle_of<Dim>(edge)];
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
/// that is cut? How far they are from each other is for the layer to say, and no collapse may join
/// them.
template <int Dim>
bool Refine<Dim>::is_across(const Piece<Dim>& piece, std::size_t edge, PointOfCut corner,
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

/// Where the metric changes a lot over an element, as it does along overlong edges, its quality
/// tells little.
template <int Dim>
double Refine<Dim>::least_quality(double before, const Split& split) const {
  if (before < rules_.poor_quality)
    return split.in_layer ? rules_.layer_split_keeps * before : before;
  const double excess = std::max(1.0, split.length / rules_.overlong_edge);
  return std::min(rules_.split_keeps * before, rules_.accepted_quality) / (excess * excess);
}

template class Refine<2>;
template class Refine<3>;

}  // namespace ductile::meshadapt
