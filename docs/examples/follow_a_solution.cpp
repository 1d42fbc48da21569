/// @file
/// A simulation loop with Ductile, without the simulation: in each step a solution is advanced on
/// the mesh, the mesh is adapted to it, and the solution is transferred to the new mesh.
///   follow_a_solution MESH OUTPUT.vtu

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace meshadapt = ductile::meshadapt;

namespace {

/// A front that moves to the right: here one would solve equations.
meshadapt::AnyField solution_at(double time, const meshadapt::AnyMesh& mesh) {
  std::vector<double> value_of;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto p = meshadapt::position_in<2>(mesh, v);
    value_of.push_back(0.5 + 0.5 * std::tanh(40 * (p[0] - time - 0.1 * std::sin(9 * p[1]))));
  }
  return meshadapt::scalar_field(2, value_of, "u");
}

double amount(const ductile::runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
              const meshadapt::AnyField& field) {
  return meshadapt::integral<2>(executor, meshadapt::make_fixed_mesh<2>(executor, mesh),
                                field.values);
}

}  // namespace

int main(int argument_count, char** argument) {
  if (argument_count != 3) return 2;
  try {
    const ductile::runtime::Executor executor;
    meshadapt::AnyMesh mesh = meshadapt::read_mesh(argument[1]);
    meshadapt::AnyField solution;
    const meshadapt::SolutionMetricOptions options{
        .goal = {.complexity = meshadapt::complexity_of_elements(2, 4000),
                 .bounds = {.smallest = 1e-3}},
        .gradation = 1.5};
    for (int step = 0; step < 4; ++step) {
      solution = solution_at(0.3 + 0.1 * step, mesh);
      const auto wanted = meshadapt::solution_metric(executor, mesh, solution, options);
      auto adapted = meshadapt::adapt(executor, mesh, wanted.metric).mesh;
      const auto carried = meshadapt::project_field(executor, {mesh, solution}, adapted).field;
      std::printf("step %d: %zu triangles, error about %.1e, amount %.15f, carried %.15f\n", step,
                  adapted.triangles.size(), wanted.fit.error, amount(executor, mesh, solution),
                  amount(executor, adapted, carried));
      mesh = std::move(adapted);
      solution = carried;
    }
    meshadapt::write_mesh(argument[2], mesh, {.fields = meshadapt::named_fields(solution, "u")});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
