#include <string>
#include <vector>

#include "checks/faults.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "mesh/topology.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

std::vector<std::string> adapted_faults(const AdjacentMesh& before, const AdjacentMesh& after,
                                        double hausdorff_tolerance) {
  const Executor& executor = after.executor();
  auto faults = mesh_faults(after);
  if (faults.empty()) faults = domain_faults(before, after, hausdorff_tolerance);
  if (faults.empty()) faults = topology_faults(before, after);
  if (!faults.empty() || hausdorff_tolerance == 0) return faults;
  faults = check_boundary(executor, after.mesh());
  if (!faults.empty() && !check_boundary(executor, before.mesh()).empty()) faults.clear();
  return faults;
}

std::vector<std::string> check_topology(const Executor& executor, const AnyMesh& before,
                                        const AnyMesh& after) {
  expect_comparable(before, after);
  return topology_faults({executor, before}, {executor, after});
}

std::vector<std::string> check_adapted(const Executor& executor, const AnyMesh& before,
                                       const AnyMesh& after, double hausdorff_tolerance) {
  return adapted_faults({executor, before}, {executor, after}, hausdorff_tolerance);
}

}  // namespace ductile::meshadapt
