#include "ductile/meshadapt/move.hpp"

#include <chrono>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "mesh/array_lengths.hpp"
#include "move/mover.hpp"

namespace ductile::meshadapt {
namespace {

void expect_options(const MoveOptions& options) {
  for (const double quality : {options.remesh_below, options.keep_above})
    if (!(quality >= 0 && quality < 1))
      throw InputError("moving: expected qualities from 0 to 1, found " + number(quality));
  if (options.most_steps < 1)
    throw InputError("moving: expected 1 step or more, found " +
                     std::to_string(options.most_steps));
}

/// Compares the moved mesh with the input where its vertices were there.
template <int Dim>
MovedMesh moved(const runtime::Executor& executor, const AnyMesh& mesh,
                const AnyField& displacement, const MoveOptions& options) {
  AnyMesh listed = mesh;
  list_boundary(executor, listed);
  Mover<Dim> mover(executor, std::move(listed), displacement, options);
  MovedMesh result = mover.run();
  std::vector<double> coordinates = mover.starts();
  result.mesh.coordinates.swap(coordinates);
  result.origins = origins(executor, mesh, result.mesh);
  result.mesh.coordinates.swap(coordinates);
  return result;
}

}  // namespace

MovedMesh move(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& displacement,
               const MoveOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  expect_options(options);
  expect_coordinates(mesh);
  MovedMesh result;
  runtime::with_team(executor, [&] {
    auto warnings =
        expect_adaptable(executor, mesh, {.complete_boundary = options.complete_boundary});
    result = mesh.dimension == 2 ? moved<2>(executor, mesh, displacement, options)
                                 : moved<3>(executor, mesh, displacement, options);
    result.report.warnings.insert(result.report.warnings.begin(), warnings.begin(), warnings.end());
  });
  result.report.total_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace ductile::meshadapt
