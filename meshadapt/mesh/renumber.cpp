/// @file
/// Renumbering: vertices are sorted along a Hilbert curve through the bounding box, elements by
/// their lowest vertex; whatever is gone sorts to the end and is cut off.
#include <limits>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

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
struct Box {
  Vector<Dim> low, high;
};

template <int Dim>
Box<Dim> bounding_box(const Executor& executor, const Mesh<Dim>& mesh) {
  Box<Dim> empty;
  empty.low.x.fill(std::numeric_limits<double>::infinity());
  empty.high.x.fill(-std::numeric_limits<double>::infinity());
  const auto join = [](Box<Dim> a, const Box<Dim>& b) {
    for (int i = 0; i < Dim; ++i) {
      a.low[i] = std::min(a.low[i], b.low[i]);
      a.high[i] = std::max(a.high[i], b.high[i]);
    }
    return a;
  };
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), empty,
      [&](std::size_t v) {
        if (!mesh.vertex_alive(static_cast<VertexId>(v))) return empty;
        return Box<Dim>{mesh.site_of[v].position, mesh.site_of[v].position};
      },
      join);
}

/// Position along the Hilbert curve of a cell given by `bits` bits an axis (Skilling, AIP Conf.
/// Proc. 707, 2004): coordinates are transposed in place, then interleaved.
template <int Dim>
std::uint64_t hilbert_key(std::array<std::uint32_t, Dim> x, int bits) {
  const std::uint32_t top = 1U << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    for (std::size_t i = 0; i < Dim; ++i) {
      if (x[i] & q) {
        x[0] ^= q - 1;
      } else {
        const std::uint32_t t = (x[0] ^ x[i]) & (q - 1);
        x[0] ^= t;
        x[i] ^= t;
      }
    }
  for (std::size_t i = 1; i < Dim; ++i) x[i] ^= x[i - 1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    if (x[Dim - 1] & q) t ^= q - 1;
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (std::size_t i = 0; i < Dim; ++i) key = key << 1U | (((x[i] ^ t) >> bit) & 1U);
  return key;
}

/// Living vertices in the order of the curve.
template <int Dim>
std::vector<Keyed<std::uint64_t>> sorted_vertices(const Executor& executor, const Mesh<Dim>& mesh) {
  constexpr int bits = Dim == 2 ? 24 : 20;
  const Box<Dim> box = bounding_box(executor, mesh);
  std::vector<Keyed<std::uint64_t>> order(mesh.vertex_slots());
  parallel_for(executor, order.size(), [&](std::size_t v) {
    const auto vertex = static_cast<VertexId>(v);
    std::array<std::uint32_t, Dim> cell{};
    for (int i = 0; i < Dim; ++i) {
      const double width = std::max(box.high[i] - box.low[i], std::numeric_limits<double>::min());
      const double at = (mesh.site_of[v].position[i] - box.low[i]) / width;
      cell[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(at * ((1U << bits) - 1));
    }
    order[v] = {mesh.vertex_alive(vertex) ? hilbert_key<Dim>(cell, bits) : ~std::uint64_t{0},
                vertex};
  });
  runtime::parallel_sort(executor, std::span(order));
  while (!order.empty() && order.back().key == ~std::uint64_t{0}) order.pop_back();
  return order;
}

/// Living elements by their lowest vertex in the new numbering.
template <int Dim>
std::vector<Keyed<VertexId>> sorted_elements(const Executor& executor, const Mesh<Dim>& mesh,
                                             const std::vector<VertexId>& new_id) {
  std::vector<Keyed<VertexId>> order(mesh.element_slots());
  parallel_for(executor, order.size(), [&](std::size_t e) {
    const auto element = static_cast<ElementId>(e);
    VertexId lowest = none;
    if (mesh.alive(element))
      for (const VertexId v : mesh.corners_of[e]) lowest = std::min(lowest, new_id[v]);
    order[e] = {lowest, element};
  });
  runtime::parallel_sort(executor, std::span(order));
  while (!order.empty() && order.back().key == none) order.pop_back();
  return order;
}

/// values[i] becomes the old values[order[i].id].
template <class T, class Order>
void permute(const Executor& executor, std::vector<T>& values, const Order& order) {
  std::vector<T> moved(order.size());
  parallel_for(executor, order.size(), [&](std::size_t i) { moved[i] = values[order[i].id]; });
  values.swap(moved);
}

template <class Order>
void renumber_links(Mesh<3>& mesh, const Order& order, const std::vector<VertexId>& new_id) {
  ListPool<CurveLink> moved;
  moved.reset(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const CurveLink& link : mesh.links_of.of(order[i].id))
      moved.insert(static_cast<VertexId>(i), {new_id[link.to], link.curve});
  std::swap(mesh.links_of, moved);
}

}  // namespace

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh) {
  const auto vertices = sorted_vertices(executor, mesh);
  std::vector<VertexId> new_id(mesh.vertex_slots(), none);
  parallel_for(executor, vertices.size(),
               [&](std::size_t i) { new_id[vertices[i].id] = static_cast<VertexId>(i); });
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
  if constexpr (Dim == 3) renumber_links(mesh, vertices, new_id);
  rebuild_elements_of(executor, mesh);
}

template void renumber(const Executor&, Mesh<2>&);
template void renumber(const Executor&, Mesh<3>&);

}  // namespace ductile::meshadapt
