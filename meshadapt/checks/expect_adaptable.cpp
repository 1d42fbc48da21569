#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/surface_mesh.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
std::vector<std::string> expect_adaptable_in(const runtime::Executor& executor, const AnyMesh& mesh,
                                             const MakeMeshOptions& options) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  make_mesh<Dim>(executor, mesh, options, neighbours, warnings);
  return warnings;
}

}  // namespace

std::vector<std::string> expect_adaptable(const runtime::Executor& executor, const AnyMesh& mesh,
                                          const MakeMeshOptions& options) {
  if (is_surface(mesh)) {
    Neighbours<2> neighbours;
    std::vector<std::string> warnings;
    make_surface_mesh(executor, mesh, options, neighbours, warnings);
    return warnings;
  }
  return mesh.dimension == 2 ? expect_adaptable_in<2>(executor, mesh, options)
                             : expect_adaptable_in<3>(executor, mesh, options);
}

}  // namespace ductile::meshadapt
