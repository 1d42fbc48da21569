/// @file
/// A user's program on Ductile::meshadapt: makes a mesh of one triangle in memory.

#include <cstdio>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

int main() {
  ductile::meshadapt::AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 0, 1};
  mesh.vertex_reference = {0, 0, 0};
  mesh.triangles.add({0, 1, 2}, 1);
  std::printf("meshadapt: %zu triangle\n", mesh.triangles.size());
  return mesh.triangles.size() == 1 ? 0 : 1;
}
