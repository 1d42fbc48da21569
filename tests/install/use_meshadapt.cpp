/// @file
/// A user's program on Ductile::meshadapt: adapts a square of two triangles to edges of length 0.1.

#include <cstdio>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"

int main() {
  namespace meshadapt = ductile::meshadapt;
  meshadapt::AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh.vertex_reference = {0, 0, 0, 0};
  mesh.triangles.add({0, 1, 2}, 1);
  mesh.triangles.add({0, 2, 3}, 1);
  for (unsigned i = 0; i < 4; ++i) mesh.edges.add({i, (i + 1) % 4}, 1);
  const ductile::runtime::Executor executor({.threads = 2});
  const auto adapted = meshadapt::adapt(executor, mesh, meshadapt::constant_metric(mesh, 0.1));
  std::printf("meshadapt: %zu triangles\n", adapted.mesh.triangles.size());
  return adapted.mesh.triangles.size() > 100 ? 0 : 1;
}
