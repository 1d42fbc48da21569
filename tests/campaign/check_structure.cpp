#include <algorithm>
#include <cmath>
#include <set>

#include "check.hpp"
#include "exact.hpp"
#include "facets.hpp"
#include "geometry.hpp"

namespace ductile::campaign {
namespace {

bool indices_in_range(const Mesh& mesh, Faults& faults) {
  const int points = static_cast<int>(mesh.points.size());
  for (const auto& [corners, cells] : mesh.cells)
    for (const Cell& cell : cells.corners)
      for (int i = 0; i < corners; ++i) {
        const int vertex = cell[static_cast<std::size_t>(i)];
        if (vertex < 0 || vertex >= points) {
          faults.push_back("structure: index out of range in a cell of " + std::to_string(corners));
          return false;
        }
      }
  const std::map<std::string, std::size_t> limits = {
      {"Corners", mesh.points.size()},
      {"RequiredVertices", mesh.points.size()},
      {"Ridges", mesh.cells_of(2).size()},
      {"RequiredEdges", mesh.cells_of(2).size()},
      {"RequiredTriangles", mesh.cells_of(3).size()},
      {"RequiredTetrahedra", mesh.cells_of(4).size()}};
  for (const auto& [name, list] : mesh.lists)
    for (const int index : list)
      if (index < 0 || static_cast<std::size_t>(index) >= limits.at(name)) {
        faults.push_back("structure: index out of range in " + name);
        return false;
      }
  return true;
}

void check_elements(const Mesh& mesh, Faults& faults) {
  std::size_t flat = 0;
  std::set<int> used;
  std::set<Key> seen;
  for (const Cell& element : mesh.elements().corners) {
    if (mesh.surface ? !(measure(mesh, element) > 0) : orientation(mesh, element) <= 0) ++flat;
    used.insert(element.begin(), element.end());
    seen.insert(key_of(element));
  }
  used.erase(-1);
  report("structure", flat, "elements without a positive volume", faults);
  report("structure", mesh.elements().size() - seen.size(), "elements there twice", faults);
  report("structure", mesh.points.size() - used.size(), "vertices of no element", faults);
}

/// Are two of the facet's elements on the same side? They then see it with the same orientation.
bool on_one_side(const Mesh& mesh, const Facet& facet) {
  int even = 0;
  for (const int element : facet.elements)
    for (const Cell& own :
         facets_of_element(mesh, mesh.elements().corners[static_cast<std::size_t>(element)]))
      if (key_of(own) == facet.key) {
        int inversions = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.element_dimension()); ++i)
          for (std::size_t j = 0; j < i; ++j) inversions += own[j] > own[i] ? 1 : 0;
        even += inversions % 2 == 0 ? 1 : 0;
      }
  return even != 1;
}

void check_facets(const Mesh& mesh, bool unlisted_boundary, Faults& faults) {
  std::size_t crowded = 0, overlapping = 0, unlisted = 0, astray = 0, twice = 0;
  for (const Facet& facet : facets_of(mesh)) {
    if (facet.elements.size() > 2) ++crowded;
    if (facet.elements.size() == 2 && on_one_side(mesh, facet)) ++overlapping;
    if (facet.on_boundary() && facet.listed.empty()) ++unlisted;
    if (facet.elements.empty()) ++astray;
    if (facet.listed.size() > 1) ++twice;
  }
  // A surface may have lines of more than two triangles, rims, and one side only.
  if (!mesh.surface) {
    report("structure", crowded, "facets with more than two elements", faults);
    report("structure", overlapping, "facets with both elements on one side", faults);
  }
  if (!unlisted_boundary && !mesh.surface)
    report("structure", unlisted, "boundary facets not listed", faults);
  report("structure", astray, "listed facets of no element", faults);
  report("structure", twice, "facets listed twice", faults);
}

void check_lines(const Mesh& mesh, Faults& faults) {
  if (mesh.element_dimension() == 2) return;
  const auto edges = edges_of(mesh.elements().corners, 4);
  std::size_t astray = 0;
  std::set<std::array<int, 2>> seen;
  for (const Cell& line : mesh.cells_of(2).corners) {
    const std::array<int, 2> edge = {std::min(line[0], line[1]), std::max(line[0], line[1])};
    if (!std::binary_search(edges.begin(), edges.end(), edge)) ++astray;
    seen.insert(edge);
  }
  report("structure", astray, "listed edges of no element", faults);
  report("structure", mesh.cells_of(2).size() - seen.size(), "edges listed twice", faults);
}

}  // namespace

Faults check_structure(const Mesh& mesh, bool unlisted_boundary) {
  Faults faults;
  for (const Point& point : mesh.points)
    for (const double x : point)
      if (!std::isfinite(x)) return {"structure: a coordinate that is not finite"};
  if (mesh.elements().size() == 0) return {"structure: no elements"};
  if (!indices_in_range(mesh, faults)) return faults;
  check_elements(mesh, faults);
  check_facets(mesh, unlisted_boundary, faults);
  check_lines(mesh, faults);
  return faults;
}

Faults check_all(const Mesh& before, const Mesh& after, const Promise& promise) {
  if (before.dimension != after.dimension || before.surface != after.surface)
    return {"structure: another dimension"};
  Faults faults = check_structure(after);
  if (!faults.empty()) return faults;
  for (const Faults& more :
       {check_domain(before, after, promise), check_surface(before, after, promise),
        check_overlaps(after), check_required(before, after)})
    faults.insert(faults.end(), more.begin(), more.end());
  return faults;
}

}  // namespace ductile::campaign
