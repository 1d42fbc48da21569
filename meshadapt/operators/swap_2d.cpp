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
  const float worst =
      std::min(mesh_.shape_of[plan.old_elements[0]], mesh_.shape_of[plan.old_elements[1]]);
  const auto& [a, d, c] = plan.new_elements[0];
  const VertexId b = plan.new_elements[1][1];
  for (const auto& [p, q] : {std::pair{a, d}, {d, b}, {b, c}, {c, a}})
    commit.wake({std::min(p, q), std::max(p, q), none, worst});
}

template <>
std::vector<Swappable> Swap<2>::improvements(const runtime::Executor& executor, Mesh<2>& mesh,
                                             std::uint32_t after, double below) {
  const Swap swap(mesh);
  return runtime::parallel_collect<Swappable>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        if (!mesh.alive(element) || mesh.changed_at[e] <= after) return;
        for (int i = 0; i < 3; ++i) {
          const auto [a, b] = facet_of<2>(mesh.corners_of[e], i);
          const ElementId other = neighbour(mesh, element, i);
          if (other == none || (other < element && mesh.changed_at[other] > after)) continue;
          const float worst = std::min(mesh.shape_of[e], mesh.shape_of[other]);
          const Swappable item{std::min(a, b), std::max(a, b), none, worst};
          if (worst < shape_of_mean_ratio<2>(below) && swap.plan(item)) append(item);
        }
      });
}

template class Swap<2>;

}  // namespace ductile::meshadapt
