/// @file
/// Delaunay refinement: of a plate to a size, and of random points for the angles alone.
#include <cmath>
#include <cstdint>
#include <string>

#include "algorithms.hpp"
#include "delaunay_refinement.hpp"
#include "lean/delaunay_flips.hpp"
#include "lean/delaunay_refinement.hpp"
#include "start_meshes.hpp"

namespace ductile::bench::irregular {

namespace {

using example::Triangulation;

struct Start {
  Triangulation mesh;
  double size;  // the largest radius of a triangle's circle
};

/// The plate, with a size that gives about `size` triangles, by measurement; or half as many random
/// points, which give as many triangles at the start.
Start make_start(const std::string& input, std::size_t size) {
  if (input == "plate")
    return {example::plate(),
            example::plate_cells * example::cell_side / std::sqrt(static_cast<double>(size))};
  Start start{example::rows_of_points(size / 2), 1e12};
  lean::delaunay_flips(start.mesh);
  return start;
}

std::string fault(const Start& start, const Triangulation& mesh, const Triangulation& /*serial*/) {
  Triangulation copy = mesh;
  const lean::DelaunayRefinement refinement(copy, start.size);
  for (example::TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    if (refinement.is_bad(t)) return "leaves bad triangles";
  const std::int64_t area = delaunay_area(mesh);
  return unless(area >= 0 && area == delaunay_area(start.mesh), "gives no Delaunay triangulation");
}

}  // namespace

Algorithm delaunay_refinement() {
  return algorithm(Row<Start, Triangulation>{
      .name = "delaunay_refinement",
      .inputs = {"plate", "points"},
      .make_input = make_start,
      .begin = [](const Start& start) { return start.mesh; },
      .serial = [](const Start& start,
                   Triangulation& mesh) { lean::delaunay_refinement(mesh, start.size); },
      .ductile =
          [](const runtime::Executor& executor, const Start& start, Triangulation& mesh) {
            example::delaunay_refinement_in_parallel(executor, mesh, start.size);
          },
      .fault = fault});
}

}  // namespace ductile::bench::irregular
