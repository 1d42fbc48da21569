#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "geometry.hpp"
#include "shapes.hpp"

namespace ductile::campaign {
namespace {

/// A plate (2D: strip) with these layers across its last axis.
Grid plate_grid(Random& random, int dimension, const std::vector<double>& layers) {
  Grid grid;
  grid.dimension = dimension;
  grid.lines[0] = even_lines(dimension == 2 ? random.between(6, 20) : random.between(3, 7));
  grid.lines[1] = dimension == 2 ? layers : even_lines(random.between(3, 7));
  grid.lines[2] = layers;
  return grid;
}

/// Bends or waves a plate across its last axis; returns whether it is curved then.
bool bend(Random& random, Mesh& mesh, double share) {
  if (!random.chance(share)) return false;
  const std::size_t across = mesh.dimension == 2 ? 1 : 2;
  const double amount = random.uniform(0.02, 0.2), waves = random.uniform(1, 6);
  const double skew = mesh.dimension == 2 ? 0 : random.uniform(-1, 1);
  return map(mesh, [&](const Point& x) {
    Point y = x;
    y[across] += amount * std::sin(waves * (x[0] + skew * x[1]));
    return y;
  });
}

/// Indices of the elements that share a vertex with this one, including itself.
std::set<std::size_t> neighbours(const Mesh& mesh, std::size_t element) {
  const Cell& own = mesh.elements().corners[element];
  std::set<std::size_t> found;
  for (std::size_t i = 0; i < mesh.elements().size(); ++i)
    for (const int vertex : mesh.elements().corners[i])
      if (vertex >= 0 && std::find(own.begin(), own.end(), vertex) != own.end()) found.insert(i);
  return found;
}

/// Hollows up to `count` tetrahedra, preferably adjacent ones.
void hollow_some(Random& random, Mesh& mesh, int count) {
  std::size_t last =
      static_cast<std::size_t>(random.below(static_cast<int>(mesh.elements().size())));
  const std::set<std::size_t> near = neighbours(mesh, last);
  std::set<std::size_t, std::greater<>> chosen;
  for (; count > 0; --count) {
    const bool close = random.chance(0.6);
    auto at = near.begin();
    std::advance(at, random.below(static_cast<int>(near.size())));
    chosen.insert(
        close ? *at
              : static_cast<std::size_t>(random.below(static_cast<int>(mesh.elements().size()))));
  }
  // hollow() renumbers the elements after this one, so the last one goes first.
  for (const std::size_t element : chosen)
    hollow(mesh, element, random.uniform(0.2, 0.97), random.chance(0.8) ? &random : nullptr);
}

/// Random cells (i, j), none at the rim, no two of them neighbours.
std::set<std::array<int, 2>> scattered(Random& random, const Grid& grid, int count) {
  const int nx = static_cast<int>(grid.lines[0].size()) - 1;
  const int ny = grid.dimension == 2 ? 3 : static_cast<int>(grid.lines[1].size()) - 1;
  std::set<std::array<int, 2>> chosen;
  for (int tries = 4 * count; tries > 0 && static_cast<int>(chosen.size()) < count; --tries) {
    const std::array<int, 2> cell = {
        random.between(1, std::max(1, nx - 2)),
        grid.dimension == 2 ? 1 : random.between(1, std::max(1, ny - 2))};
    bool is_free = nx > 2 && ny > 2;
    for (const auto& other : chosen)
      is_free = is_free && (std::abs(other[0] - cell[0]) > 1 || std::abs(other[1] - cell[1]) > 1);
    if (is_free) chosen.insert(cell);
  }
  return chosen;
}

Shape plate_with_blocks(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.4) ? 2 : 3;
  const double wall = random.power(-2.5, -1), gap = random.power(-3, -1.3);
  Grid grid = plate_grid(random, dimension, {0, wall, wall + gap, 2 * wall + gap});
  const auto voids = scattered(random, grid, random.between(1, 4));
  grid.keep = [=](const std::array<int, 3>& cell) {
    const int layer = dimension == 2 ? cell[1] : cell[2];
    return layer != 1 || voids.count({cell[0], dimension == 2 ? 1 : cell[1]}) == 0;
  };
  shape.mesh = make_grid(random, grid);
  shape.curved = bend(random, shape.mesh, 0.6);
  shape.length = random.chance(0.5) ? wall : gap;
  return shape;
}

// ---- Cuts ----

/// A rectangle of the plane at `height` across the last axis.
struct Patch {
  double height = 0;
  Point low, high;

  bool holds(const std::vector<Point>& facet, std::size_t across) const {
    for (const Point& x : facet) {
      if (std::abs(x[across] - height) > 1e-12) return false;
      for (std::size_t axis = 0; axis < across; ++axis)
        if (x[axis] < low[axis] - 1e-12 || x[axis] > high[axis] + 1e-12) return false;
    }
    return true;
  }
};

Patch random_patch(Random& random, const Grid& grid, double height, bool to_the_rim) {
  Patch patch;
  patch.height = height;
  const int margin = to_the_rim ? 0 : 1;
  for (std::size_t axis = 0; axis + 1 < static_cast<std::size_t>(grid.dimension); ++axis) {
    const auto& lines = grid.lines[axis];
    const int count = static_cast<int>(lines.size()) - 1;
    const int width = std::max(1, std::min(count - 2 * margin, random.between(2, 4)));
    const int first = margin + random.below(std::max(1, count - 2 * margin - width + 1));
    patch.low[axis] = lines[static_cast<std::size_t>(first)];
    patch.high[axis] = lines[static_cast<std::size_t>(std::min(count, first + width))];
  }
  return patch;
}

/// [vertex] Side of the plane at `height` on which its elements lie, -1 or 1; 0: both.
std::vector<int> sides_of(const Mesh& mesh, double height, std::size_t across) {
  std::vector<int> side(mesh.points.size(), 2);
  for (const Cell& element : mesh.elements().corners) {
    const int own = centre(mesh, element)[across] > height ? 1 : -1;
    for (const int vertex : element)
      if (vertex >= 0) {
        int& now = side[static_cast<std::size_t>(vertex)];
        now = now == 2 || now == own ? own : 0;
      }
  }
  return side;
}

}  // namespace

Shape plate_with_voids(Random& random) {
  if (random.chance(0.4)) return plate_with_blocks(random);
  Shape shape;
  const double thickness = random.power(-2, -0.7);
  Grid grid = plate_grid(random, 3, even_lines(random.between(1, 2), thickness));
  shape.mesh = make_grid(random, grid);
  jitter(random, shape.mesh, {0.3});
  hollow_some(random, shape.mesh, random.between(1, 5));
  bend(random, shape.mesh, 0.3);
  shape.curved = true;  // thin tetrahedra have facets that turn by a few degrees
  shape.length = 0.5 * thickness;
  return shape;
}

Shape sheets(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.4) ? 2 : 3;
  const std::size_t across = dimension == 2 ? 1 : 2;
  const double layer = random.power(-1.7, -0.3);
  Grid grid = plate_grid(random, dimension, even_lines(2, 2 * layer));
  std::vector<Patch> patches;
  for (int count = random.between(1, 4); count > 0; --count)
    patches.push_back(random_patch(random, grid, layer, false));
  shape.mesh = make_grid(random, grid);
  const std::vector<int> origin = cut(shape.mesh, [&](const std::vector<Point>& facet) {
    return std::any_of(patches.begin(), patches.end(),
                       [&](const Patch& patch) { return patch.holds(facet, across); });
  });
  std::vector<int> copies(origin.size(), 0);
  for (const int old : origin) ++copies[static_cast<std::size_t>(old)];
  const std::vector<int> sides = sides_of(shape.mesh, layer, across);
  const double gap = layer * random.power(-3, -0.5);
  for (std::size_t i = 0; i < shape.mesh.points.size(); ++i)
    if (copies[static_cast<std::size_t>(origin[i])] > 1)
      shape.mesh.points[i][across] += 0.5 * gap * sides[i];
  shape.curved = true;
  bend(random, shape.mesh, 0.4);
  shape.length = random.chance(0.7) ? gap : layer;
  return shape;
}

Shape crack(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.5) ? 2 : 3;
  const std::size_t across = dimension == 2 ? 1 : 2;
  const int layers = 2 * random.between(1, dimension == 2 ? 4 : 2);
  Grid grid = plate_grid(random, dimension, even_lines(layers));
  std::vector<Patch> patches;
  for (int count = random.between(1, 2); count > 0; --count) {
    const int level = random.between(1, layers - 1);
    patches.push_back(random_patch(
        random, grid, grid.lines[across][static_cast<std::size_t>(level)], random.chance(0.5)));
  }
  shape.mesh = make_grid(random, grid);
  cut(shape.mesh, [&](const std::vector<Point>& facet) {
    return std::any_of(patches.begin(), patches.end(),
                       [&](const Patch& patch) { return patch.holds(facet, across); });
  });
  shape.curved = bend(random, shape.mesh, 0.8);
  shape.touching = true;
  shape.robust = false;
  shape.length = 0.003;
  return shape;
}

Shape contact(Random& random) {
  Shape shape;
  const int dimension = random.chance(0.5) ? 2 : 3;
  const std::size_t across = dimension == 2 ? 1 : 2;
  const int layers = 2 * random.between(1, 2);
  const Grid grid = plate_grid(random, dimension, even_lines(layers));
  const double height = grid.lines[across][static_cast<std::size_t>(layers / 2)];
  shape.mesh = make_grid(random, grid);
  cut(shape.mesh, [&](const std::vector<Point>& facet) {
    return std::all_of(facet.begin(), facet.end(),
                       [&](const Point& x) { return std::abs(x[across] - height) < 1e-12; });
  });
  const std::vector<int> sides = sides_of(shape.mesh, height, across);
  if (random.chance(0.5)) {
    for (std::size_t i = 0; i < shape.mesh.elements().size(); ++i)
      if (centre(shape.mesh, shape.mesh.elements().corners[i])[across] > height)
        shape.mesh.elements().reference[i] = 2;
  }
  shape.curved = bend(random, shape.mesh, 0.85);
  const double gap = random.chance(0.3) ? 0 : random.power(-16, -9);
  for (std::size_t i = 0; i < shape.mesh.points.size(); ++i)
    if (sides[i] == 1) shape.mesh.points[i][across] += gap;
  shape.touching = true;
  shape.robust = false;
  shape.length = 0.003;
  return shape;
}

}  // namespace ductile::campaign
