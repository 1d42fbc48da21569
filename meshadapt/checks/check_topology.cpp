#include <string>
#include <vector>

#include "checks/faults.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "mesh/topology.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

template <int Dim>
std::vector<std::string> adapted_faults(const AdjacentMesh<Dim>& before,
                                        const AdjacentMesh<Dim>& after,
                                        double hausdorff_tolerance) {
  const Executor& executor = after.executor();
  auto faults = mesh_faults(after);
  if (faults.empty()) {
    expect_comparable(before.mesh(), after.mesh());
    faults = domain_faults(before, after, hausdorff_tolerance);
  }
  if (faults.empty()) faults = topology_faults(before, after);
  if (!faults.empty() || hausdorff_tolerance == 0) return faults;
  faults = check_boundary(executor, after.mesh());
  if (!faults.empty() && !check_boundary(executor, before.mesh()).empty()) faults.clear();
  return faults;
}

std::vector<std::string> check_topology(const Executor& executor, const AnyMesh& before,
                                        const AnyMesh& after) {
  expect_comparable(before, after);
  if (before.dimension == 2) return topology_faults<2>({executor, before}, {executor, after});
  return topology_faults<3>({executor, before}, {executor, after});
}

std::vector<std::string> check_adapted(const Executor& executor, const AnyMesh& before,
                                       const AnyMesh& after, double hausdorff_tolerance) {
  if (after.dimension == 2)
    return adapted_faults<2>({executor, before}, {executor, after}, hausdorff_tolerance);
  if (after.dimension == 3)
    return adapted_faults<3>({executor, before}, {executor, after}, hausdorff_tolerance);
  return check_mesh(executor, after);
}

template std::vector<std::string> adapted_faults(const AdjacentMesh<2>&, const AdjacentMesh<2>&,
                                                 double);
template std::vector<std::string> adapted_faults(const AdjacentMesh<3>&, const AdjacentMesh<3>&,
                                                 double);

}  // namespace ductile::meshadapt
