/// @file
/// DualMesh: a triangle mesh for vertex-centred finite volumes. Each vertex owns a cell; cells of
/// neighbouring vertices meet in faces that run from the midpoint of the edge between them to the
/// centres of its triangles (median dual). Fluxes live on edges, directed from the first to the
/// second vertex.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"

namespace ductile::paper {

using meshadapt::AnyMesh;
using meshadapt::VertexId;
using EdgeId = std::uint32_t;

struct Edge {
  VertexId from, to;
};

struct DualMesh {
  meshadapt::FixedMesh<2> mesh;
  std::vector<Edge> edges;
  std::vector<std::array<EdgeId, 3>> edges_of;  // [element][i], from its corner i to the next
  std::vector<double> stiffness_of;  // [edge], - integral of grad N_from . grad N_to; no unit
  std::vector<double> inflow_of;     // [vertex], length of the left side that is its own
  std::vector<VertexId> outlet;      // the vertices on the right side

  std::size_t vertex_count() const { return mesh.vertex_count(); }
  std::span<const EdgeId> edges_at(VertexId vertex) const {
    return {around.data() + first_around[vertex], around.data() + first_around[vertex + 1]};
  }

  // ---- For edges_at ----
  std::vector<std::uint32_t> first_around;  // [vertex], and the end
  std::vector<EdgeId> around;
};

/// Expects the sides of meshadapt::box_mesh<2>().
DualMesh make_dual_mesh(const runtime::Executor& executor, const AnyMesh& mesh);

/// 1 if a positive flux along the edge leaves the vertex, -1 if it enters.
inline double outflow_sign(const Edge& edge, VertexId vertex) {
  return edge.from == vertex ? 1.0 : -1.0;
}

}  // namespace ductile::paper
