/// @file
/// A Delaunay triangulation by edge flips.
#include <cstdint>
#include <string>

#include "algorithms.hpp"
#include "delaunay_flips.hpp"
#include "lean/delaunay_flips.hpp"
#include "start_meshes.hpp"

namespace ductile::bench::irregular {

namespace {

using example::Triangulation;

std::string fault(const Triangulation& start, const Triangulation& mesh,
                  const Triangulation& /*serial*/) {
  return unless(
      delaunay_area(mesh) == 2 * std::int64_t{example::square_side} * example::square_side &&
          mesh.corners_of.size() == start.corners_of.size(),
      "gives no Delaunay triangulation");
}

}  // namespace

Algorithm delaunay_flips() {
  return algorithm(Row<Triangulation, Triangulation>{
      .name = "delaunay_flips",
      .inputs = {"rows"},
      .make_input = [](const std::string& /*input*/,
                       std::size_t size) { return example::rows_of_points(size); },
      .begin = [](const Triangulation& start) { return start; },
      .serial = [](const Triangulation& /*start*/,
                   Triangulation& mesh) { lean::delaunay_flips(mesh); },
      .ductile = [](const runtime::Executor& executor, const Triangulation& /*start*/,
                    Triangulation& mesh) { example::delaunay_flips_in_parallel(executor, mesh); },
      .fault = fault});
}

}  // namespace ductile::bench::irregular
