/// @file
/// Makes a mesh from plain arrays, adapts it, and returns plain arrays, as a simulation or a
/// language binding does. No file is read or written.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace meshadapt = ductile::meshadapt;

int main() {
  try {
    const ductile::runtime::Executor executor;
    // ---- In: two triangles, and one edge of the boundary that has a reference ----
    const std::vector<double> points{0, 0, 1, 0, 1, 1, 0, 1};
    const std::vector<std::int64_t> triangles{0, 1, 2, 0, 2, 3}, inflow{3, 0};
    const std::vector<std::int32_t> inflow_reference{7};
    const meshadapt::AnyMesh mesh =
        meshadapt::mesh_from_arrays<std::int64_t>(executor, {.dimension = 2,
                                                             .coordinates = points,
                                                             .elements = triangles,
                                                             .facets = inflow,
                                                             .facet_reference = inflow_reference});
    // ---- A size for each vertex ----
    const std::vector<double> size_of{0.02, 0.1, 0.1, 0.02};
    const meshadapt::AnyField metric =
        meshadapt::metric_of(meshadapt::scalar_field(2, size_of), mesh);
    const meshadapt::AdaptedMesh adapted = meshadapt::adapt(executor, mesh, metric);
    // ---- Out: arrays; for example the first corner of the first triangle ----
    const meshadapt::AnyMesh& out = adapted.mesh;
    const double* const point = &out.coordinates[2 * out.triangles.vertices[0][0]];
    std::printf("%zu vertices, %zu triangles, %zu boundary edges; a corner at (%g, %g)\n",
                out.vertex_count(), out.triangles.size(), out.edges.size(), point[0], point[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
