#include "mesh/mesh.hpp"

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/grouping.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

template <int Dim, int Space>
void Mesh<Dim, Space>::grow(const Executor& executor, std::size_t vertices, std::size_t elements) {
  runtime::FreshMemory fresh;
  const auto resize = [&](std::size_t n, auto&... arrays) {
    (arrays.resize_for_overwrite(n, fresh), ...);
  };
  resize(elements, corners_of, patches_of, region_of, quality_of, changed_at);
  resize(vertices, site_of, kind_of, entity_of, reference_of, host_of);
  elements_of.grow(vertices, fresh);
  if constexpr (Dim == 3) links_of.grow(vertices, fresh);
  fresh.touch(executor);
}

/// Chunks that end where the lowest corner of the elements, if they are in order, changes.
template <int Dim, int Space>
static GroupingBounds bounds_by_lowest(const Executor& executor, const Mesh<Dim, Space>& mesh) {
  auto bounds = GroupingBounds::even(executor, mesh.element_slots(), mesh.vertex_slots());
  for (std::size_t c = 1; c < bounds.chunk_count(); ++c) {
    const Corners<Dim>& corners = mesh.corners_of[bounds.items[c]];
    const VertexId lowest = *std::min_element(corners.begin(), corners.end());
    bounds.keys[c] = lowest != none ? lowest : bounds.keys[c - 1];
  }
  std::sort(bounds.keys.begin() + 1, bounds.keys.end() - 1);
  return bounds;
}

template <int Dim, int Space>
void rebuild_elements_of(const Executor& executor, Mesh<Dim, Space>& mesh) {
  auto count_of = runtime::make_unset_vector<std::uint32_t>(executor, mesh.vertex_slots());
  auto& lists = mesh.elements_of;
  Grouping grouping(executor, bounds_by_lowest(executor, mesh), std::span(count_of),
                    [&mesh](ElementId element, auto&& visit) {
                      if (!mesh.alive(element)) return;
                      for (const VertexId v : mesh.corners_of[element]) visit(v);
                    });
  runtime::FreshMemory fresh;
  lists.reset_for_overwrite(mesh.vertex_slots(), fresh);
  fresh.touch(executor);
  const auto make_room = [&](VertexId begin, VertexId end, std::uint32_t) {
    for (VertexId from = begin; from < end; from += list_block)
      lists.reserve_all(from, std::min(end, from + list_block), [&](VertexId v) {
        return count_of[v] == 0 ? 0 : count_of[v] + list_slack<Dim>;
      });
  };
  grouping.visit(make_room, [&](VertexId v, ElementId element) {
    lists.data(v)[lists.count_of(v)++] = element;
  });
}

/// Is any of these numbers larger than a bound? Branch-free, so it is vectorised.
static bool any_above(std::span<const std::uint32_t> numbers, std::uint32_t bound) {
  std::uint32_t any = 0;
  for (const std::uint32_t number : numbers) any |= static_cast<std::uint32_t>(number > bound);
  return any != 0;
}

template <int Dim, int Space>
runtime::UnsetVector<std::uint8_t> mark_changed(const Executor& executor,
                                                const Mesh<Dim, Space>& mesh, std::uint32_t after) {
  constexpr std::size_t stretch = 64;
  auto marked = runtime::make_filled<std::uint8_t>(executor, mesh.vertex_slots());
  const auto mark = [&](std::size_t, std::size_t begin, std::size_t end) {
    if (!any_above(std::span(mesh.changed_at).subspan(begin, end - begin), after)) return;
    // Lists them first, branch-free, because branches on changes would be unpredictable.
    std::array<ElementId, stretch> changed;
    std::size_t count = 0;
    for (std::size_t e = begin; e < end; ++e) {
      changed[count] = static_cast<ElementId>(e);
      count += static_cast<std::size_t>(mesh.changed_at[e] > after);
    }
    for (std::size_t i = 0; i < count; ++i)
      if (mesh.alive(changed[i]))
        for (const VertexId v : mesh.corners_of[changed[i]]) runtime::atomic_set(marked[v]);
  };
  runtime::parallel_for_blocks(executor, mesh.element_slots(), stretch, mark,
                               {.serial_below = 2048 / stretch});
  return marked;
}

template <int Dim, int Space>
void update_qualities(const Executor& executor, Mesh<Dim, Space>& mesh) {
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    if (mesh.alive(static_cast<ElementId>(e)))
      mesh.quality_of[e] = static_cast<float>(mesh.quality_at(mesh.corners_of[e]));
  });
}

template struct Mesh<2>;
template struct Mesh<2, 3>;
template struct Mesh<3>;
template void rebuild_elements_of(const Executor&, Mesh<2>&);
template void rebuild_elements_of(const Executor&, Mesh<2, 3>&);
template void rebuild_elements_of(const Executor&, Mesh<3>&);
template runtime::UnsetVector<std::uint8_t> mark_changed(const Executor&, const Mesh<2>&,
                                                         std::uint32_t);
template runtime::UnsetVector<std::uint8_t> mark_changed(const Executor&, const Mesh<2, 3>&,
                                                         std::uint32_t);
template runtime::UnsetVector<std::uint8_t> mark_changed(const Executor&, const Mesh<3>&,
                                                         std::uint32_t);
template void update_qualities(const Executor&, Mesh<2>&);
template void update_qualities(const Executor&, Mesh<2, 3>&);
template void update_qualities(const Executor&, Mesh<3>&);

}  // namespace ductile::meshadapt
