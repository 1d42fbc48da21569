/// @file
/// Surfaces alone: from triangles in space as they stand in a file to a Mesh<2, 3>. Its patches,
/// curves and smooth model are those of a boundary of tetrahedra: they are found on a Mesh<3> whose
/// elements have a triangle on the boundary and no fourth corner.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The surface without triangles that have no area or are there already, and with neighbours that
/// are turned alike, as most are; nothing if it is so. What was done is told in warnings. Vertices
/// keep their numbers. Throws InputError as make_surface_mesh() does. Thread safety: one caller;
/// runs on the executor.
std::optional<AnyMesh> mended_surface(const runtime::Executor& executor, const AnyMesh& any,
                                      const MakeMeshOptions& options,
                                      std::vector<std::string>& warnings);

/// As make_mesh(), from the mended surface. Edges of one triangle, or of more than two, are curves;
/// they have no neighbours. Thread safety: as above.
Mesh<2, 3> make_surface_mesh(const runtime::Executor& executor, const AnyMesh& any,
                             const MakeMeshOptions& options, Neighbours<2>& neighbours,
                             std::vector<std::string>& warnings);

/// bound_curved_sizes() of a surface. Thread safety: as above.
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<2, 3>& mesh, double tolerance,
                        std::vector<Metric<3>>& metric_of);

}  // namespace ductile::meshadapt
