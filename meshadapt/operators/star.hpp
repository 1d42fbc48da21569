/// @file
/// Star: what 3D swapping reads around one vertex.
#pragma once

#include <algorithm>
#include <array>

#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// The elements around a vertex, and which of them are around each of its edges to neighbours with
/// a higher number, read once for all swaps that are looked for from here.
class Star {
 public:
  static constexpr std::size_t most_around = 16;  // an edge in more elements is left alone

  struct Entry {
    ElementId element;
    Corners<3> corners;
    float shape;
    bool changed;
  };
  struct Edge {
    VertexId to;
    std::uint32_t count = 0;
    std::array<std::uint16_t, most_around> around{};
  };

  Star(const Mesh<3>& mesh, VertexId vertex, std::uint32_t after) {
    const auto ball = mesh.elements_of.of(vertex);
    if (ball.size() > Mesh<3>::largest_ball) return;
    Numbering numbers;
    for (const ElementId e : ball) {
      entries.push_back({e, mesh.corners_of[e], mesh.shape_of[e], mesh.changed_at[e] > after});
      for (const VertexId v : entries.back().corners)
        if (v > vertex) note(numbers, v);
    }
  }

  Buffer<Entry, 64> entries;
  Buffer<Edge, 24> edges;

 private:
  void note(Numbering& numbers, VertexId to) {
    const std::size_t at = numbers.number_of(to);
    if (at == edges.size()) edges.push_back({to});
    Edge& edge = edges[at];
    if (edge.count < most_around)
      edge.around[edge.count] = static_cast<std::uint16_t>(entries.size() - 1);
    ++edge.count;
  }
};

}  // namespace ductile::meshadapt
