/// @file
/// Renumbering: vertices are sorted along a Hilbert curve through the bounding box, elements by
/// their lowest vertex; whatever is gone is left out.
#include <algorithm>
#include <memory>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <class Key>
struct Keyed {
  Key key;
  std::uint32_t id;
  friend auto operator<=>(const Keyed&, const Keyed&) = default;
};

template <int Dim>
Box<Dim> bounding_box(const Executor& executor, const Mesh<Dim>& mesh) {
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Box<Dim>::empty(),
      [&](std::size_t v) {
        if (!mesh.vertex_alive(static_cast<VertexId>(v))) return Box<Dim>::empty();
        return Box<Dim>{mesh.site_of[v].position, mesh.site_of[v].position};
      },
      [](const Box<Dim>& a, const Box<Dim>& b) { return join(a, b); });
}

/// Living vertices in the order of the curve.
template <int Dim>
std::vector<Keyed<std::uint64_t>> sorted_vertices(const Executor& executor, const Mesh<Dim>& mesh) {
  const Box<Dim> box = bounding_box(executor, mesh);
  auto order = runtime::parallel_collect<Keyed<std::uint64_t>>(
      executor, mesh.vertex_slots(), [&](std::size_t v, auto&& append) {
        const auto vertex = static_cast<VertexId>(v);
        if (mesh.vertex_alive(vertex)) append({hilbert_key(mesh.site_of[v].position, box), vertex});
      });
  runtime::parallel_sort(executor, std::span(order));
  return order;
}

/// Living elements by their lowest vertex in the new numbering.
template <int Dim>
std::vector<Keyed<VertexId>> sorted_elements(const Executor& executor, const Mesh<Dim>& mesh,
                                             const std::vector<VertexId>& new_id) {
  auto order = runtime::parallel_collect<Keyed<VertexId>>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        if (!mesh.alive(element)) return;
        VertexId lowest = none;
        for (const VertexId v : mesh.corners_of[e]) lowest = std::min(lowest, new_id[v]);
        append({lowest, element});
      });
  runtime::parallel_sort(executor, std::span(order));
  return order;
}

/// values[i] becomes the old values[order[i].id]. There and back again: a new vector would be set
/// to zero, and a full one copied when it grows, by one thread; this one keeps room to grow.
template <class T, class Order>
void permute(const Executor& executor, std::vector<T>& values, const Order& order) {
  const auto moved = std::make_unique_for_overwrite<T[]>(order.size());
  parallel_for(executor, order.size(), [&](std::size_t i) { moved[i] = values[order[i].id]; });
  values.resize(order.size());
  runtime::parallel_for_ranges(executor, order.size(), [&](std::size_t begin, std::size_t end) {
    std::copy(&moved[begin], &moved[0] + end, &values[begin]);
  });
}

template <class Order>
void renumber_links(const Executor& executor, Mesh<3>& mesh, const Order& order,
                    const std::vector<VertexId>& new_id) {
  ListPool<CurveLink> moved;
  moved.reset(order.size());
  parallel_for(executor, order.size(), [&](std::size_t i) {
    for (const CurveLink& link : mesh.links_of.of(order[i].id))
      moved.insert(static_cast<VertexId>(i), {new_id[link.to], link.curve});
  });
  std::swap(mesh.links_of, moved);
}

/// The place of each id in an order, or none.
template <class Order>
std::vector<std::uint32_t> places(const Executor& executor, const Order& order, std::size_t slots) {
  std::vector<std::uint32_t> place_of(slots, none);
  parallel_for(executor, order.size(),
               [&](std::size_t i) { place_of[order[i].id] = static_cast<std::uint32_t>(i); });
  return place_of;
}

template <int Dim, class Order>
void renumber_neighbours(const Executor& executor, Neighbours<Dim>& neighbours,
                         const Order& elements) {
  const auto new_id = places(executor, elements, neighbours.size());
  permute(executor, neighbours, elements);
  parallel_for(executor, neighbours.size(), [&](std::size_t e) {
    for (ElementId& other : neighbours[e])
      if (other != none) other = new_id[other];
  });
}

/// The neighbours may be missing.
template <int Dim>
void renumber_all(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>* neighbours) {
  const auto vertices = sorted_vertices(executor, mesh);
  const auto new_id = places(executor, vertices, mesh.vertex_slots());
  const auto elements = sorted_elements(executor, mesh, new_id);
  permute(executor, mesh.corners_of, elements);
  permute(executor, mesh.patches_of, elements);
  permute(executor, mesh.region_of, elements);
  permute(executor, mesh.shape_of, elements);
  permute(executor, mesh.changed_at, elements);
  parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (VertexId& v : mesh.corners_of[e]) v = new_id[v];
  });
  permute(executor, mesh.site_of, vertices);
  permute(executor, mesh.kind_of, vertices);
  permute(executor, mesh.entity_of, vertices);
  permute(executor, mesh.reference_of, vertices);
  permute(executor, mesh.host_of, vertices);
  if constexpr (Dim == 3) renumber_links(executor, mesh, vertices, new_id);
  rebuild_elements_of(executor, mesh);
  if (neighbours != nullptr) renumber_neighbours<Dim>(executor, *neighbours, elements);
}

}  // namespace

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh) {
  renumber_all<Dim>(executor, mesh, nullptr);
}

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>& neighbours) {
  renumber_all<Dim>(executor, mesh, &neighbours);
}

template void renumber(const Executor&, Mesh<2>&);
template void renumber(const Executor&, Mesh<3>&);
template void renumber(const Executor&, Mesh<2>&, Neighbours<2>&);
template void renumber(const Executor&, Mesh<3>&, Neighbours<3>&);

}  // namespace ductile::meshadapt
