/// @file
/// The Delaunay triangulation of random points by the insertions of delaunay_insertion.hpp,
/// compared with one after the other and between thread counts.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "delaunay_insertion.hpp"
#include "example.hpp"
#include "lean/delaunay_insertion.hpp"
#include "plane.hpp"
#include "start_meshes.hpp"

namespace {

using namespace example;

void compare(const Arguments& arguments) {
  const std::vector<Point> points = random_points(arguments.size);
  std::printf("The Delaunay triangulation of %zu points by insertion\n", points.size());
  const Triangulation mesh = solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        return delaunay_insertion_in_parallel(executor, points, &report);
      });
  Triangulation serial;
  print_yardstick("serial: one insertion after the other",
                  seconds_of([&] { serial = lean::delaunay_insertion(points); }));
  require(delaunay_area(mesh) == 2 * std::int64_t{square_side} * square_side, "not Delaunay");
  require(sorted_corners(mesh) == sorted_corners(serial), "the serial triangles are others");
}

}  // namespace

int main(int argument_count, char** argument) {
  return run(argument_count, argument, 100000, compare);
}
