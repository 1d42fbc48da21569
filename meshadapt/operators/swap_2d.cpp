#include <algorithm>
#include <array>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

namespace {

/// Two triangles that share an edge: a b c and b a d.
struct Kite {
  ElementId first, second;
  VertexId a, b, c, d;
};

/// The triangle, and the one across the edge opposite to its corner.
template <int Space>
Kite make_kite(const Mesh<2, Space>& mesh, ElementId first, int corner, ElementId second) {
  const auto [a, b] = facet_of<2>(mesh.corners_of[first], corner);
  const auto [x, y, z] = mesh.corners_of[second];
  const VertexId d = x != a && x != b ? x : y != a && y != b ? y : z;
  return {first, second, a, b, mesh.corners_of[first][static_cast<std::size_t>(corner)], d};
}

/// Do the triangles a d c and d b c lie on the patch of the surface that they are to be a part of?
bool flips_on_patch(const Mesh<2>&, const Kite&) { return true; }
bool flips_on_patch(const Mesh<2, 3>& mesh, const Kite& kite) {
  const auto at = [&](VertexId v) { return mesh.site_of[v].position; };
  const std::uint32_t region = mesh.region_of[kite.first];
  return is_on_patch(mesh, {at(kite.a), at(kite.d), at(kite.c)}, region) &&
         is_on_patch(mesh, {at(kite.d), at(kite.b), at(kite.c)}, region);
}

/// May the shared edge go, are triangles a d c and d b c better, and may the edge c-d be?
template <int Space>
bool worth_a_flip(const Mesh<2, Space>& mesh, const Kite& kite, const EdgeRange& range) {
  const auto [first, second, a, b, c, d] = kite;
  if (mesh.region_of[first] != mesh.region_of[second] || mesh.required_element(first) ||
      patch_of_edge(mesh, first, a, b) != 0)
    return false;
  const double least =
      Swap<2, Space>::bar(std::min(mesh.quality_of[first], mesh.quality_of[second]));
  return quality_above<2>(mesh.sites({a, d, c}), least) &&
         quality_above<2>(mesh.sites({d, b, c}), least) &&
         (!range.is_bounded() || range.accepts(end_squares(mesh.site_of[c], mesh.site_of[d]),
                                               end_squares(mesh.site_of[a], mesh.site_of[b]))) &&
         flips_on_patch(mesh, kite);
}

bool decide_flip(const auto& mesh, const EdgeRange& range, const Swappable& edge,
                 const Shell& shell, Replacement<2>& plan) {
  if (shell.size() != 2) return false;
  const Corners<2>& first = mesh.corners_of[shell[0]];
  int corner = 0;
  while (first[static_cast<std::size_t>(corner)] == edge.a ||
         first[static_cast<std::size_t>(corner)] == edge.b)
    ++corner;
  const Kite kite = make_kite(mesh, shell[0], corner, shell[1]);
  if (!worth_a_flip(mesh, kite, range)) return false;
  plan.old_elements = {kite.first, kite.second};
  plan.new_elements = {{kite.a, kite.d, kite.c}, {kite.d, kite.b, kite.c}};
  return true;
}

}  // namespace

template <>
bool Swap<2>::decide(const Swappable& edge, const Shell& shell, Plan& plan) const {
  return decide_flip(mesh_, range_, edge, shell, plan);
}
template <>
bool Swap<2, 3>::decide(const Swappable& edge, const Shell& shell, Plan& plan) const {
  return decide_flip(mesh_, range_, edge, shell, plan);
}

namespace {

/// Above this share of the others' squared lengths an edge is opposite to a wide angle: 78 degrees
/// if isosceles. It would be a right angle from 1 on, were the metric constant.
constexpr double wide = 0.8;

/// The corner of a triangle whose angle is wide, or -1. Only a flip of the edge opposite to it
/// makes better triangles.
template <int Space>
int wide_corner(const Mesh<2, Space>& mesh, ElementId element) {
  const auto corner = mesh.sites(mesh.corners_of[element]);
  const Metric<Space> metric = mean_metric<Space>(corner).metric;
  std::array<double, 3> square;
  for (std::size_t i = 0; i < 3; ++i)
    square[i] =
        squared_length(metric, corner[(i + 2) % 3]->position - corner[(i + 1) % 3]->position);
  const double longest = std::max({square[0], square[1], square[2]});
  const double others = square[0] + square[1] + square[2] - longest;
  const int at = square[2] == longest ? 2 : static_cast<int>(square[1] == longest);
  return longest > wide * others ? at : -1;
}

/// Looks for flips in a stretch of elements after the other. Each step of the search picks some of
/// what the one before has left, without branches, for chance decides which.
template <int Space>
class FlipSearch {
 public:
  static constexpr std::size_t stretch = 64;

  FlipSearch(const runtime::Executor& executor, const Mesh<2, Space>& mesh, std::uint32_t after,
             double below, const EdgeRange& range)
      : mesh_(mesh),
        after_(after),
        range_(range),
        bound_(static_cast<float>(quality_of_mean_ratio<2>(below))),
        marked_(mark_changed(executor, mesh, after)) {}

  void find(std::size_t begin, std::size_t end, auto&& append) const {
    std::array<ElementId, stretch> poor;
    std::array<Candidate, stretch> candidate;
    std::size_t count = 0, near = 0, found = 0;
    for (std::size_t e = begin; e < end; ++e) {
      poor[count] = static_cast<ElementId>(e);
      count += is_poor(poor[count]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      poor[near] = poor[i];
      near += near_changes(poor[i]);
    }
    for (std::size_t i = 0; i < near; ++i) {
      const int corner = wide_corner(mesh_, poor[i]);
      candidate[found] = {poor[i], corner};
      found += corner >= 0;
      mesh_.elements_of.prefetch(mesh_.corners_of[poor[i]][next(corner)]);
    }
    for (std::size_t i = 0; i < found; ++i) examine(candidate[i], append);
  }

 private:
  struct Candidate {
    ElementId element;
    int corner;  // that is wide
  };

  static std::size_t next(int corner) { return static_cast<std::size_t>(corner + 1) % 3; }

  bool is_poor(ElementId e) const {
    return static_cast<int>(mesh_.quality_of[e] < bound_) & static_cast<int>(mesh_.alive(e));
  }

  bool near_changes(ElementId e) const {
    const auto [p, q, r] = mesh_.corners_of[e];
    return marked_[p] + marked_[q] + marked_[r] >= 2;
  }

  void examine(const Candidate& candidate, auto&& append) const {
    const auto [e, corner] = candidate;
    const ElementId other = neighbour(mesh_, e, corner);
    if (other == none || (mesh_.changed_at[e] <= after_ && mesh_.changed_at[other] <= after_))
      return;
    const Kite kite = make_kite(mesh_, e, corner, other);
    if (other < e && is_poor(other)) {  // found from there if its corner on the other side is wide
      const int at = wide_corner(mesh_, other);
      if (at >= 0 && mesh_.corners_of[other][static_cast<std::size_t>(at)] == kite.d) return;
    }
    if (!worth_a_flip(mesh_, kite, range_)) return;
    const float worst = std::min(mesh_.quality_of[e], mesh_.quality_of[other]);
    append(Swappable{std::min(kite.a, kite.b), std::max(kite.a, kite.b), none, worst});
  }

  const Mesh<2, Space>& mesh_;
  std::uint32_t after_;
  EdgeRange range_;
  float bound_;
  runtime::UnsetVector<std::uint8_t> marked_;
};

/// Flips are found from the poor triangle, as few are poor. One with a right angle always is: its
/// mean ratio is 0.87 at most. If neither it nor the triangle across its longest edge has changed,
/// nothing is new; that is so where less than two of its corners are next to a change.
template <int Space>
runtime::UnsetVector<Swappable> find_flips(const runtime::Executor& executor, std::size_t elements,
                                           const FlipSearch<Space>& search) {
  constexpr std::size_t stretch = FlipSearch<Space>::stretch;
  return runtime::parallel_collect<Swappable>(
      executor, (elements + stretch - 1) / stretch, [&](std::size_t i, auto&& append) {
        search.find(i * stretch, std::min(elements, (i + 1) * stretch), append);
      });
}

}  // namespace

template <>
runtime::UnsetVector<Swappable> Swap<2>::improvements(const runtime::Executor& executor,
                                                      Mesh<2>& mesh, std::uint32_t after,
                                                      double below, const EdgeRange& range) {
  return find_flips<2>(executor, mesh.element_slots(), {executor, mesh, after, below, range});
}
template <>
runtime::UnsetVector<Swappable> Swap<2, 3>::improvements(const runtime::Executor& executor,
                                                         Mesh<2, 3>& mesh, std::uint32_t after,
                                                         double below, const EdgeRange& range) {
  return find_flips<3>(executor, mesh.element_slots(), {executor, mesh, after, below, range});
}

template class Swap<2>;
template class Swap<2, 3>;

}  // namespace ductile::meshadapt
