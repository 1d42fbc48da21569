/// @file
/// Disjoint sets for one thread by Rem's algorithm, the fastest of many compared by Patwary, Blair
/// & Manne (SEA 2010): it climbs from both vertices and joins or shortens paths on the way.
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "../graphs.hpp"

namespace lean {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t vertex_count) : parent_of_(vertex_count) {
    std::iota(parent_of_.begin(), parent_of_.end(), example::Vertex{0});
  }

  /// Unites the sets of two vertices; returns false if they were in one set already.
  bool join(example::Vertex a, example::Vertex b) {
    while (parent_of_[a] != parent_of_[b]) {
      if (parent_of_[a] > parent_of_[b]) std::swap(a, b);
      const example::Vertex above = std::exchange(parent_of_[b], parent_of_[a]);
      if (above == b) return true;  // b was a root
      b = above;
    }
    return false;
  }

 private:
  std::vector<example::Vertex> parent_of_;  // [vertex], a lesser one, or itself if it is a root
};

}  // namespace lean
