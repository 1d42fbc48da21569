/// @file
/// The facets and edges of a new mesh to keep: listed ones, and unlisted ones between regions and
/// on the boundary.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// A mesh while it is made from one as it stands in a file.
template <int Dim>
struct MeshInMaking {
  const runtime::Executor& executor;
  const AnyMesh& any;
  const MakeMeshOptions& options;
  Neighbours<Dim>& neighbours;
  std::vector<std::string>& warnings;
  bool is_cut = false;  ///< from a larger mesh, where boundary facets are not listed
  Mesh<Dim> mesh = {};
};

/// The facets that are listed, each once, and all others that are on the boundary or between
/// regions. Throws InputError if one is no facet of an element, or if facets of the boundary are
/// not listed, unless options.complete_boundary is set or the mesh is cut. Precondition:
/// mesh.elements_of and neighbours are set. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<TaggedFacet<Dim>> tag_facets(MeshInMaking<Dim>& making);

/// The edges that are listed, each once; none in 2D. Those that belong to no element, as
/// construction lines do, are left out. Precondition and thread safety as above.
template <int Dim>
std::vector<ListedEdge> tag_edges(MeshInMaking<Dim>& making);

}  // namespace ductile::meshadapt
