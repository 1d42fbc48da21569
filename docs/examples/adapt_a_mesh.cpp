/// @file
/// Reads a mesh and a metric, adapts, and writes the result:
///   adapt_a_mesh MESH METRIC OUTPUT

#include <cstdio>
#include <exception>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace meshadapt = ductile::meshadapt;

int main(int argument_count, char** argument) {
  if (argument_count != 4) return 2;
  try {
    const ductile::runtime::Executor executor;  // as many threads as there are cores
    const meshadapt::AnyMesh mesh = meshadapt::read_mesh(argument[1]);
    const meshadapt::AnyField metric =
        meshadapt::metric_of(meshadapt::read_field(argument[2]), mesh);
    const meshadapt::AdaptedMesh adapted = meshadapt::adapt(executor, mesh, metric);
    meshadapt::write_mesh(argument[3], adapted.mesh);
    std::printf("%zu triangles became %zu in %.2f s\n", mesh.triangles.size(),
                adapted.mesh.triangles.size(), adapted.report.total_seconds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
