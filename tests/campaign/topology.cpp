#include "topology.hpp"

#include <algorithm>
#include <set>

#include "facets.hpp"

namespace ductile::campaign {
namespace {

int vertex_count(const std::vector<Cell>& cells) {
  std::set<int> vertices;
  for (const Cell& cell : cells) vertices.insert(cell.begin(), cell.end());
  vertices.erase(-1);
  return static_cast<int>(vertices.size());
}

int facet_count(const Mesh& mesh, const std::vector<Cell>& elements) {
  std::set<Key> facets;
  for (const Cell& element : elements)
    for (const Cell& facet : facets_of_element(mesh, element)) facets.insert(key_of(facet));
  return static_cast<int>(facets.size());
}

/// V - E + F in 2D, V - E + F - T in 3D.
int euler_of(const Mesh& mesh, const std::vector<Cell>& elements) {
  const int v = vertex_count(elements);
  const int count = static_cast<int>(elements.size());
  const int e = static_cast<int>(edges_of(elements, mesh.corner_count()).size());
  return mesh.element_dimension() == 2 ? v - e + count
                                       : v - e + facet_count(mesh, elements) - count;
}

int count_groups(Groups& groups, const std::vector<std::size_t>& members) {
  std::set<std::size_t> roots;
  for (const std::size_t member : members) roots.insert(groups.find(member));
  return static_cast<int>(roots.size());
}

int components_by_vertices(const std::vector<Cell>& cells, std::size_t points) {
  Groups groups(points);
  std::vector<std::size_t> firsts;
  for (const Cell& cell : cells) {
    firsts.push_back(static_cast<std::size_t>(cell[0]));
    for (const int vertex : cell)
      if (vertex >= 0) groups.join(firsts.back(), static_cast<std::size_t>(vertex));
  }
  return count_groups(groups, firsts);
}

int components_by_facets(const std::vector<Facet>& facets, std::size_t elements,
                         const std::vector<std::size_t>& members) {
  Groups groups(elements);
  std::set<std::size_t> inside(members.begin(), members.end());
  for (const Facet& facet : facets)
    if (facet.elements.size() == 2) {
      const auto a = static_cast<std::size_t>(facet.elements[0]);
      const auto b = static_cast<std::size_t>(facet.elements[1]);
      if (inside.count(a) != 0 && inside.count(b) != 0) groups.join(a, b);
    }
  return count_groups(groups, members);
}

int boundary_euler_of(const std::vector<Cell>& boundary, int dimension) {
  const int v = vertex_count(boundary);
  const int count = static_cast<int>(boundary.size());
  return dimension == 2 ? v - count : v - static_cast<int>(edges_of(boundary, 3).size()) + count;
}

PartTopology part_topology(const Mesh& mesh, const std::vector<Facet>& facets,
                           const std::vector<std::size_t>& members) {
  std::vector<Cell> elements;
  std::vector<char> inside(mesh.elements().size(), 0);
  for (const std::size_t member : members) {
    elements.push_back(mesh.elements().corners[member]);
    inside[member] = 1;
  }
  std::vector<Cell> boundary;
  for (const Facet& facet : facets) {
    int sides = 0;
    for (const int element : facet.elements) sides += inside[static_cast<std::size_t>(element)];
    if (sides == 1) boundary.push_back(facet.corners);
  }
  PartTopology part;
  part.euler = euler_of(mesh, elements);
  part.components = components_by_facets(facets, mesh.elements().size(), members);
  part.boundary_components = components_by_vertices(boundary, mesh.points.size());
  part.boundary_euler = boundary_euler_of(boundary, mesh.element_dimension());
  return part;
}

/// Edges of the boundary whose number of facets is not two, in 3D; those of a surface with more
/// than two triangles.
std::vector<Cell> non_manifold_edges(const Mesh& mesh, const std::vector<Facet>& facets) {
  std::map<std::array<int, 2>, int> count;
  std::vector<Cell> found;
  for (const Facet& facet : facets)
    if (mesh.surface && facet.elements.size() > 2) found.push_back(facet.corners);
  if (mesh.element_dimension() == 3)
    for (const Facet& facet : facets)
      if (facet.on_boundary())
        for (const auto& edge : edges_of({facet.corners}, 3)) ++count[edge];
  for (const auto& [edge, uses] : count)
    if (uses != 2) found.push_back({edge[0], edge[1], -1, -1});
  return found;
}

/// Vertices whose elements form several fans not connected by facets.
std::set<int> vertices_of_several_fans(const Mesh& mesh, const std::vector<Facet>& facets) {
  const auto& elements = mesh.elements().corners;
  const auto corners = static_cast<std::size_t>(mesh.corner_count());
  Groups groups(elements.size() * corners);  // one member for each corner of each element
  const auto member = [&](int element, int vertex) {
    const Cell& cell = elements[static_cast<std::size_t>(element)];
    const auto at = std::find(cell.begin(), cell.end(), vertex) - cell.begin();
    return static_cast<std::size_t>(element) * corners + static_cast<std::size_t>(at);
  };
  for (const Facet& facet : facets)
    for (std::size_t side = 1; side < facet.elements.size(); ++side)
      for (const int vertex : facet.corners)
        if (vertex >= 0)
          groups.join(member(facet.elements[0], vertex), member(facet.elements[side], vertex));
  std::map<int, std::size_t> fan_of;
  std::set<int> several;
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t k = 0; k < corners; ++k) {
      const auto [at, is_new] = fan_of.emplace(elements[i][k], groups.find(i * corners + k));
      if (!is_new && at->second != groups.find(i * corners + k)) several.insert(elements[i][k]);
    }
  return several;
}

void compare(const std::string& what, int before, int after, std::vector<std::string>& lines) {
  if (before != after)
    lines.push_back(what + " " + std::to_string(before) + " -> " + std::to_string(after));
}

void compare(const std::string& where, const PartTopology& before, const PartTopology& after,
             std::vector<std::string>& lines) {
  compare("topology: Euler characteristic" + where, before.euler, after.euler, lines);
  compare("topology: components" + where, before.components, after.components, lines);
  compare("topology: boundary components" + where, before.boundary_components,
          after.boundary_components, lines);
  compare("topology: Euler characteristic of the boundary" + where, before.boundary_euler,
          after.boundary_euler, lines);
}

}  // namespace

Topology topology_of(const Mesh& mesh) {
  const std::vector<Facet> facets = facets_of(mesh);
  Topology topology;
  std::vector<std::size_t> all;
  std::map<int, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < mesh.elements().size(); ++i) {
    all.push_back(i);
    members[mesh.elements().reference[i]].push_back(i);
  }
  topology.whole = part_topology(mesh, facets, all);
  for (const auto& [region, list] : members)
    topology.by_region[region] = part_topology(mesh, facets, list);
  const std::vector<Cell> edges = non_manifold_edges(mesh, facets);
  topology.non_manifold_lines = components_by_vertices(edges, mesh.points.size());
  std::set<int> several = vertices_of_several_fans(mesh, facets);
  for (const Cell& edge : edges)
    for (const int vertex : edge) several.erase(vertex);
  topology.non_manifold_vertices = static_cast<int>(several.size());
  return topology;
}

std::vector<std::string> differences(const Topology& before, const Topology& after) {
  std::vector<std::string> lines;
  compare("", before.whole, after.whole, lines);
  for (const auto& [region, part] : before.by_region) {
    const auto found = after.by_region.find(region);
    if (found == after.by_region.end())
      lines.push_back("topology: region " + std::to_string(region) + " is lost");
    else
      compare(" of region " + std::to_string(region), part, found->second, lines);
  }
  for (const auto& entry : after.by_region)
    if (before.by_region.count(entry.first) == 0)
      lines.push_back("topology: region " + std::to_string(entry.first) + " is new");
  compare("topology: vertices where the boundary meets itself", before.non_manifold_vertices,
          after.non_manifold_vertices, lines);
  compare("topology: lines where the boundary meets itself", before.non_manifold_lines,
          after.non_manifold_lines, lines);
  return lines;
}

}  // namespace ductile::campaign
