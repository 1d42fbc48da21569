/// @file
/// Bends: the normals of the smooth patches of a mesh at their vertices, so that it can be told
/// from what is around a point how they bend there, and how wide the flat parts are that they are
/// made of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// A vertex as a part of one smooth patch.
template <int Dim>
struct BendNode {
  VertexId vertex = none;
  PatchId patch = 0;
  double width = 0;  ///< of the widest flat part beside it
  /// That of the model where the vertex is on it and the facets around agree, otherwise theirs; of
  /// unit length, may be to either side.
  Vector<Dim> normal;
  double area = 0;  ///< of the part of the patch that is closest to the vertex; length in 2D
};

/// All nodes, and those next to each.
template <int Dim>
struct Bends {
  std::vector<BendNode<Dim>> nodes;
  runtime::CsrRows next;  ///< [node], each neighbour once or more

  /// Facets within a distance of `flat` of one plane form a flat part. Nearly linear in the
  /// mesh. Thread safety: one caller; runs on the executor.
  Bends(const runtime::Executor& executor, const Mesh<Dim>& mesh, double flat);
};

extern template struct Bends<2>;
extern template struct Bends<3>;

}  // namespace ductile::meshadapt
