#include "geometry/roughness.hpp"

#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/rounding.hpp"
#include "geometry/surface_mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
double roughness(const AnyMesh& mesh) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const runtime::Executor executor({.threads = 1});
  const auto roughness_of = [](const auto& made) {
    return made.rounding ? made.rounding->tolerance : 0;
  };
  try {
    if (is_surface(mesh)) {
      Neighbours<2> of_triangles;
      return roughness_of(make_surface_mesh(executor, mesh, {}, of_triangles, warnings));
    }
    const auto made =
        make_mesh<Dim>(executor, mesh, {.complete_boundary = true}, neighbours, warnings);
    return roughness_of(made);
  } catch (const InputError&) {
    return 0;
  }
}

template double roughness<2>(const AnyMesh&);
template double roughness<3>(const AnyMesh&);

}  // namespace ductile::meshadapt
