/// @file
/// origins: what an adapted mesh still has of the mesh that it was made from, and where the rest of
/// its vertices lies in that. To copy what belongs to vertices or elements that are as they were,
/// such as unknowns, boundary data or history, and to evaluate any kind of field at the others.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Indices into the arrays of the mesh that was adapted, or `none`.
struct Origins {
  /// [vertex] The vertex that is at exactly the same place. One that has moved is a new one. Of
  /// several at one place, as on both sides of a closed crack, the one on the same side.
  std::vector<VertexId> vertex;
  /// [facet] The listed facet, of edges in 2D, of triangles in 3D, that has the same vertices. All
  /// required facets have one.
  std::vector<std::uint32_t> facet;
  /// [element] The element that has the same vertices and the same reference.
  std::vector<ElementId> element;
  /// [vertex] The element in which it lies; of one outside, as on a curved boundary that has moved,
  /// the closest. Never none.
  std::vector<ElementId> host;
  /// [vertex * (dimension + 1) + corner] Its barycentric weights in there, of the corners in their
  /// order in the arrays: none below 0, and they add up to 1. Outside, those of the closest point.
  std::vector<double> weight;

  friend bool operator==(const Origins&, const Origins&) = default;
};

/// Where `after`, which adapt() made of `before`, comes from. It is found by looking at both
/// meshes, which takes one or two percent of the time of the adaptation. Does not depend on
/// threads. Throws InputError unless both are meshes of one dimension, the first with elements that
/// have a volume (see make_fixed_mesh()), with coordinates from -1e150 to 1e150. Thread safety: one
/// caller; runs on the executor.
Origins origins(const runtime::Executor& executor, const AnyMesh& before, const AnyMesh& after);

}  // namespace ductile::meshadapt
