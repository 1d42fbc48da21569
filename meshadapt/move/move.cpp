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

}  // namespace

MovedMesh move(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& displacement,
               const MoveOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  expect_options(options);
  expect_coordinates(mesh);
  MovedMesh moved;
  runtime::with_team(executor, [&] {
    auto warnings =
        expect_adaptable(executor, mesh, {.complete_boundary = options.complete_boundary});
    AnyMesh listed = mesh;
    list_boundary(executor, listed);
    moved = mesh.dimension == 2
                ? Mover<2>(executor, std::move(listed), displacement, options).run()
                : Mover<3>(executor, std::move(listed), displacement, options).run();
    moved.report.warnings.insert(moved.report.warnings.begin(), warnings.begin(), warnings.end());
  });
  moved.report.total_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return moved;
}

}  // namespace ductile::meshadapt
