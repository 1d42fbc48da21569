/// @file
/// The Delaunay triangulation of random points by edge flips: from any triangulation, an edge is
/// replaced by the other diagonal of its two triangles if the circle through one holds the far
/// corner of the other (Lawson, 1977). Many edges flip at once; a flip reserves its two triangles
/// and the two whose neighbours change. Compared with the same flips one by one.

#include <array>
#include <cstdio>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "example.hpp"
#include "plane.hpp"
#include "start_meshes.hpp"

namespace {

using namespace example;

class FlipEdges {
 public:
  // ---- What it works on: 3 t + i is the edge of triangle t opposite to its corner i ----
  using Item = std::uint32_t;
  struct Plan {
    TriangleId one, two;    // beside the edge
    std::size_t far, near;  // the corners opposite to it: their places in one and in two
  };
  struct Update {
    TriangleId before, now;
  };

  explicit FlipEdges(Triangulation& mesh) : mesh_(mesh) {}

  // ---- Plan: flip if the far corner is inside the circle. Reads only. ----
  std::optional<Plan> plan(Item edge) const {
    const TriangleId one = edge / 3, two = mesh_.neighbours_of[one][edge % 3];
    if (two == outside) return {};
    const std::size_t near = place_of(one, mesh_.neighbours_of[two]);
    if (!in_circle(mesh_.corner(one, 0), mesh_.corner(one, 1), mesh_.corner(one, 2),
                   mesh_.corner(two, near)))
      return {};
    return Plan{one, two, edge % 3, near};
  }
  // ---- Conflict rule: both triangles change, and what two of their neighbours know of them ----
  void footprint(Item edge, auto&& visit) const {
    const std::optional<Plan> flip = plan(edge);
    if (!flip) return;
    visit(flip->one);
    visit(flip->two);
    for (const TriangleId other : {left_of_two(*flip), left_of_one(*flip)})
      if (other != outside) visit(other);
  }
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  // ---- Apply: turn the diagonal; tell two neighbours; look at the four edges around again ----
  void apply(const Plan& flip, auto& commit) {
    auto& corners_one = mesh_.corners_of[flip.one];
    auto& corners_two = mesh_.corners_of[flip.two];
    auto& beside_one = mesh_.neighbours_of[flip.one];
    auto& beside_two = mesh_.neighbours_of[flip.two];
    const std::size_t f = flip.far, n = flip.near;
    if (left_of_two(flip) != outside) commit.defer(left_of_two(flip), {flip.two, flip.one});
    if (left_of_one(flip) != outside) commit.defer(left_of_one(flip), {flip.one, flip.two});
    corners_one[(f + 2) % 3] = corners_two[n];
    corners_two[(n + 2) % 3] = corners_one[f];
    beside_one[f] = beside_two[(n + 1) % 3];
    beside_two[n] = beside_one[(f + 1) % 3];
    beside_one[(f + 1) % 3] = flip.two;
    beside_two[(n + 1) % 3] = flip.one;
    for (const std::size_t place : {f, (f + 2) % 3})
      commit.wake(3 * flip.one + static_cast<Item>(place));
    for (const std::size_t place : {n, (n + 2) % 3})
      commit.wake(3 * flip.two + static_cast<Item>(place));
  }
  // ---- Commit: a triangle has another neighbour ----
  void commit(TriangleId owner, const Update& update) {
    auto& neighbours = mesh_.neighbours_of[owner];
    neighbours[place_of(update.before, neighbours)] = update.now;
  }

 private:
  /// The neighbours that pass from triangle two to one, and from one to two.
  TriangleId left_of_two(const Plan& flip) const {
    return mesh_.neighbours_of[flip.two][(flip.near + 1) % 3];
  }
  TriangleId left_of_one(const Plan& flip) const {
    return mesh_.neighbours_of[flip.one][(flip.far + 1) % 3];
  }

  Triangulation& mesh_;
};

using Corners = std::vector<std::array<VertexId, 3>>;

/// The triangles in an order that does not depend on how they were made.
Corners sorted(Corners corners_of) {
  for (auto& corners : corners_of)
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::sort(corners_of.begin(), corners_of.end());
  return corners_of;
}

void compare(const Arguments& arguments) {
  const Triangulation start = rows_of_points(arguments.size);
  std::vector<FlipEdges::Item> edges;
  for (TriangleId t = 0; t < start.corners_of.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i)
      if (start.neighbours_of[t][i] < t) edges.push_back(3 * t + i);
  std::printf("The Delaunay triangulation of %zu points by flips of %zu edges\n",
              start.points.size(), edges.size());
  const Triangulation mesh = solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        Triangulation flipped = start;
        FlipEdges flip(flipped);
        report = runtime::run_rounds(executor, flip, edges);
        return flipped;
      });
  Triangulation serial = start;
  FlipEdges flip(serial);
  const double seconds = seconds_of([&] { OneByOne<FlipEdges>(flip, edges); });
  print_yardstick("serial: one flip after the other", seconds);
  require(delaunay_area(mesh) == 2 * std::int64_t{square_side} * square_side, "not Delaunay");
  require(sorted(mesh.corners_of) == sorted(serial.corners_of), "the serial triangles are others");
}

}  // namespace

int main(int argument_count, char** argument) {
  return run(argument_count, argument, 100000, compare);
}
