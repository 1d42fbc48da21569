/// @file
/// ReferenceSurface: the patches and curves of a Geometry, and which of them the facets and edges
/// of a mesh stand for.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "geometry/classify.hpp"
#include "geometry/surface.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// A sheet is the number of a patch or curve here.
template <int Dim>
struct ReferenceSurface {
  std::shared_ptr<const Surface<Dim>> surface;   ///< null if nothing is curved
  std::vector<std::uint8_t> is_smooth;           ///< [sheet of facets]
  std::vector<std::int32_t> reference_of;        ///< [sheet of facets]
  std::vector<std::int32_t> reference_of_curve;  ///< [sheet of edges], 3D
  bool in_parts = false;                         ///< as GeometryOptions::in_parts

  /// For each facet the sheet that is closest to its centre, of the same reference and turned by
  /// less than 60 degrees against it; where that one is curved and more than twice the tolerance
  /// away, the one that is not, however it is turned, because facets there are noise, or the one
  /// whose own facet is not. `none` if there is none near, or the facet is required and stays as it
  /// is. Throws InputError if a facet is more than twice the tolerance away from its curved sheet;
  /// and if no facet has a curved one, although there are some, the boundary may change and has not
  /// lost them, unless meshes are parts. Thread safety: one caller; runs on the executor.
  std::vector<std::uint32_t> sheets_of(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                       const std::vector<TaggedFacet<Dim>>& facets) const;

  /// The curved sheet of edges that an edge stands for, or `none`. Thread safety: any thread.
  std::uint32_t sheet_of_edge(const std::array<Vector<Dim>, 2>& ends, std::int32_t reference) const;
};

extern template struct ReferenceSurface<2>;
extern template struct ReferenceSurface<3>;

}  // namespace ductile::meshadapt
