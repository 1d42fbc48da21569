/// @file
/// The Delaunay triangulation of random points by the flips of delaunay_flips.hpp, compared with
/// flips one by one and between thread counts.

#include <cstdio>

#include "delaunay_flips.hpp"
#include "example.hpp"
#include "lean/delaunay_flips.hpp"
#include "plane.hpp"
#include "start_meshes.hpp"

namespace {

using namespace example;

void compare(const Arguments& arguments) {
  const Triangulation start = rows_of_points(arguments.size);
  std::printf("The Delaunay triangulation of %zu points by flips of edges\n", start.points.size());
  const Triangulation mesh = solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        Triangulation flipped = start;
        delaunay_flips_in_parallel(executor, flipped, &report);
        return flipped;
      });
  Triangulation serial = start;
  const double seconds = seconds_of([&] { lean::delaunay_flips(serial); });
  print_yardstick("serial: one flip after the other", seconds);
  require(delaunay_area(mesh) == 2 * std::int64_t{square_side} * square_side, "not Delaunay");
  require(sorted_corners(mesh) == sorted_corners(serial), "the serial triangles are others");
}

}  // namespace

int main(int argument_count, char** argument) {
  return run(argument_count, argument, 100000, compare);
}
