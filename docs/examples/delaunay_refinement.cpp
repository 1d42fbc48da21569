/// @file
/// The refinement of delaunay_refinement.hpp on a plate with square holes, compared with one
/// insertion after the other and between thread counts.

#include <cmath>
#include <cstdio>

#include "delaunay_refinement.hpp"
#include "example.hpp"
#include "lean/delaunay_refinement.hpp"
#include "plane.hpp"
#include "start_meshes.hpp"

namespace {

using namespace example;

/// Checks that the result covers the plate, is Delaunay, and has no bad triangle.
bool is_refined(const Triangulation& mesh, const RefineTriangles& refine) {
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    if (refine.is_bad(t)) return false;
  return delaunay_area(mesh) == 2 * plate_area;
}

void compare(const Arguments& arguments) {
  const Triangulation start = plate();
  // This size gives about as many triangles as asked for, by measurement.
  const double size = plate_cells * cell_side / std::sqrt(static_cast<double>(arguments.size));
  std::printf("Delaunay refinement of %zu triangles\n", start.corners_of.size());
  Triangulation mesh = solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        Triangulation refined = start;
        delaunay_refinement_in_parallel(executor, refined, size, &report);
        return refined;
      });
  Triangulation serial = start;
  print_yardstick("serial: one insertion after the other",
                  seconds_of([&] { lean::delaunay_refinement(serial, size); }));
  std::printf("triangles: %zu, serial %zu\n", mesh.corners_of.size(), serial.corners_of.size());
  require(is_refined(serial, RefineTriangles(serial, size)),
          "the serial mesh is not as it should be");
  require(is_refined(mesh, RefineTriangles(mesh, size)), "the mesh is not as it should be");
}

}  // namespace

int main(int argument_count, char** argument) {
  return run(argument_count, argument, 100000, compare);
}
