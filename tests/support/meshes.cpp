#include "support/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/orientation.hpp"
#include "ductile/runtime/hash.hpp"

namespace ductile::meshadapt::test {

double uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11U) * 0x1p-53);
}
bool chance(Random& random, double probability) { return uniform(random, 0, 1) < probability; }
std::size_t below(Random& random, std::size_t limit) { return random() % limit; }

template <int Dim>
const Cells<Dim + 1>& elements(const AnyMesh& mesh) {
  return elements_in<Dim>(mesh);
}
template <int Dim>
const Cells<Dim>& facets(const AnyMesh& mesh) {
  return facets_in<Dim>(mesh);
}

template <int Dim>
Vector<Dim> point(const AnyMesh& mesh, std::uint32_t vertex) {
  return position_in<Dim>(mesh, vertex);
}

template <int Dim>
FacetElements<Dim> facet_elements(const AnyMesh& mesh) {
  FacetElements<Dim> found;
  const auto& cells = elements<Dim>(mesh).vertices;
  for (ElementId e = 0; e < cells.size(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      Facet<Dim> facet = facet_of<Dim>(cells[e], i);
      std::sort(facet.begin(), facet.end());
      found[facet].push_back(e);
    }
  return found;
}

template const Cells<3>& elements<2>(const AnyMesh&);
template const Cells<4>& elements<3>(const AnyMesh&);
template const Cells<2>& facets<2>(const AnyMesh&);
template const Cells<3>& facets<3>(const AnyMesh&);
template Vector<2> point<2>(const AnyMesh&, std::uint32_t);
template Vector<3> point<3>(const AnyMesh&, std::uint32_t);
template FacetElements<2> facet_elements<2>(const AnyMesh&);
template FacetElements<3> facet_elements<3>(const AnyMesh&);

// ---- Shapes ----

int whole(const Cell&) { return 1; }

std::function<int(const Cell&)> l_shape(int n) {
  return [n](const Cell& c) { return c[0] >= n / 2 && c[1] >= n / 2 ? 0 : 1; };
}
std::function<int(const Cell&)> with_hole(int n) {
  return [n](const Cell& c) {
    const auto inner = [n](int i) { return i >= n / 3 && i < n - n / 3; };
    return inner(c[0]) && inner(c[1]) && (c[2] < 0 || inner(c[2])) ? 0 : 1;
  };
}
std::function<int(const Cell&)> two_halves(int n) {
  return [n](const Cell& c) { return c[0] < n / 2 ? 1 : 2; };
}
std::function<int(const Cell&)> checkerboard() {
  return [](const Cell& c) { return 1 + (c[0] + c[1] + std::max(c[2], 0)) % 2; };
}
std::function<int(const Cell&)> random_regions(std::uint64_t seed, int count, bool holes) {
  return [=](const Cell& c) {
    Random random(seed + 1000003U * static_cast<unsigned>(c[0]) +
                  1009U * static_cast<unsigned>(c[1]) + static_cast<unsigned>(c[2] + 1));
    random.discard(3);
    if (holes && chance(random, 0.2)) return c[0] + c[1] + std::max(c[2], 0) == 0 ? 1 : 0;
    return 1 + static_cast<int>(below(random, static_cast<std::size_t>(count)));
  };
}

// ---- Grids ----

Grid unit_grid(int dimension, int n) {
  Grid grid;
  grid.dimension = dimension;
  for (int axis = 0; axis < dimension; ++axis)
    for (int i = 0; i <= n; ++i) grid.lines[static_cast<std::size_t>(axis)].push_back(1.0 * i / n);
  grid.region = whole;
  return grid;
}

namespace {

/// Vertices of a grid, numbered where they are first used.
class GridMaker {
 public:
  explicit GridMaker(const Grid& grid) : grid_(grid), random_(grid.seed) {
    mesh_.dimension = grid.dimension;
  }

  AnyMesh make() {
    const auto cells = [&](std::size_t axis) {
      return static_cast<int>(grid_.lines[axis].size()) - 1;
    };
    for (int i = 0; i < cells(0); ++i)
      for (int j = 0; j < cells(1); ++j) {
        if (grid_.dimension == 2) cut_square({i, j, -1});
        for (int k = 0; grid_.dimension == 3 && k < cells(2); ++k) cut_cube({i, j, k});
      }
    return std::move(mesh_);
  }

 private:
  std::uint32_t vertex(const Cell& at) {
    const auto [found, fresh] =
        number_.try_emplace(at, static_cast<std::uint32_t>(mesh_.vertex_count()));
    if (fresh) {
      mesh_.vertex_reference.push_back(0);
      for (std::size_t axis = 0; axis < static_cast<std::size_t>(grid_.dimension); ++axis)
        mesh_.coordinates.push_back(grid_.lines[axis][static_cast<std::size_t>(at[axis])]);
    }
    return found->second;
  }

  void cut_square(const Cell& cell) {
    const int region = grid_.region(cell);
    if (region == 0) return;
    const auto [i, j, k] = cell;
    const std::uint32_t a = vertex({i, j, 0}), b = vertex({i + 1, j, 0});
    const std::uint32_t c = vertex({i + 1, j + 1, 0}), d = vertex({i, j + 1, 0});
    if (grid_.seed == 0 || random_() % 2 == 0) {
      mesh_.triangles.add({a, b, c}, region);
      mesh_.triangles.add({a, c, d}, region);
    } else {
      mesh_.triangles.add({a, b, d}, region);
      mesh_.triangles.add({b, c, d}, region);
    }
  }

  /// Adds a tetrahedron for each order of the axes on the way to the opposite corner.
  void cut_cube(const Cell& cell) {
    const int region = grid_.region(cell);
    if (region == 0) return;
    std::array<std::size_t, 3> order{0, 1, 2};
    do {
      Cell at = cell;
      std::array<std::uint32_t, 4> corners{vertex(at)};
      for (std::size_t step = 0; step < 3; ++step) {
        ++at[order[step]];
        corners[step + 1] = vertex(at);
      }
      const bool even = (order[1] + 3 - order[0]) % 3 == 1;
      if (!even) std::swap(corners[2], corners[3]);
      mesh_.tetrahedra.add(corners, region);
    } while (std::next_permutation(order.begin(), order.end()));
  }

  const Grid& grid_;
  Random random_;
  AnyMesh mesh_;
  std::map<Cell, std::uint32_t> number_;
};

/// 1 to 6 for a facet that faces -x +x -y +y -z +z.
template <int Dim>
std::int32_t direction(const AnyMesh& mesh, const Facet<Dim>& facet) {
  Vector<Dim> normal;
  if constexpr (Dim == 2) {
    const Vector<2> d = point<2>(mesh, facet[1]) - point<2>(mesh, facet[0]);
    normal = {{d[1], -d[0]}};
  } else {
    const Vector<3> origin = point<3>(mesh, facet[0]);
    normal = cross(point<3>(mesh, facet[1]) - origin, point<3>(mesh, facet[2]) - origin);
  }
  int best = 0;
  for (int axis = 1; axis < Dim; ++axis)
    if (std::abs(normal[axis]) > std::abs(normal[best])) best = axis;
  return 1 + 2 * best + (normal[best] > 0 ? 1 : 0);
}

template <int Dim>
void list_facets(AnyMesh& mesh, bool interfaces) {
  Cells<Dim>& listed = facets_in<Dim>(mesh);
  const auto& cells = elements<Dim>(mesh);
  const auto owners_of = facet_elements<Dim>(mesh);
  for (ElementId e = 0; e < cells.size(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const Facet<Dim> facet = facet_of<Dim>(cells.vertices[e], i);
      Facet<Dim> key = facet;
      std::sort(key.begin(), key.end());
      const auto& owners = owners_of.at(key);
      if (owners[0] != e) continue;
      const bool boundary = owners.size() == 1;
      const bool interface = !boundary && cells.reference[owners[0]] != cells.reference[owners[1]];
      if (boundary || (interface && interfaces))
        listed.add(facet, direction<Dim>(mesh, facet) + (boundary ? 0 : 10));
    }
}

}  // namespace

AnyMesh make_grid(const Grid& grid, bool list_interfaces) {
  AnyMesh mesh = GridMaker(grid).make();
  if (grid.dimension == 2)
    list_facets<2>(mesh, list_interfaces);
  else
    list_facets<3>(mesh, list_interfaces);
  mesh.name = "test";
  return mesh;
}

void list_ridges(AnyMesh& mesh) {
  using Edge = std::array<std::uint32_t, 2>;
  std::map<Edge, std::set<std::int32_t>> references;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& t = mesh.triangles.vertices[f];
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      references[{low, high}].insert(mesh.triangles.reference[f]);
    }
  std::map<std::uint32_t, std::set<std::int32_t>> meeting;
  for (const auto& [edge, of_facets] : references) {
    if (of_facets.size() < 2) continue;
    const std::int32_t reference = 100 * *of_facets.begin() + *of_facets.rbegin();
    mesh.ridges.push_back(static_cast<std::uint32_t>(mesh.edges.size()));
    mesh.edges.add(edge, reference);
    for (const std::uint32_t v : edge) meeting[v].insert(reference);
  }
  for (const auto& [v, of_edges] : meeting)
    if (of_edges.size() > 1) mesh.corners.push_back(v);
}

// ---- Moving vertices ----

namespace {

/// The vertices that lie inside a region, and the elements around each vertex.
template <int Dim>
struct Surroundings {
  std::vector<std::vector<ElementId>> ball_of;
  std::vector<std::uint32_t> inner;

  explicit Surroundings(const AnyMesh& mesh) : ball_of(mesh.vertex_count()) {
    const auto& cells = elements<Dim>(mesh);
    for (ElementId e = 0; e < cells.size(); ++e)
      for (const std::uint32_t v : cells.vertices[e]) ball_of[v].push_back(e);
    std::vector<bool> fixed(mesh.vertex_count(), false);
    for (const auto& [facet, owners] : facet_elements<Dim>(mesh))
      if (owners.size() == 1 || cells.reference[owners[0]] != cells.reference[owners[1]])
        for (const std::uint32_t v : facet) fixed[v] = true;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      if (!fixed[v]) inner.push_back(v);
  }

  /// Moves a vertex if all elements around it stay positive.
  void move(AnyMesh& mesh, std::uint32_t vertex, const Vector<Dim>& to) const {
    const Vector<Dim> before = point<Dim>(mesh, vertex);
    set(mesh, vertex, to);
    for (const ElementId e : ball_of[vertex]) {
      std::array<Vector<Dim>, Dim + 1> p;
      for (std::size_t i = 0; i < p.size(); ++i)
        p[i] = point<Dim>(mesh, elements<Dim>(mesh).vertices[e][i]);
      if (orientation<Dim>(p) <= 0) return set(mesh, vertex, before);
    }
  }

  static void set(AnyMesh& mesh, std::uint32_t vertex, const Vector<Dim>& to) {
    std::copy_n(to.x.begin(), Dim, &mesh.coordinates[std::size_t{vertex} * Dim]);
  }
};

template <int Dim>
void jiggle_in(AnyMesh& mesh, Random& random, double amount) {
  const Surroundings<Dim> around(mesh);
  for (const std::uint32_t v : around.inner) {
    const auto& ball = around.ball_of[v];
    const auto& corners = elements<Dim>(mesh).vertices[ball[below(random, ball.size())]];
    Vector<Dim> to = point<Dim>(mesh, v);
    for (const std::uint32_t other : corners)
      to += uniform(random, -amount, amount) * (point<Dim>(mesh, other) - point<Dim>(mesh, v));
    around.move(mesh, v, to);
  }
}

template <int Dim>
void make_slivers_in(AnyMesh& mesh, Random& random, std::size_t count, double thickness) {
  const Surroundings<Dim> around(mesh);
  if (around.inner.empty()) return;
  for (std::size_t n = 0; n < count; ++n) {
    const std::uint32_t v = around.inner[below(random, around.inner.size())];
    const auto& ball = around.ball_of[v];
    Vector<Dim> base;
    double total = 0;
    for (const std::uint32_t other :
         elements<Dim>(mesh).vertices[ball[below(random, ball.size())]]) {
      if (other == v) continue;
      const double weight = uniform(random, 0.1, 1);
      base += weight * point<Dim>(mesh, other);
      total += weight;
    }
    base *= 1 / total;
    around.move(mesh, v, base + thickness * (point<Dim>(mesh, v) - base));
  }
}

}  // namespace

void jiggle(AnyMesh& mesh, Random& random, double amount) {
  if (mesh.dimension == 2)
    jiggle_in<2>(mesh, random, amount);
  else
    jiggle_in<3>(mesh, random, amount);
}

void make_slivers(AnyMesh& mesh, Random& random, std::size_t count, double thickness) {
  if (mesh.dimension == 2)
    make_slivers_in<2>(mesh, random, count, thickness);
  else
    make_slivers_in<3>(mesh, random, count, thickness);
}

void bend(AnyMesh& mesh, double angle) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    double& x = mesh.coordinates[v * dimension];
    double& y = mesh.coordinates[v * dimension + 1];
    const double radius = 0.5 + x, turn = angle * y;
    x = radius * std::cos(turn);
    y = radius * std::sin(turn);
  }
}

AnyMesh truncated_cone(int n, double lid) {
  AnyMesh mesh = make_grid(unit_grid(3, n));
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3) {
    double& x = mesh.coordinates[at];
    double& y = mesh.coordinates[at + 1];
    x = 2 * x - 1;
    y = 2 * y - 1;
    const double from_axis = std::hypot(x, y);  // squares become circles
    double scale = 1 + (lid - 1) * mesh.coordinates[at + 2];
    if (from_axis > 0) scale *= std::max(std::abs(x), std::abs(y)) / from_axis;
    x *= scale;
    y *= scale;
  }
  for (std::int32_t& reference : mesh.triangles.reference)
    reference = reference > 4 ? reference : 1;
  return mesh;
}

void place(AnyMesh& mesh, Random& random, double scale, double offset) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  const auto turn = [&](std::size_t a, std::size_t b, double angle) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      double& x = mesh.coordinates[v * dimension + a];
      double& y = mesh.coordinates[v * dimension + b];
      const double turned = std::cos(angle) * x - std::sin(angle) * y;
      y = std::sin(angle) * x + std::cos(angle) * y;
      x = turned;
    }
  };
  turn(0, 1, uniform(random, 0, 2 * std::numbers::pi));
  if (dimension == 3) {
    turn(1, 2, uniform(random, 0, 2 * std::numbers::pi));
    turn(0, 1, uniform(random, 0, 2 * std::numbers::pi));
  }
  for (double& x : mesh.coordinates) x = scale * x + offset;
}

}  // namespace ductile::meshadapt::test
