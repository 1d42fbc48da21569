#include "build.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "exact.hpp"
#include "facets.hpp"
#include "geometry.hpp"

namespace ductile::campaign {
namespace {

/// Removes the elements that are not kept, and vertices that no element has afterwards.
void filter(Mesh& mesh, const std::vector<char>& kept) {
  Cells elements;
  std::vector<int> number(mesh.points.size(), -1);
  std::vector<Point> points;
  for (std::size_t i = 0; i < mesh.elements().size(); ++i) {
    if (!kept[i]) continue;
    Cell cell = mesh.elements().corners[i];
    for (int& vertex : cell) {
      if (vertex < 0) continue;
      int& now = number[static_cast<std::size_t>(vertex)];
      if (now < 0) {
        now = static_cast<int>(points.size());
        points.push_back(mesh.points[static_cast<std::size_t>(vertex)]);
      }
      vertex = now;
    }
    elements.add(cell, mesh.elements().reference[i]);
  }
  mesh.points = std::move(points);
  mesh.point_reference.assign(mesh.points.size(), 0);
  mesh.elements() = std::move(elements);
}

class GridMaker {
 public:
  GridMaker(Random& random, const Grid& grid) : random_(random), grid_(grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto lines = static_cast<int>(grid.lines[axis].size());
      points_[axis] = static_cast<int>(axis) < grid.dimension ? lines : 1;
    }
    cells_ = {points_[0] - 1, points_[1] - 1, grid.dimension == 3 ? points_[2] - 1 : 1};
    if (grid.closed) --points_[0];
  }

  Mesh make() {
    Mesh mesh;
    mesh.dimension = grid_.dimension;
    for (int k = 0; k < points_[2]; ++k)
      for (int j = 0; j < points_[1]; ++j)
        for (int i = 0; i < points_[0]; ++i)
          mesh.points.push_back({at(0, i), at(1, j), grid_.dimension == 3 ? at(2, k) : 0});
    for (int k = 0; k < cells_[2]; ++k)
      for (int j = 0; j < cells_[1]; ++j)
        for (int i = 0; i < cells_[0]; ++i)
          if (!grid_.keep || grid_.keep({i, j, k})) add_cell(mesh, {i, j, k});
    filter(mesh, std::vector<char>(mesh.elements().size(), 1));
    return mesh;
  }

 private:
  double at(std::size_t axis, int line) const {
    return grid_.lines[axis][static_cast<std::size_t>(line)];
  }
  int vertex(const std::array<int, 3>& i) const {
    return (i[2] * points_[1] + i[1]) * points_[0] + i[0] % points_[0];
  }

  void add_cell(Mesh& mesh, const std::array<int, 3>& cell) {
    if (grid_.dimension == 2) {
      const int a = vertex(cell), b = vertex({cell[0] + 1, cell[1], 0}),
                c = vertex({cell[0] + 1, cell[1] + 1, 0}), d = vertex({cell[0], cell[1] + 1, 0});
      const bool rising = random_.chance(0.5);
      mesh.elements().add(rising ? Cell{a, b, c, -1} : Cell{a, b, d, -1}, 1);
      mesh.elements().add(rising ? Cell{a, c, d, -1} : Cell{b, c, d, -1}, 1);
      return;
    }
    // Six tetrahedra, one for each order of the axes on the way to the opposite corner.
    std::array<int, 3> order = {0, 1, 2};
    do {
      std::array<int, 3> corner = cell;
      Cell element = {vertex(corner), 0, 0, 0};
      int inversions = 0;
      for (std::size_t step = 0; step < 3; ++step) {
        ++corner[static_cast<std::size_t>(order[step])];
        element[step + 1] = vertex(corner);
        for (std::size_t before = 0; before < step; ++before)
          inversions += order[before] > order[step] ? 1 : 0;
      }
      if (inversions % 2 == 1) std::swap(element[0], element[1]);
      mesh.elements().add(element, 1);
    } while (std::next_permutation(order.begin(), order.end()));
  }

  Random& random_;
  const Grid& grid_;
  std::array<int, 3> points_;
  std::array<int, 3> cells_;
};

/// Vertices whose elements are not connected across facets, and ends of boundary edges with more
/// than two facets.
std::set<int> non_manifold_vertices(const Mesh& mesh, const std::vector<Facet>& facets) {
  const auto& elements = mesh.elements().corners;
  Groups groups(elements.size() * 4);
  const auto member = [&](int element, int vertex) {
    const Cell& cell = elements[static_cast<std::size_t>(element)];
    return static_cast<std::size_t>(element) * 4 +
           static_cast<std::size_t>(std::find(cell.begin(), cell.end(), vertex) - cell.begin());
  };
  std::map<std::array<int, 2>, int> uses;
  for (const Facet& facet : facets) {
    if (facet.elements.size() == 2)
      for (const int vertex : facet.corners)
        if (vertex >= 0)
          groups.join(member(facet.elements[0], vertex), member(facet.elements[1], vertex));
    if (facet.on_boundary() && mesh.dimension == 3)
      for (const auto& edge : edges_of({facet.corners}, 3)) ++uses[edge];
  }
  std::set<int> found;
  std::map<int, std::size_t> fan_of;
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.corner_count()); ++k)
      if (fan_of.emplace(elements[i][k], groups.find(i * 4 + k)).first->second !=
          groups.find(i * 4 + k))
        found.insert(elements[i][k]);
  for (const auto& [edge, count] : uses)
    if (count > 2) found.insert(edge.begin(), edge.end());
  return found;
}

void keep_largest_part(Mesh& mesh) {
  const std::size_t count = mesh.elements().size();
  Groups groups(count);
  for (const Facet& facet : facets_of(mesh))
    if (facet.elements.size() == 2)
      groups.join(static_cast<std::size_t>(facet.elements[0]),
                  static_cast<std::size_t>(facet.elements[1]));
  std::map<std::size_t, int> size;
  for (std::size_t i = 0; i < count; ++i) ++size[groups.find(i)];
  const auto largest = std::max_element(
      size.begin(), size.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<char> kept(count);
  for (std::size_t i = 0; i < count; ++i) kept[i] = groups.find(i) == largest->first ? 1 : 0;
  filter(mesh, kept);
}

struct Void {
  Cell outer;               ///< the tetrahedron that it is in
  std::size_t first_point;  ///< of its four corners
  std::size_t first_part;   ///< of the elements around it
  double share;
};

/// Moves the corners of a void to random places in its tetrahedron, if all elements around it stay
/// positive. The larger the void's share, the closer each stays to its corner of the tetrahedron.
void distort_void(Random& random, Mesh& mesh, const Void& hole) {
  const std::vector<Point> alike(
      mesh.points.begin() + static_cast<std::ptrdiff_t>(hole.first_point), mesh.points.end());
  for (int tries = 0; tries < 60; ++tries) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<double, 4> weight;
      double sum = 0;
      for (double& one : weight) sum += one = random.unit();
      sum += 4 * hole.share * random.unit();
      weight[i] += sum - (weight[0] + weight[1] + weight[2] + weight[3]);
      Point at = {0, 0, 0};
      for (std::size_t j = 0; j < 4; ++j) at = at + (weight[j] / sum) * corner(mesh, hole.outer, j);
      mesh.points[hole.first_point + i] = at;
    }
    const auto& elements = mesh.elements().corners;
    if (std::all_of(elements.begin() + static_cast<std::ptrdiff_t>(hole.first_part), elements.end(),
                    [&](const Cell& part) { return orientation(mesh, part) > 0; }))
      return;
  }
  std::copy(alike.begin(), alike.end(),
            mesh.points.begin() + static_cast<std::ptrdiff_t>(hole.first_point));
}

}  // namespace

std::vector<double> even_lines(int count, double length) {
  std::vector<double> lines;
  for (int i = 0; i <= count; ++i) lines.push_back(length * i / count);
  return lines;
}

Mesh make_grid(Random& random, const Grid& grid) { return GridMaker(random, grid).make(); }

void keep_elements(Mesh& mesh, const std::function<bool(const Point&)>& keep) {
  std::vector<char> kept;
  for (const Cell& element : mesh.elements().corners)
    kept.push_back(keep(centre(mesh, element)) ? 1 : 0);
  if (std::count(kept.begin(), kept.end(), 1) >= 2) filter(mesh, kept);
}

void remove_non_manifold(Mesh& mesh) {
  keep_largest_part(mesh);
  for (;;) {
    const std::set<int> found = non_manifold_vertices(mesh, facets_of(mesh));
    if (found.empty()) return;
    std::vector<char> kept;
    for (const Cell& element : mesh.elements().corners)
      kept.push_back(std::none_of(element.begin(), element.end(),
                                  [&](int vertex) { return found.count(vertex) != 0; }));
    if (std::count(kept.begin(), kept.end(), 1) == 0) kept[0] = 1;
    filter(mesh, kept);
    keep_largest_part(mesh);
  }
}

std::vector<int> cut(Mesh& mesh, const std::function<bool(const std::vector<Point>&)>& is_cut) {
  auto& elements = mesh.elements().corners;
  Groups groups(elements.size() * 4);
  const auto member = [&](int element, int vertex) {
    const Cell& cell = elements[static_cast<std::size_t>(element)];
    return static_cast<std::size_t>(element) * 4 +
           static_cast<std::size_t>(std::find(cell.begin(), cell.end(), vertex) - cell.begin());
  };
  for (const Facet& facet : facets_of(mesh)) {
    std::vector<Point> corners;
    for (const int vertex : facet.corners)
      if (vertex >= 0) corners.push_back(mesh.points[static_cast<std::size_t>(vertex)]);
    if (facet.elements.size() != 2 || is_cut(corners)) continue;
    for (const int vertex : facet.corners)
      if (vertex >= 0)
        groups.join(member(facet.elements[0], vertex), member(facet.elements[1], vertex));
  }
  std::vector<int> origin(mesh.points.size());
  std::iota(origin.begin(), origin.end(), 0);
  std::map<std::size_t, int> vertex_of;  // by fan
  std::set<int> taken;
  std::vector<Cell> renamed = elements;
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.corner_count()); ++k) {
      const int old = elements[i][k];
      const auto [at, is_new] = vertex_of.emplace(groups.find(i * 4 + k), old);
      if (is_new && !taken.insert(old).second) {
        at->second = static_cast<int>(mesh.points.size());
        mesh.points.push_back(Point(mesh.points[static_cast<std::size_t>(old)]));
        origin.push_back(old);
      }
      renamed[i][k] = at->second;
    }
  elements = renamed;
  mesh.point_reference.assign(mesh.points.size(), 0);
  return origin;
}

void hollow(Mesh& mesh, std::size_t element, double share, Random* random) {
  const Cell outer = mesh.elements().corners[element];
  const Point middle = centre(mesh, outer);
  const std::size_t first_point = mesh.points.size(), first_part = mesh.elements().size();
  std::map<int, int> inner;
  for (const int vertex : outer) {
    inner[vertex] = static_cast<int>(mesh.points.size());
    mesh.points.push_back(middle +
                          share * (mesh.points[static_cast<std::size_t>(vertex)] - middle));
    mesh.point_reference.push_back(0);
  }
  for (const Cell& facet : facets_of_element(mesh, outer)) {
    std::array<int, 3> v = {facet[0], facet[1], facet[2]};
    std::sort(v.begin(), v.end());  // a side is cut along the same diagonal for both of its facets
    const std::array<Cell, 3> parts = {{{v[0], v[1], v[2], inner[v[2]]},
                                        {v[0], v[1], inner[v[1]], inner[v[2]]},
                                        {v[0], inner[v[0]], inner[v[1]], inner[v[2]]}}};
    for (Cell part : parts) {
      if (orientation(mesh, part) < 0) std::swap(part[0], part[1]);
      mesh.elements().add(part, mesh.elements().reference[element]);
    }
  }
  if (random != nullptr) distort_void(*random, mesh, {outer, first_point, first_part, share});
  std::vector<char> kept(mesh.elements().size(), 1);
  kept[element] = 0;
  filter(mesh, kept);
}

void split_edge(Mesh& mesh, const std::array<int, 2>& edge, double share) {
  const Point a = mesh.points[static_cast<std::size_t>(edge[0])];
  const Point b = mesh.points[static_cast<std::size_t>(edge[1])];
  const int middle = static_cast<int>(mesh.points.size());
  mesh.points.push_back(a + share * (b - a));
  mesh.point_reference.push_back(0);
  Cells& elements = mesh.elements();
  for (std::size_t i = elements.size(); i-- > 0;) {
    Cell first = elements.corners[i], second = first;
    const auto at_a = std::find(first.begin(), first.end(), edge[0]) - first.begin();
    const auto at_b = std::find(first.begin(), first.end(), edge[1]) - first.begin();
    if (at_a == 4 || at_b == 4) continue;
    first[static_cast<std::size_t>(at_b)] = second[static_cast<std::size_t>(at_a)] = middle;
    elements.corners[i] = first;
    elements.add(second, elements.reference[i]);
  }
}

void jitter(Random& random, Mesh& mesh, const Jitter& how) {
  std::vector<char> fixed(mesh.points.size(), 0);
  for (const Facet& facet : facets_of(mesh))
    if (facet.on_boundary())
      for (const int vertex : facet.corners)
        if (vertex >= 0 && static_cast<std::size_t>(vertex) < how.boundary_from)
          fixed[static_cast<std::size_t>(vertex)] = 1;
  std::vector<double> shortest(mesh.points.size(), 1e300);
  std::vector<std::vector<std::size_t>> elements_of(mesh.points.size());
  for (std::size_t i = 0; i < mesh.elements().size(); ++i)
    for (const int vertex : mesh.elements().corners[i])
      if (vertex >= 0) elements_of[static_cast<std::size_t>(vertex)].push_back(i);
  for (const auto& edge : edges_of(mesh.elements().corners, mesh.corner_count())) {
    const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
    const double length = norm(mesh.points[a] - mesh.points[b]);
    shortest[a] = std::min(shortest[a], length);
    shortest[b] = std::min(shortest[b], length);
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (fixed[i]) continue;
    const Point old = mesh.points[i];
    for (int axis = 0; axis < mesh.dimension; ++axis)
      mesh.points[i][static_cast<std::size_t>(axis)] +=
          how.amount * shortest[i] * random.uniform(-1, 1);
    for (const std::size_t element : elements_of[i])
      if (orientation(mesh, mesh.elements().corners[element]) <= 0) {
        mesh.points[i] = old;
        break;
      }
  }
}

bool all_positive(const Mesh& mesh) {
  const auto& elements = mesh.elements().corners;
  return std::all_of(elements.begin(), elements.end(), [&](const Cell& element) {
    return mesh.surface ? measure(mesh, element) > 0 : orientation(mesh, element) > 0;
  });
}

bool map(Mesh& mesh, const std::function<Point(const Point&)>& to) {
  const std::vector<Point> old = mesh.points;
  for (Point& point : mesh.points) {
    point = to(point);
    if (mesh.dimension == 2) point[2] = 0;
  }
  if (all_positive(mesh)) return true;
  mesh.points = old;
  return false;
}

void list_facets(Mesh& mesh, bool interfaces,
                 const std::function<int(const Point&, const Point&)>& reference) {
  Cells listed;
  const auto region = [&](int element) {
    return mesh.elements().reference[static_cast<std::size_t>(element)];
  };
  for (const Facet& facet : facets_of(mesh)) {
    const bool between = facet.elements.size() == 2 && interfaces &&
                         region(facet.elements[0]) != region(facet.elements[1]);
    if (!facet.on_boundary() && !between) continue;
    const Point along = corner(mesh, facet.corners, 1) - corner(mesh, facet.corners, 0);
    const Point other = mesh.element_dimension() == 2
                            ? Point{0, 0, 1}
                            : corner(mesh, facet.corners, 2) - corner(mesh, facet.corners, 0);
    Point normal = cross(along, other);
    if (norm(normal) > 0) normal = (1 / norm(normal)) * normal;
    listed.add(facet.corners, reference(centre(mesh, facet.corners), normal));
  }
  mesh.facets() = std::move(listed);
}

void make_surface(Mesh& mesh, const std::function<bool()>& keep) {
  const Cells facets = std::exchange(mesh.facets(), {});
  mesh.elements() = {};
  mesh.surface = true;
  mesh.elements() = facets;
  std::vector<char> kept;
  for (std::size_t i = 0; i < facets.size(); ++i) kept.push_back(keep() ? 1 : 0);
  filter(mesh, kept);
}

}  // namespace ductile::campaign
