#include "ductile/meshadapt/mesh.hpp"

#include <algorithm>
#include <span>

#include "ductile/runtime/atomic_count.hpp"
#include "ductile/runtime/atomic_mark.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

template <int Dim>
void Mesh<Dim>::grow(std::size_t vertices, std::size_t elements) {
  corners_of.resize_for_overwrite(elements);
  patches_of.resize_for_overwrite(elements);
  region_of.resize_for_overwrite(elements);
  shape_of.resize_for_overwrite(elements);
  changed_at.resize_for_overwrite(elements);
  site_of.resize_for_overwrite(vertices);
  kind_of.resize_for_overwrite(vertices);
  entity_of.resize_for_overwrite(vertices);
  reference_of.resize_for_overwrite(vertices);
  host_of.resize_for_overwrite(vertices);
  elements_of.grow(vertices);
  if constexpr (Dim == 3) links_of.grow(vertices);
}

template <int Dim>
void rebuild_elements_of(const Executor& executor, Mesh<Dim>& mesh) {
  auto& lists = mesh.elements_of;
  lists.reset(mesh.vertex_slots());
  std::vector<std::uint32_t> count(mesh.vertex_slots());
  const auto each_corner = [&](auto&& visit) {
    parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
      const auto element = static_cast<ElementId>(e);
      if (!mesh.alive(element)) return;
      for (const VertexId v : mesh.corners_of[element]) visit(v, element);
    });
  };
  each_corner([&](VertexId v, ElementId) { runtime::atomic_count(count[v]); });
  const auto make_room = [&](std::size_t, std::size_t begin, std::size_t end) {
    lists.reserve_all(static_cast<VertexId>(begin), static_cast<VertexId>(end),
                      [&](VertexId v) { return count[v] == 0 ? 0 : count[v] + list_slack<Dim>; });
  };
  runtime::parallel_for_blocks(executor, mesh.vertex_slots(), list_block, make_room);
  each_corner([&](VertexId v, ElementId element) {
    lists.data(v)[runtime::atomic_count(lists.count_of(v))] = element;
  });
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    const auto vertex = static_cast<VertexId>(v);
    if (count[v] != 0) std::sort(lists.data(vertex), lists.data(vertex) + count[v]);
  });
}

/// Is any of these numbers larger than a bound? Without branches, so several at once.
static bool any_above(std::span<const std::uint32_t> numbers, std::uint32_t bound) {
  std::uint32_t any = 0;
  for (const std::uint32_t number : numbers) any |= static_cast<std::uint32_t>(number > bound);
  return any != 0;
}

template <int Dim>
std::vector<std::uint8_t> mark_changed(const Executor& executor, const Mesh<Dim>& mesh,
                                       std::uint32_t after) {
  constexpr std::size_t stretch = 64;
  std::vector<std::uint8_t> marked(mesh.vertex_slots());
  const auto mark = [&](std::size_t, std::size_t begin, std::size_t end) {
    if (!any_above(std::span(mesh.changed_at).subspan(begin, end - begin), after)) return;
    for (std::size_t e = begin; e < end; ++e) {
      if (mesh.changed_at[e] <= after || !mesh.alive(static_cast<ElementId>(e))) continue;
      for (const VertexId v : mesh.corners_of[e]) runtime::atomic_set(marked[v]);
    }
  };
  runtime::parallel_for_blocks(executor, mesh.element_slots(), stretch, mark, {});
  return marked;
}

template <int Dim>
std::vector<VertexId> vertices_changed(const Executor& executor, const Mesh<Dim>& mesh,
                                       std::uint32_t after) {
  const auto marked = mark_changed(executor, mesh, after);
  return runtime::parallel_collect<VertexId>(executor, marked.size(),
                                             [&](std::size_t v, auto&& append) {
                                               if (marked[v]) append(static_cast<VertexId>(v));
                                             });
}

template <int Dim>
void update_shapes(const Executor& executor, Mesh<Dim>& mesh) {
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    if (mesh.alive(static_cast<ElementId>(e)))
      mesh.shape_of[e] = static_cast<float>(mesh.shape_at(mesh.corners_of[e]));
  });
}

template struct Mesh<2>;
template struct Mesh<3>;
template void rebuild_elements_of(const Executor&, Mesh<2>&);
template void rebuild_elements_of(const Executor&, Mesh<3>&);
template std::vector<std::uint8_t> mark_changed(const Executor&, const Mesh<2>&, std::uint32_t);
template std::vector<std::uint8_t> mark_changed(const Executor&, const Mesh<3>&, std::uint32_t);
template std::vector<VertexId> vertices_changed(const Executor&, const Mesh<2>&, std::uint32_t);
template std::vector<VertexId> vertices_changed(const Executor&, const Mesh<3>&, std::uint32_t);
template void update_shapes(const Executor&, Mesh<2>&);
template void update_shapes(const Executor&, Mesh<3>&);

}  // namespace ductile::meshadapt
