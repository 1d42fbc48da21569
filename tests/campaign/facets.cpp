#include "facets.hpp"

#include <algorithm>

namespace ductile::campaign {

Key key_of(const Cell& cell) {
  Key key = cell;
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<Cell> facets_of_element(const Mesh& mesh, const Cell& e) {
  if (mesh.element_dimension() == 2)
    return {{e[0], e[1], -1, -1}, {e[1], e[2], -1, -1}, {e[2], e[0], -1, -1}};
  return {{e[0], e[2], e[1], -1},
          {e[0], e[1], e[3], -1},
          {e[1], e[2], e[3], -1},
          {e[2], e[0], e[3], -1}};
}

std::vector<Facet> facets_of(const Mesh& mesh) {
  struct Entry {
    Key key;
    Cell corners;
    int element, listed;
    bool operator<(const Entry& other) const {
      return std::tie(key, element, listed) < std::tie(other.key, other.element, other.listed);
    }
  };
  std::vector<Entry> entries;
  const auto& elements = mesh.elements().corners;
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (const Cell& facet : facets_of_element(mesh, elements[i]))
      entries.push_back({key_of(facet), facet, static_cast<int>(i), -1});
  const auto& listed = mesh.facets().corners;
  for (std::size_t i = 0; i < listed.size(); ++i)
    entries.push_back({key_of(listed[i]), listed[i], -1, static_cast<int>(i)});
  std::sort(entries.begin(), entries.end());
  std::vector<Facet> facets;
  for (const Entry& entry : entries) {
    if (facets.empty() || facets.back().key != entry.key)
      facets.push_back({entry.key, entry.corners, {}, {}});
    Facet& facet = facets.back();
    if (entry.element >= 0) {
      if (facet.elements.empty()) facet.corners = entry.corners;
      facet.elements.push_back(entry.element);
    } else {
      facet.listed.push_back(entry.listed);
    }
  }
  return facets;
}

std::vector<std::array<int, 2>> edges_of(const std::vector<Cell>& cells, int corners) {
  std::vector<std::array<int, 2>> edges;
  for (const Cell& cell : cells)
    for (std::size_t i = 0; i < static_cast<std::size_t>(corners); ++i)
      for (std::size_t j = 0; j < i; ++j)
        edges.push_back({std::min(cell[i], cell[j]), std::max(cell[i], cell[j])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace ductile::campaign
