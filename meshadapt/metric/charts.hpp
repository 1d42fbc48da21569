/// @file
/// Charts: plane coordinates around the vertices of a mesh, in which functions on it are fitted. In
/// the plane and in space they are the mesh's own. A surface has those of its tangent planes; it is
/// cut open along ridges and wherever not two triangles meet, so that each vertex there becomes
/// several nodes, which have a tangent plane each.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class Charts {
 public:
  /// Refers to the mesh.
  Charts(const runtime::Executor& /*executor*/, const FixedMesh<Dim>& mesh) : mesh_(mesh) {}

  /// The mesh of the nodes.
  const FixedMesh<Dim>& mesh() const { return mesh_; }
  /// The vertex that a node is a part of.
  VertexId vertex(VertexId node) const { return node; }
  /// Coordinates of a node in the chart of another.
  Vector<Dim> offset(VertexId from, VertexId to) const {
    return mesh_.position_of[to] - mesh_.position_of[from];
  }
  /// Metrics at vertices from those at nodes, and the other way round.
  std::vector<Metric<Dim>> lifted(const runtime::Executor& /*executor*/,
                                  std::vector<Metric<Dim>> at_nodes) const {
    return at_nodes;
  }
  const std::vector<Metric<Dim>>& restricted(const runtime::Executor& /*executor*/,
                                             const std::vector<Metric<Dim>>& at_vertices) const {
    return at_vertices;
  }

 private:
  const FixedMesh<Dim>& mesh_;
};

template <>
class Charts<2, 3> {
 public:
  /// Takes time that is nearly linear. Thread safety: one caller; runs on the executor.
  Charts(const runtime::Executor& executor, const FixedMesh<2, 3>& surface);

  const FixedMesh<2, 3>& mesh() const { return mesh_; }
  VertexId vertex(VertexId node) const { return vertex_of_[node]; }
  /// The direction of the projection to the tangent plane, and the distance in space, which is
  /// closer to that along the surface than the projection's.
  Vector<2> offset(VertexId from, VertexId to) const;

  /// Across the surface sizes are the longer of those along it. The finest of the nodes of a vertex
  /// count.
  std::vector<Metric<3>> lifted(const runtime::Executor& executor,
                                const std::vector<Metric<2>>& at_nodes) const;
  std::vector<Metric<2>> restricted(const runtime::Executor& executor,
                                    const std::vector<Metric<3>>& at_vertices) const;

 private:
  /// Unit vectors at right angles to each other; the last is the normal, to either side.
  using Frame = std::array<Vector<3>, 3>;

  std::vector<VertexId> first_node_;  // [vertex], and one past the last
  std::vector<VertexId> vertex_of_;   // [node]
  std::vector<Frame> frame_of_;       // [node]
  FixedMesh<2, 3> mesh_;
};

/// recover_hessian() by least squares in the charts of the nodes. Thread safety: one caller; runs
/// on the executor.
template <int Dim, int Space>
std::vector<Metric<Dim>> fitted_hessian(const runtime::Executor& executor,
                                        const Charts<Dim, Space>& charts,
                                        std::span<const double> value_of);

}  // namespace ductile::meshadapt
