#include <algorithm>

#include "ductile/runtime/collect.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

/// Triangles a b c and b a d become a d c and d b c.
template <>
std::optional<Replacement<2>> Swap<2>::plan(const Swappable& edge) const {
  Shell shell;
  shell_of(mesh_, edge.a, edge.b, shell);
  if (shell.size() != 2 || mesh_.region_of[shell[0]] != mesh_.region_of[shell[1]] ||
      mesh_.required_element(shell[0]) || patch_of_edge(mesh_, shell[0], edge.a, edge.b) != 0)
    return {};
  const Corners<2>& first = mesh_.corners_of[shell[0]];
  const auto at_a = static_cast<std::size_t>(corner_of(first, edge.a));
  const bool forward = first[(at_a + 1) % 3] == edge.b;
  const VertexId a = forward ? edge.a : edge.b, b = forward ? edge.b : edge.a;
  const auto opposite = [&](ElementId e) {
    for (const VertexId v : mesh_.corners_of[e])
      if (v != a && v != b) return v;
    return none;
  };
  const VertexId c = opposite(shell[0]), d = opposite(shell[1]);
  Replacement<2> result;
  result.new_elements = {{a, d, c}, {d, b, c}};
  const double least = bar(std::min(mesh_.shape_of[shell[0]], mesh_.shape_of[shell[1]]));
  for (const Corners<2>& corners : result.new_elements)
    if (!(mesh_.shape_at(corners) > least)) return {};
  result.old_elements = {shell[0], shell[1]};
  return result;
}

template <>
void Swap<2>::apply(const Replacement<2>& plan, runtime::Commit<Swap>& commit) {
  replace(mesh_, plan, commit);
}

namespace {

/// Above this share of the others' squared lengths an edge is opposite to a wide angle: 78 degrees
/// if isosceles. It would be a right angle from 1 on, were the metric constant.
constexpr double wide = 0.8;

/// The corner of a triangle whose angle is wide, or -1. Only a flip of the edge opposite to it
/// makes better triangles.
int wide_corner(const Mesh<2>& mesh, ElementId element) {
  const auto corner = mesh.sites(mesh.corners_of[element]);
  const Metric<2>& metric = densest<2>(corner).metric;
  std::array<double, 3> square;
  for (std::size_t i = 0; i < 3; ++i)
    square[i] =
        squared_length(metric, corner[(i + 2) % 3]->position - corner[(i + 1) % 3]->position);
  const auto longest = std::max_element(square.begin(), square.end());
  const double others = square[0] + square[1] + square[2] - *longest;
  return *longest > wide * others ? static_cast<int>(longest - square.begin()) : -1;
}

}  // namespace

/// Flips are found from the poor triangle, as few are poor. One with a right angle always is: its
/// mean ratio is 0.87 at most.
template <>
std::vector<Swappable> Swap<2>::improvements(const runtime::Executor& executor, Mesh<2>& mesh,
                                             std::uint32_t after, double below) {
  const Swap swap(mesh);
  const double bound = shape_of_mean_ratio<2>(below);
  const auto poor = [&](ElementId e) { return mesh.shape_of[e] < bound && mesh.alive(e); };
  return runtime::parallel_collect<Swappable>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        if (!poor(element)) return;
        const int corner = wide_corner(mesh, element);
        if (corner < 0) return;
        const ElementId other = neighbour(mesh, element, corner);
        if (other == none || (mesh.changed_at[e] <= after && mesh.changed_at[other] <= after))
          return;
        const auto [a, b] = facet_of<2>(mesh.corners_of[e], corner);
        if (other < element && poor(other)) {
          const int at = wide_corner(mesh, other);
          if (at >= 0 && facet_of<2>(mesh.corners_of[other], at) == Facet<2>{b, a}) return;
        }
        const float worst = std::min(mesh.shape_of[e], mesh.shape_of[other]);
        const Swappable item{std::min(a, b), std::max(a, b), none, worst};
        if (swap.plan(item)) append(item);
      });
}

template class Swap<2>;

}  // namespace ductile::meshadapt
