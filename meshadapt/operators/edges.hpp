/// @file
/// collect_edges: goes over the edges of a mesh, or of a part of it, each once.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/runtime/collect.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// Does this triangle stand for its edge from p to q? Of the two that share it, the one where it
/// goes from the lower number to the higher; on the boundary there is but one.
inline bool stands_for(const Mesh<2>& mesh, ElementId element, int facet, VertexId p, VertexId q) {
  return p < q || (mesh.patches_of[element][static_cast<std::size_t>(facet)] != 0 &&
                   neighbour(mesh, element, facet) == none);
}

/// Calls find(a, b, append) for every edge a < b that has an end among the marked vertices, once;
/// append(item) adds to the result, whose order does not depend on threads.
/// Thread safety: one caller; runs on the executor.
template <class Item>
std::vector<Item> collect_edges(const runtime::Executor& executor, const Mesh<2>& mesh,
                                const std::vector<std::uint8_t>& marked, auto&& find) {
  return runtime::parallel_collect<Item>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        if (!mesh.alive(element)) return;
        for (int i = 0; i < 3; ++i) {
          const auto [p, q] = facet_of<2>(mesh.corners_of[e], i);
          if ((marked[p] || marked[q]) && stands_for(mesh, element, i, p, q))
            find(std::min(p, q), std::max(p, q), append);
        }
      });
}

/// In 3D an edge is in five elements or so: it is found from its vertices.
template <class Item>
std::vector<Item> collect_edges(const runtime::Executor& executor, const Mesh<3>& mesh,
                                const std::vector<std::uint8_t>& marked, auto&& find) {
  return runtime::parallel_collect<Item>(executor, mesh.vertex_slots(),
                                         [&](std::size_t v, auto&& append) {
                                           const auto a = static_cast<VertexId>(v);
                                           if (!marked[a]) return;
                                           Numbering seen;
                                           for (const ElementId element : mesh.elements_of.of(a))
                                             for (const VertexId b : mesh.corners_of[element])
                                               if (a < b || !marked[b]) seen.number_of(b);
                                           for (const VertexId b : seen.vertices())
                                             find(std::min(a, b), std::max(a, b), append);
                                         });
}

}  // namespace ductile::meshadapt
