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
    for (const ElementId e : mesh.elements_of.of(vertex)) {
      entries.push_back({e, mesh.corners_of[e], mesh.shape_of[e], mesh.changed_at[e] > after});
      changed = changed || entries.back().changed;
    }
    if (!changed || entries.size() > Mesh<3>::largest_ball) return;
    for (std::size_t i = 0; i < entries.size(); ++i)
      for (const VertexId v : entries[i].corners)
        if (v > vertex) note(v, static_cast<std::uint16_t>(i));
  }

  Buffer<Entry, 64> entries;
  Buffer<Edge, 24> edges;
  bool changed = false;

 private:
  void note(VertexId to, std::uint16_t entry) {
    auto at = std::find_if(edges.begin(), edges.end(), [&](const Edge& e) { return e.to == to; });
    if (at == edges.end()) at = edges.insert(edges.end(), Edge{to});
    if (at->count < most_around) at->around[at->count] = entry;
    ++at->count;
  }
};

}  // namespace ductile::meshadapt
