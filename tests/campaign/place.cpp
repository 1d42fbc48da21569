#include "place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "build.hpp"
#include "facets.hpp"
#include "geometry.hpp"

namespace ductile::campaign {
namespace {

Point turned(const std::array<Point, 3>& axes, const Point& x) {
  return x[0] * axes[0] + x[1] * axes[1] + x[2] * axes[2];
}

double rounded_to(double x, int digits) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.*e", digits - 1, x);
  return std::atof(text.data());
}

/// Lists some of the boundary's edges as lines, in 3D.
void list_lines(Random& random, Mesh& mesh) {
  std::vector<Cell> boundary;
  for (const Cell& facet : mesh.facets().corners) boundary.push_back(facet);
  const double share = random.pick({0.02, 0.3, 1.0});
  Cells lines;
  for (const auto& edge : edges_of(boundary, 3))
    if (random.chance(share)) lines.add({edge[0], edge[1], -1, -1}, random.below(3));
  mesh.cells[2] = lines;
  if (random.chance(0.5))
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (random.chance(0.5)) mesh.lists["Ridges"].push_back(static_cast<int>(i));
}

void choose(Random& random, Mesh& mesh, const std::string& name, std::size_t count) {
  const double share = random.pick({0.003, 0.03, 0.3});
  for (std::size_t i = 0; i < count; ++i)
    if (random.chance(share)) mesh.lists[name].push_back(static_cast<int>(i));
}

}  // namespace

void choose_regions(Random& random, Mesh& mesh) {
  auto& reference = mesh.elements().reference;
  if (std::any_of(reference.begin(), reference.end(), [](int r) { return r != 1; })) return;
  const Box box = box_of(mesh.points);
  const int way = random.below(10);
  const Point direction = {random.normal(), random.normal(), random.normal()};
  std::vector<Point> seeds;
  for (int count = random.between(2, 6); count > 0; --count) seeds.push_back(random.point());
  const double level = dot(direction, seeds[0]);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Point x = (1 / box.extent()) * (centre(mesh, mesh.elements().corners[i]) - box.low);
    if (way < 5) continue;
    if (way < 7) reference[i] = dot(x, direction) > level ? 2 : 1;
    if (way == 9) reference[i] = random.below(3);
    if (way == 7 || way == 8) {
      const auto nearest = std::min_element(
          seeds.begin(), seeds.end(),
          [&](const Point& a, const Point& b) { return norm(a - x) < norm(b - x); });
      reference[i] = static_cast<int>(nearest - seeds.begin());
    }
  }
}

double put_turned(Random& random, Mesh& mesh) {
  const auto axes = random.axes(mesh.dimension);
  map(mesh, [&](const Point& x) { return turned(axes, x); });
  return 1;
}

double put_far_away(Random& random, Mesh& mesh) {
  if (random.chance(0.5)) put_turned(random, mesh);
  const double scale = random.chance(0.7) ? random.power(-20, 20) : 1;
  const double offset = random.chance(0.5) ? random.power(0, 8) : 0;
  const Point direction = random.axes(mesh.dimension)[0];
  map(mesh, [&](const Point& x) { return x + offset * direction; });
  return map(mesh, [&](const Point& x) { return scale * x; }) ? scale : 1;
}

double put_with_few_digits(Random& random, Mesh& mesh, Mesh& exact, double& rounding) {
  const double scale = random.power(-2, 3);
  const auto axes = random.axes(mesh.dimension);
  map(mesh, [&](const Point& x) { return turned(axes, scale * x); });
  const Point offset =
      mesh.dimension == 2 ? Point{random.unit(), random.unit(), 0} : random.point();
  const double away = scale * random.pick({0.0, 1.0, 100.0});
  map(mesh, [&](const Point& x) { return x + away * offset; });
  exact.points = mesh.points;
  // Digits of the mesh itself, in addition to those of its offset.
  const int way = random.below(3), digits = random.between(4, 10) + (away > scale ? 2 : 0);
  const double step = std::pow(10, std::floor(std::log10(scale * random.power(-6, -3))));
  rounding = 0;
  const bool fine = map(mesh, [&](const Point& x) {
    Point y = x;
    for (double& value : y) {
      if (way == 0) value = rounded_to(value, digits);
      if (way == 1) value = static_cast<double>(static_cast<float>(value));
      if (way == 2) value = std::round(value / step) * step;
    }
    rounding = std::max(rounding, norm(y - x));
    return y;
  });
  if (!fine) rounding = 0;
  return scale;
}

void list_all_facets(std::uint64_t seed, Mesh& mesh) {
  Random random(seed);
  const int way = random.below(10);
  const bool interfaces = random.chance(0.75);
  const Point direction = {random.normal(), random.normal(), random.normal()};
  const Box box = box_of(mesh.points);
  for (int& reference : mesh.point_reference) reference = random.below(3);
  list_facets(mesh, interfaces, [&](const Point& x, const Point& normal) {
    if (way < 3) return 3;
    if (way == 9) return random.below(4);
    if (way < 6) return dot((1 / box.extent()) * (x - box.low), direction) > 0.3 ? 2 : 1;
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis)
      if (std::abs(normal[static_cast<std::size_t>(axis)]) >
          std::abs(normal[static_cast<std::size_t>(largest)]))
        largest = axis;
    return 1 + largest;
  });
}

void unlist_some(Random& random, Mesh& mesh) {
  std::set<Key> boundary;
  for (const Facet& facet : facets_of(mesh))
    if (facet.on_boundary()) boundary.insert(facet.key);
  Cells kept;
  for (std::size_t i = 0; i < mesh.facets().size(); ++i) {
    const Cell& facet = mesh.facets().corners[i];
    if (boundary.count(key_of(facet)) == 0 || random.chance(0.7) || kept.size() == 0)
      kept.add(facet, mesh.facets().reference[i]);
  }
  mesh.facets() = kept;
  mesh.lists.erase(mesh.dimension == 2 ? "RequiredEdges" : "RequiredTriangles");
  if (mesh.dimension == 2) mesh.lists.erase("Ridges");
}

void require_some(Random& random, Mesh& mesh) {
  if (mesh.element_dimension() == 3 && random.chance(0.6)) list_lines(random, mesh);
  if (random.chance(0.6)) choose(random, mesh, "RequiredVertices", mesh.points.size());
  if (random.chance(0.5)) choose(random, mesh, "RequiredEdges", mesh.cells_of(2).size());
  if (random.chance(0.5)) choose(random, mesh, "RequiredTriangles", mesh.cells_of(3).size());
  if (random.chance(0.5)) choose(random, mesh, "RequiredTetrahedra", mesh.cells_of(4).size());
  if (!random.chance(0.4)) return;
  std::set<int> boundary;
  for (const Cell& facet : mesh.facets().corners)
    for (const int vertex : facet)
      if (vertex >= 0) boundary.insert(vertex);
  for (const int vertex : boundary)
    if (random.chance(0.1)) mesh.lists["Corners"].push_back(vertex);
}

}  // namespace ductile::campaign
