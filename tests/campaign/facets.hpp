/// @file
/// Facets of the elements of a mesh, found by sorting: the elements of each, and whether it is
/// listed. The boundary, interfaces and connectivity follow from them.
#pragma once

#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include "mesh.hpp"

namespace ductile::campaign {

using Key = std::array<int, 4>;  ///< corners in ascending order, unused ones (-1) first

Key key_of(const Cell& cell);

struct Facet {
  Key key;
  Cell corners;               ///< in outward order of one of its elements
  std::vector<int> elements;  ///< usually one or two
  std::vector<int> listed;    ///< indices among the facets of the file
  bool on_boundary() const { return elements.size() == 1; }
};

/// All facets of elements, and listed ones that belong to no element, in ascending order of keys.
std::vector<Facet> facets_of(const Mesh& mesh);

/// The facets of one element, seen from outside.
std::vector<Cell> facets_of_element(const Mesh& mesh, const Cell& element);

/// All pairs of corners of cells with `corners` corners, each once, in ascending order.
std::vector<std::array<int, 2>> edges_of(const std::vector<Cell>& cells, int corners);

/// Union-find: sets that are joined and counted.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace ductile::campaign
