/// @file
/// Refine's first stage: where new vertices go, and which elements each edge cuts. Here is what is
/// special about layers thinner than the size asked for (decision 51).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/refine.hpp"

namespace ductile::meshadapt {

using runtime::few_nanoseconds;
using runtime::make_filled;
using runtime::parallel_for;

namespace {

/// Elements around edges that are noted together.
constexpr std::size_t noted_together = 32;

/// Share of a-b at which its two halves have the same metric length; sizes vary geometrically.
template <int Dim>
double metric_middle(const Site<Dim>& a, const Site<Dim>& b) {
  const Vector<Dim> d = b.position - a.position;
  const double ratio = std::sqrt(squared_length(b.metric, d) / squared_length(a.metric, d));
  if (std::abs(ratio - 1) < 1e-3) return 0.5;
  return std::clamp(std::log(0.5 * (1 + ratio)) / std::log(ratio), 0.2, 0.8);
}

/// The number of the edge a-b in an element.
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
double area_squared(const Metric<Dim>& metric, const Vector<Dim>& u, const Vector<Dim>& v) {
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
  return std::sqrt(std::max(0.0, area_squared(metric, p[1] - p[0], p[2] - p[0])) / longest);
}

/// Metric length of the least height of an element.
template <int Space>
double least_height(const std::array<Vector<Space>, 3>& p, const Site<Space>& judge) {
  return least_height_of_triangle(p, judge.metric);
}
double least_height(const std::array<Vector<3>, 4>& p, const Site<3>& judge) {
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector<3>& origin = p[(i + 1) % 4];
    largest = std::max(
        largest, area_squared(judge.metric, p[(i + 2) % 4] - origin, p[(i + 3) % 4] - origin));
  }
  return metric_volume<3>(certain_determinant<3>(p), judge.scale) / std::sqrt(largest);
}

template <int Dim, int Space, std::size_t n>
std::array<Vector<Space>, n> positions_of(const Mesh<Dim, Space>& mesh,
                                          const std::array<VertexId, n>& vertices) {
  std::array<Vector<Space>, n> positions;
  for (std::size_t i = 0; i < n; ++i) positions[i] = mesh.site_of[vertices[i]].position;
  return positions;
}

/// How thick a layer is at an element that spans it, in the metric of a site. That of a surface is
/// measured from its sides: facets of CAD are needles from one rim to the other.
template <int Dim>
double thickness_at(const Mesh<Dim>& mesh, ElementId element, const Site<Dim>& judge) {
  return least_height(positions_of(mesh, mesh.corners_of[element]), judge);
}
double thickness_at(const Mesh<2, 3>& mesh, ElementId element, const Site<3>& judge) {
  const auto p = positions_of(mesh, mesh.corners_of[element]);
  const double area =
      std::sqrt(std::max(0.0, area_squared(judge.metric, p[1] - p[0], p[2] - p[0])));
  double thickness = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i)
    if (mesh.patches_of[element][i] != 0)
      thickness =
          std::min(thickness,
                   area / std::sqrt(squared_length(judge.metric, p[(i + 2) % 3] - p[(i + 1) % 3])));
  return std::isinf(thickness) ? least_height(p, judge) : thickness;
}

}  // namespace

template <int Dim, int Space>
bool Refine<Dim, Space>::splits(const LongEdge& edge) const {
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

/// Prefetches the surroundings of edges soon after this one.
template <int Dim, int Space>
[[gnu::always_inline]] inline void Refine<Dim, Space>::prefetch_shells_after(
    std::size_t number) const {
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

/// Locates the new vertices, and notes which edges cut which elements.
template <int Dim, int Space>
void Refine<Dim, Space>::plan() {
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
  runtime::parallel_for_blocks(executor_, around_.size(), noted_together, note, {});
}

/// Notes in the elements of a block of around_ which of their edges are split. Prefetches no
/// further than the block, because other threads may be changing the other blocks.
template <int Dim, int Space>
void Refine<Dim, Space>::note_splits(std::size_t begin, std::size_t end) {
  std::array<ElementId, noted_together> elements;
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

/// Returns false, with `split` incomplete, if the edge itself or its place is refused.
template <int Dim, int Space>
bool Refine<Dim, Space>::locate(const LongEdge& edge, const Shell& shell, Split& split) const {
  if (!may_split(edge, shell)) return false;
  const Site<Space>& a = mesh_.site_of[edge.a];
  const Site<Space>& b = mesh_.site_of[edge.b];
  // Up to 5 % off the middle: otherwise a regular mesh may become a regular mesh of worse
  // qualities, in which no single change is an improvement.
  const double chance = runtime::mix32(edge.a * 31 + edge.b) * (2.0 / 4294967296.0) - 1;
  const double t = metric_middle(a, b) + 0.05 * chance;
  const Vector<Space> position = (1 - t) * a.position + t * b.position;
  const auto sample = background_.sample(position, mesh_.host_of[t < 0.5 ? edge.a : edge.b]);
  split.site = make_site(position, sample.metric);
  split.host = sample.host;
  // Between metrics stretched up to rounding, the interpolated tensor may be no metric.
  if (!(split.site.scale > 0)) return false;
  classify(edge, shell, split);
  return !shorter_than(a, split.site, rules_.shortest_split) &&
         !shorter_than(b, split.site, rules_.shortest_split) &&
         !leads_through_layer(edge, shell, split);
}

/// Required elements, facets and edges stay as they are.
template <int Dim, int Space>
bool Refine<Dim, Space>::may_split(const LongEdge& edge, const Shell& shell) const {
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

template <int Dim, int Space>
void Refine<Dim, Space>::classify(const LongEdge& edge, const Shell& shell, Split& split) const {
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
  // The reference of a corner marks this point, so edges do not take it over.
  const auto is_corner = [&](VertexId v) {
    return mesh_.kind_of[v].corner || mesh_.kind_of[v].required;
  };
  const std::int32_t reference = mesh_.reference_of[edge.a];
  const bool same = reference == mesh_.reference_of[edge.b];
  split.reference = same && !(is_corner(edge.a) && is_corner(edge.b)) ? reference : 0;
}

/// Does an element reach from one side of a layer to the other? None of its corners is inside.
template <int Dim, int Space>
bool Refine<Dim, Space>::spans_layer(ElementId element) const {
  const Corners<Dim>& corners = mesh_.corners_of[element];
  return std::none_of(corners.begin(), corners.end(),
                      [&](VertexId v) { return mesh_.kind_of[v].class_dimension == Dim; });
}

/// Does an edge lead from one side of a thin layer to the other, or of a thin strip of a patch? A
/// vertex inside would be in the way of splits of the sides, after which swaps make the edge
/// shorter.
template <int Dim, int Space>
bool Refine<Dim, Space>::leads_through_layer(const LongEdge& edge, const Shell& shell,
                                             const Split& split) const {
  const int inside = split.kind.class_dimension;
  const auto on_side = [&](VertexId v) { return mesh_.kind_of[v].class_dimension < inside; };
  if (inside < 2 || !on_side(edge.a) || !on_side(edge.b)) return false;
  return std::all_of(shell.begin(), shell.end(), [&](ElementId e) {
    const Corners<Dim>& corners = mesh_.corners_of[e];
    if (inside == Dim)
      return std::all_of(corners.begin(), corners.end(), on_side) &&
             thickness_at(mesh_, e, split.site) < rules_.short_edge;
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

template bool Refine<2>::splits(const LongEdge&) const;
template bool Refine<2, 3>::splits(const LongEdge&) const;
template bool Refine<3>::splits(const LongEdge&) const;
template bool Refine<2>::may_split(const LongEdge&, const Shell&) const;
template bool Refine<2, 3>::may_split(const LongEdge&, const Shell&) const;
template bool Refine<3>::may_split(const LongEdge&, const Shell&) const;
template void Refine<2>::plan();
template void Refine<2, 3>::plan();
template void Refine<3>::plan();

}  // namespace ductile::meshadapt
