/// @file
/// Bends: how the smooth patches of a mesh bend, vertex by vertex, so that it can be added up over
/// what is around a point, and how wide the flat parts are that they are made of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A vertex as a part of one smooth patch.
template <int Dim>
struct BendNode {
  VertexId vertex = none;
  PatchId patch = 0;
  /// The patch, or its smooth part, ends here. What bends across the rim is seen only by half.
  bool at_rim = false;
  double width = 0;    ///< of the widest flat part beside it
  Vector<Dim> normal;  ///< of unit length; may be to either side
  /// By how much the part of the patch that is closest to the vertex turns, in which directions,
  /// times its width in 3D; positive if towards the normal. Over the part's area, or length in 2D,
  /// that is its curvature. Both add up: where a thin facet makes a patch turn to and fro, it
  /// cancels.
  Metric<Dim> turn;
  double area = 0;
};

/// All nodes, and those next to each. Bends of facets are the turns from one to the next
/// (Cohen-Steiner & Morvan, "Restricted Delaunay triangulations and normal cycle", SoCG 2003).
template <int Dim>
struct Bends {
  std::vector<BendNode<Dim>> nodes;
  runtime::CsrRows next;  ///< [node], each neighbour once or more

  /// What is within a distance of `flat` of one plane is a flat part. Nearly linear in the
  /// mesh. Thread safety: one caller; runs on the executor.
  Bends(const runtime::Executor& executor, const Mesh<Dim>& mesh, double flat);
};

extern template struct Bends<2>;
extern template struct Bends<3>;

}  // namespace ductile::meshadapt
