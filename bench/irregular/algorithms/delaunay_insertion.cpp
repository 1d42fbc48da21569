/// @file
/// The Delaunay triangulation of random points by insertion.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithms.hpp"
#include "delaunay_insertion.hpp"
#include "lean/delaunay_insertion.hpp"
#include "start_meshes.hpp"

namespace ductile::bench::irregular {

namespace {

using example::Triangulation;
using Points = std::vector<example::Point>;

/// Checks that all different points are vertices, and that the square is covered.
std::string fault(const Points& points, const Triangulation& mesh,
                  const Triangulation& /*serial*/) {
  if (delaunay_area(mesh) != 2 * std::int64_t{example::square_side} * example::square_side)
    return "gives no Delaunay triangulation";
  Points distinct = points;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return unless(mesh.points == points && mesh.corners_of.size() == 2 * distinct.size() - 6,
                "leaves points out");
}

}  // namespace

Algorithm delaunay_insertion() {
  return algorithm(Row<Points, Triangulation>{
      .name = "delaunay_insertion",
      .inputs = {"points"},
      .make_input = [](const std::string& /*input*/,
                       std::size_t size) { return example::random_points(size); },
      .serial = [](const Points& points,
                   Triangulation& mesh) { mesh = lean::delaunay_insertion(points); },
      .ductile =
          [](const runtime::Executor& executor, const Points& points, Triangulation& mesh) {
            mesh = example::delaunay_insertion_in_parallel(executor, points);
          },
      .fault = fault});
}

}  // namespace ductile::bench::irregular
