/// @file
/// Ring: the elements around an edge of a tetrahedral mesh in turn, and the vertices they pass.
#pragma once

#include <array>

#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// The two other corners p, q of an element on a-b, such that (a, b, p, q) is positive.
inline std::array<VertexId, 2> others(const Corners<3>& corners, VertexId a, VertexId b) {
  // Even permutations of the four corners, by the positions of a and b.
  static constexpr int rest[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                        {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                        {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                        {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
  const auto place = [&](VertexId v) {  // no branches: any corner may be the one
    return (corners[1] == v) + 2 * (corners[2] == v) + 3 * (corners[3] == v);
  };
  const auto& r = rest[place(a)][place(b)];
  return {corners[static_cast<std::size_t>(r[0])], corners[static_cast<std::size_t>(r[1])]};
}

/// Element order[i] of those around an edge a-b lies between vertices[i] and vertices[i + 1], which
/// turn counter-clockwise seen from b. A closed ring begins again after its last vertex; an open
/// one starts and ends on the boundary.
class Ring {
 public:
  static constexpr std::size_t most_elements = 16;

  boost::container::static_vector<std::uint8_t, most_elements> order;
  boost::container::static_vector<VertexId, most_elements + 1> vertices;
  bool open = false;

  /// Puts `count` elements around a-b in turn; corners(i) are the i-th one's. False if they do not
  /// make one ring, or are too many.
  bool close(std::size_t count, VertexId a, VertexId b, auto&& corners) {
    if (count == 0 || count > most_elements) return false;
    sides_.clear();
    for (std::size_t i = 0; i < count; ++i) sides_.push_back(others(corners(i), a, b));
    follow(0);
    if (order.size() == count && vertices.size() == count) return count > 2;
    open = true;
    for (std::size_t i = 0; i < count && order.size() < count; ++i)
      if (before(sides_[i][0]) == count) follow(i);
    return order.size() == count;
  }

 private:
  void follow(std::size_t start) {
    order.clear();
    vertices.clear();
    vertices.push_back(sides_[start][0]);
    for (std::size_t at = start; at != sides_.size() && order.size() < sides_.size();) {
      order.push_back(static_cast<std::uint8_t>(at));
      const VertexId next = sides_[at][1];
      if (next == vertices.front()) return;
      vertices.push_back(next);
      at = after(next);
    }
  }
  /// The element that starts at a vertex, the one that ends there, or their number if none does.
  std::size_t after(VertexId vertex) const { return find<0>(vertex); }
  std::size_t before(VertexId vertex) const { return find<1>(vertex); }
  template <std::size_t End>
  std::size_t find(VertexId vertex) const {
    std::size_t found = sides_.size();
    for (std::size_t i = sides_.size(); i-- > 0;) found = sides_[i][End] == vertex ? i : found;
    return found;
  }

  boost::container::static_vector<std::array<VertexId, 2>, most_elements> sides_;
};

}  // namespace ductile::meshadapt
