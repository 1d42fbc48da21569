/// @file
/// Classification of a new mesh's boundary: which facets form one patch, which edges one
/// curve, and what every vertex may therefore do.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// A boundary or interface facet before it belongs to a patch.
template <int Dim>
struct TaggedFacet {
  Facet<Dim> corners{};
  Patch<Dim> data;                         ///< normal not yet set
  ElementId element = none, other = none;  ///< on its sides; other is none on the boundary
  int facet = 0, other_facet = 0;          ///< its number in them
  PatchId patch = 0;
};

/// An edge listed in a 3D file.
struct ListedEdge {
  VertexId a = none, b = none;
  std::int32_t reference = 0;
  bool required = false, ridge = false;
};

/// An edge of a curve, in 3D.
struct CurveEdge {
  VertexId a, b;
  Curve data;
  std::vector<PatchId> patches;  ///< that meet there, sorted
  CurveId curve = 0;
  bool bends = false;          ///< more than rounding makes it
  std::uint32_t sheet = none;  ///< the curve of the reference that it stands for
  bool agrees_with(const CurveEdge& o) const {
    return std::tie(data.reference, data.listed, data.required, data.ridge, patches, sheet) ==
           std::tie(o.data.reference, o.data.listed, o.data.required, o.data.ridge, o.patches,
                    o.sheet);
  }
};

/// Sets mesh.patches, curves, links_of, patches_of, kind_of.class_dimension and entity_of from the
/// facets (and, in 3D, the listed edges). kind_of.corner and .required and the regions are already
/// set. With options.hausdorff_tolerance patches and curves may be smooth; mesh.surface is set if
/// one is. Thread safety: one caller; runs on the executor.
template <int Dim>
void classify(const runtime::Executor& executor, Mesh<Dim>& mesh,
              std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
              const MakeMeshOptions& options);

}  // namespace ductile::meshadapt
