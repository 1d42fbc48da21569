#include <algorithm>
#include <cmath>
#include <numbers>

#include "facets.hpp"
#include "geometry.hpp"
#include "shapes.hpp"

namespace ductile::campaign {
namespace {

constexpr double pi = std::numbers::pi;

Grid even_grid(int dimension, const std::array<int, 3>& counts) {
  Grid grid;
  grid.dimension = dimension;
  for (std::size_t axis = 0; axis < 3; ++axis) grid.lines[axis] = even_lines(counts[axis]);
  return grid;
}

Grid random_grid(Random& random, int dimension) {
  if (dimension == 2) return even_grid(2, {random.between(2, 18), random.between(2, 18), 1});
  return even_grid(3, {random.between(1, 6), random.between(1, 6), random.between(1, 6)});
}

// ---- Parts left out ----

void carve(Random& random, Mesh& mesh) {
  const Point at = random.point();
  switch (random.below(6)) {
    case 0: {
      for (int holes = random.between(1, 3); holes > 0; --holes) {
        const Point hole =
            mesh.dimension == 2 ? Point{random.unit(), random.unit(), 0} : random.point();
        const double radius = random.uniform(0.05, 0.3);
        keep_elements(mesh, [&](const Point& x) { return norm(x - hole) > radius; });
      }
      break;
    }
    case 1:
      keep_elements(mesh, [&](const Point& x) { return x[0] < 0.5 || x[1] < at[1]; });
      break;
    case 2: {
      const int arms = random.between(2, 6);
      keep_elements(mesh, [&](const Point& x) {
        const double turn = std::atan2(x[1] - 0.5, x[0] - 0.5);
        return std::hypot(x[0] - 0.5, x[1] - 0.5) < 0.35 + 0.18 * std::sin(arms * turn);
      });
      break;
    }
    case 3:
      keep_elements(mesh, [&](const Point&) { return random.chance(0.9); });
      break;
    default:
      break;
  }
  if (random.chance(0.88)) remove_non_manifold(mesh);
}

// ---- Maps of space ----

Point twisted(const Point& x, double turns) {
  const double turn = turns * x[2], c = std::cos(turn), s = std::sin(turn);
  return {c * (x[0] - 0.5) - s * (x[1] - 0.5), s * (x[0] - 0.5) + c * (x[1] - 0.5), x[2]};
}

/// Returns whether straight lines became curves.
bool warp(Random& random, Mesh& mesh) {
  const double a = random.uniform(0.02, 0.15), phase = random.uniform(0, 6);
  const double power = random.uniform(1, 4), turns = random.uniform(0, 2);
  const Point stretch = {random.power(-1.2, 1.2), random.power(-1.2, 1.2), random.power(-1.2, 1.2)};
  switch (random.below(6)) {
    case 0:
      return map(mesh,
                 [&](const Point& x) {
                   return Point{x[0] + a * std::sin(3 * x[1] + phase), x[1],
                                x[2] + a * std::sin(2 * x[0])};
                 }) &&
             mesh.dimension == 3;
    case 1:
      map(mesh, [&](const Point& x) {
        return Point{stretch[0] * x[0], stretch[1] * x[1], stretch[2] * x[2]};
      });
      return false;
    case 2:
      map(mesh, [&](const Point& x) {
        return Point{std::pow(x[0], power) + 1e-3 * x[0], x[1], x[2]};
      });
      return false;
    case 3:
      return mesh.dimension == 3 && map(mesh, [&](const Point& x) { return twisted(x, turns); });
    case 4:
      return map(mesh, [&](const Point& x) {
        return Point{x[0], x[1] + a * std::sin(4 * x[0] + phase), x[2]};
      });
    default:
      return false;
  }
}

/// Maps a point of the square (or cube) from -1 to 1, in the first `axes` axes: concentric squares
/// inside `round` become circles (or spheres), and those outside change back to squares.
Point rounded(const Point& x, std::size_t axes, double round) {
  double largest = 0, square = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    largest = std::max(largest, std::abs(x[i]));
    square += x[i] * x[i];
  }
  if (!(square > 0)) return x;
  const double weight = largest <= round ? 1 : (1 - largest) / (1 - round);
  const double factor = 1 - weight + weight * largest / std::sqrt(square);
  Point y = x;
  for (std::size_t i = 0; i < axes; ++i) y[i] *= factor;
  return y;
}

std::vector<double> lines_between(double low, double high, int count) {
  std::vector<double> lines;
  for (const double line : even_lines(count)) lines.push_back(low + (high - low) * line);
  return lines;
}

Shape torus(Random& random) {
  Grid grid = even_grid(3, {random.between(6, 16), 2, 2});
  grid.closed = true;
  const int across = random.pick({2, 2, 4});
  grid.lines[1] = grid.lines[2] = lines_between(-1, 1, across);
  Shape shape;
  shape.mesh = make_grid(random, grid);
  const double ring = random.uniform(1.6, 3);
  map(shape.mesh, [&](const Point& x) {
    const Point disc = rounded({x[1], x[2], 0}, 2, 1);
    const double turn = 2 * pi * x[0], r = ring + disc[0];
    return Point{r * std::cos(turn), r * std::sin(turn), disc[1]};
  });
  shape.curved = true;
  return shape;
}

}  // namespace

Shape random_body(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.55) ? 2 : 3;
  shape.mesh = make_grid(random, random_grid(random, dimension));
  jitter(random, shape.mesh, {random.pick({0.0, 0.15, 0.3})});
  if (random.chance(0.65)) carve(random, shape.mesh);
  shape.curved = warp(random, shape.mesh);
  return shape;
}

Shape flat_body(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.5) ? 2 : 3;
  shape.mesh = make_grid(random, random_grid(random, dimension));
  jitter(random, shape.mesh, {random.pick({0.0, 0.2})});
  return shape;
}

Shape tiny_body(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.5) ? 2 : 3;
  shape.mesh = make_grid(random, even_grid(dimension, {random.between(1, 3), 1, 1}));
  if (random.chance(0.6)) {
    const Point direction = {random.normal(), random.normal(), random.normal()};
    keep_elements(shape.mesh, [&](const Point& x) { return dot(x, direction) > 0.2; });
    remove_non_manifold(shape.mesh);
  }
  return shape;
}

Shape round_body(Random& random) {
  if (random.chance(0.2)) return torus(random);
  Shape shape;
  const int dimension = random.chance(0.35) ? 2 : 3;
  const bool ball = random.chance(0.5);
  const int across = 2 * random.between(1, dimension == 2 ? 10 : 3);
  Grid grid = even_grid(dimension, {across, across, ball ? across : random.between(1, 5)});
  for (std::size_t axis = 0; axis < (ball ? 3U : 2U); ++axis)
    grid.lines[axis] = lines_between(-1, 1, across);
  shape.mesh = make_grid(random, grid);
  const std::size_t axes = dimension == 3 && ball ? 3 : 2;
  map(shape.mesh, [&](const Point& x) { return rounded(x, axes, 1); });
  shape.curved = true;
  return shape;
}

Shape inclusion(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.35) ? 2 : 3;
  const bool ball = random.chance(0.4);
  const double radius = random.uniform(0.2, 0.7);
  const int inside = 2 * random.between(1, dimension == 2 ? 6 : 2), outside = random.between(1, 2);
  std::vector<double> lines = lines_between(-1, -radius, outside);
  for (const double line : lines_between(-radius, radius, inside))
    if (line > lines.back() + 1e-9) lines.push_back(line);
  for (const double line : lines_between(radius, 1, outside))
    if (line > lines.back() + 1e-9) lines.push_back(line);
  Grid grid = even_grid(dimension, {1, 1, random.between(1, 4)});
  grid.lines[0] = grid.lines[1] = lines;
  const std::size_t axes = dimension == 3 && ball ? 3 : 2;
  if (axes == 3) grid.lines[2] = lines;
  shape.mesh = make_grid(random, grid);
  for (std::size_t i = 0; i < shape.mesh.elements().size(); ++i) {
    const Point x = centre(shape.mesh, shape.mesh.elements().corners[i]);
    double largest = 0;
    for (std::size_t axis = 0; axis < axes; ++axis) largest = std::max(largest, std::abs(x[axis]));
    if (largest < radius) shape.mesh.elements().reference[i] = 2;
  }
  map(shape.mesh, [&](const Point& x) { return rounded(x, axes, radius); });
  shape.curved = true;
  shape.length = 0.02;
  return shape;
}

Shape thin_wall(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.4) ? 2 : 3;
  const double thickness = random.power(-3, -1);
  const bool ring = random.chance(0.6);
  const int around = random.between(8, dimension == 2 ? 60 : 18);
  Grid grid = even_grid(dimension, {around, random.between(1, 4), random.between(1, 2)});
  grid.closed = ring;
  const std::size_t across = dimension == 2 ? 1 : 2;
  grid.lines[across] = even_lines(random.between(1, 2), thickness);
  shape.mesh = make_grid(random, grid);
  const double wave = random.chance(0.5) ? 0 : random.uniform(0.02, 0.12);
  const int waves = random.between(1, 4);
  map(shape.mesh, [&](const Point& x) {
    const double out = x[across] + wave * std::sin(2 * pi * waves * x[0]);
    const double along = dimension == 2 ? 0 : x[1];
    if (!ring) return dimension == 2 ? Point{x[0], out, 0} : Point{x[0], along, out};
    const double turn = (dimension == 2 ? -2 : 2) * pi * x[0], r = 0.5 + out;
    const Point round = {r * std::cos(turn), r * std::sin(turn), along};
    return round;
  });
  shape.curved = true;
  shape.length = thickness;
  return shape;
}

Shape short_edges(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.6) ? 2 : 3;
  const int count = dimension == 2 ? random.between(4, 12) : random.between(2, 4);
  shape.mesh = make_grid(random, even_grid(dimension, {count, count, count}));
  const double gap = random.power(-6, -2);
  // One edge of the bottom gets a vertex close to its end; the rest of the mesh stays as it is.
  std::vector<std::array<int, 2>> bottom;
  for (const auto& edge : edges_of(shape.mesh.elements().corners, dimension + 1)) {
    const auto low = static_cast<std::size_t>(dimension - 1);
    if (shape.mesh.points[static_cast<std::size_t>(edge[0])][low] == 0 &&
        shape.mesh.points[static_cast<std::size_t>(edge[1])][low] == 0)
      bottom.push_back(edge);
  }
  const auto chosen =
      bottom[static_cast<std::size_t>(random.below(static_cast<int>(bottom.size())))];
  split_edge(shape.mesh, chosen, gap * count);
  shape.length = gap;
  return shape;
}

Shape layered_box(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.6) ? 2 : 3;
  const int many = dimension == 2 ? random.between(10, 40) : random.between(3, 8);
  Grid grid = even_grid(dimension, {random.between(2, 5), many, random.between(1, 4)});
  const double aspect = random.power(0, 3);
  for (double& line : grid.lines[0]) line *= aspect / many;
  shape.mesh = make_grid(random, grid);
  if (random.chance(0.5)) {
    const double bend = random.uniform(0.2, 1) / aspect * many;
    shape.curved = map(shape.mesh, [&](const Point& x) {
      return Point{x[0], x[1] + 0.1 * std::sin(bend * x[0]), x[2]};
    });
  }
  return shape;
}

}  // namespace ductile::campaign
