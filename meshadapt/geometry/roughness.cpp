#include "geometry/roughness.hpp"

#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/rounding.hpp"

namespace ductile::meshadapt {

template <int Dim>
double roughness(const AnyMesh& mesh) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  try {
    const auto made = make_mesh<Dim>(runtime::Executor({.threads = 1}), mesh,
                                     {.complete_boundary = true}, neighbours, warnings);
    return made.rounding ? made.rounding->tolerance : 0;
  } catch (const InputError&) {
    return 0;
  }
}

template double roughness<2>(const AnyMesh&);
template double roughness<3>(const AnyMesh&);

}  // namespace ductile::meshadapt
