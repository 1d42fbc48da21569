/// @file
/// VertexNeighbours: the vertices that an edge leads to, for iterations over the edges of a mesh of
/// either kind in which what has changed wakes what is next to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
auto elements_around(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  return mesh.elements_of.of(vertex);
}
template <int Dim, int Space>
auto elements_around(const FixedMesh<Dim, Space>& mesh, VertexId vertex) {
  return mesh.elements_of(vertex);
}

template <class AMesh>
class VertexNeighbours {
 public:
  VertexNeighbours(const runtime::Executor& executor, const AMesh& mesh)
      : executor_(executor), mesh_(mesh), found_(executor), wake_(executor) {}

  /// In the order of their numbers; valid until the thread asks again. Thread safety: threads of
  /// the executor.
  std::span<const VertexId> of(VertexId vertex) {
    if (!first_kept_.empty())
      return {kept_.data() + first_kept_[vertex], kept_.data() + first_kept_[vertex + 1]};
    std::vector<VertexId>& found = found_.mine();
    found.clear();
    for (const ElementId element : elements_around(mesh_, vertex))
      for (const VertexId corner : mesh_.corners_of[element])
        if (corner != vertex) found.push_back(corner);
    std::sort(found.begin(), found.end());
    return {found.begin(), std::unique(found.begin(), found.end())};
  }

  /// Keeps the neighbours of all vertices, for whoever asks for them again and again.
  /// Thread safety: one caller; runs on the executor.
  void keep(std::size_t vertices) {
    std::vector<std::size_t> count_of(vertices + 1, 0);
    kept_ =
        runtime::parallel_collect<VertexId>(executor_, vertices, [&](std::size_t v, auto&& append) {
          const auto found = of(static_cast<VertexId>(v));
          count_of[v] = found.size();
          for (const VertexId neighbour : found) append(neighbour);
        });
    runtime::exclusive_scan(executor_, std::span(count_of));
    first_kept_ = std::move(count_of);
  }

  /// Those of any of these, each once. Thread safety: one caller; runs on the executor.
  runtime::UnsetVector<VertexId> of_all(std::span<const VertexId> vertices) {
    const auto wake_around = [&](std::size_t i, auto& wake) {
      for (const VertexId neighbour : of(vertices[i])) wake.append(neighbour);
    };
    runtime::parallel_for(executor_, vertices.size(), runtime::with(wake_), wake_around,
                          {.serial_below = 256});
    wake_.collect_unique();
    return wake_.take();
  }

 private:
  const runtime::Executor& executor_;
  const AMesh& mesh_;
  runtime::PerThread<std::vector<VertexId>> found_;
  runtime::Worklist<VertexId> wake_;
  std::vector<std::size_t> first_kept_;  // [vertex], and the end; empty if none are kept
  runtime::UnsetVector<VertexId> kept_;
};

}  // namespace ductile::meshadapt
