/// @file
/// A quotient graph for elimination (George & Liu, SIAM Review 31, 1989). An eliminated vertex
/// becomes an element: a list of its neighbours, which are a clique from then on. Elements inside
/// the new one are absorbed; vertices with the same neighbours are merged into one with a size.
/// Degrees are bounds (Amestoy, Davis & Duff, SIAM J. Matrix Anal. Appl. 17, 1996).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "graphs.hpp"

namespace example {

class QuotientGraph {
 public:
  /// Scratch memory of eliminate(), reused.
  struct Scratch {
    std::vector<Vertex> kept;
    std::vector<std::pair<std::uint64_t, Vertex>> hashes;
  };

  /// The graph has no loops or repeated edges, and ascending rows.
  explicit QuotientGraph(ductile::runtime::CsrGraph<> graph)
      : nodes_(graph.vertex_count()),
        lists_(graph.neighbour.begin(), graph.neighbour.end()),
        members_(graph.vertex_count()) {
    for (Vertex v = 0; v < nodes_.size(); ++v) {
      nodes_[v].begin = graph.offset[v];
      nodes_[v].degree = nodes_[v].neighbours = graph.offset[v + 1] - graph.offset[v];
      nodes_[v].last = v;
    }
  }

  std::size_t size() const { return nodes_.size(); }
  /// Is the vertex neither eliminated nor merged into another?
  bool is_left(Vertex v) const { return nodes_[v].size > 0; }
  /// A bound on the number of vertices adjacent to it, without itself and those merged into it.
  std::uint32_t degree(Vertex v) const { return nodes_[v].degree; }
  /// A vertex's list has elements first, then neighbours.
  std::span<const Vertex> list(Vertex v) const {
    return {lists_.data() + nodes_[v].begin, nodes_[v].elements + nodes_[v].neighbours};
  }
  std::span<const Vertex> elements(Vertex v) const { return list(v).first(nodes_[v].elements); }
  std::span<const Vertex> neighbours(Vertex v) const { return list(v).subspan(nodes_[v].elements); }
  /// Members of an element; empty if this is none or has been absorbed.
  std::span<const Vertex> members(Vertex element) const { return members_[element]; }

  /// Eliminates a vertex. `clique` has its neighbours; those merged into others are removed.
  /// Changes the vertex, its neighbours, and the entries of their lists; reads nothing else.
  void eliminate(Vertex pivot, std::vector<Vertex>& clique, Scratch& scratch) {
    for (const Vertex e : elements(pivot)) members_[e] = {};
    nodes_[pivot].degree = 0;  // becomes the weight of the element's members
    for (const Vertex v : clique) {
      nodes_[v].mark = pivot;
      nodes_[pivot].degree += nodes_[v].size;
      for (const Vertex e : elements(v)) {
        if (std::exchange(nodes_[e].mark, pivot) != pivot) nodes_[e].left = nodes_[e].degree;
        nodes_[e].left -= nodes_[v].size;
      }
    }
    nodes_[pivot].mark = pivot;
    scratch.hashes.clear();
    for (const Vertex v : clique) shorten(pivot, v, scratch);
    unite_alike(scratch.hashes);
    nodes_[pivot].size = 0;
    std::erase_if(clique, [&](Vertex v) { return !is_left(v); });
    members_[pivot].assign(clique.begin(), clique.end());
    for (const Vertex v : clique) bound_degree(pivot, v);
  }

  /// Visits a vertex and all those merged into it, which were eliminated together.
  void for_each_of(Vertex v, auto&& visit) const {
    for (; v != none; v = nodes_[v].next) visit(v);
  }

 private:
  static constexpr Vertex none = 0xffffffffU;
  struct Node {
    std::uint32_t begin = 0, elements = 0, neighbours = 0;  // its list
    std::uint32_t size = 1;                                 // 0 for elements and merged vertices
    std::uint32_t degree = 0;  // of an element, the weight of its members
    std::uint32_t left = 0;    // of an element, the weight of its members outside the new one
    Vertex mark = none;        // the last pivot that met it
    Vertex next = none, last = none;  // the vertices merged into this one
  };

  /// Merges vertex `gone` into `kept`.
  void unite(Vertex kept, Vertex gone) {
    nodes_[kept].size += std::exchange(nodes_[gone].size, 0);
    nodes_[nodes_[kept].last].next = gone;
    nodes_[kept].last = nodes_[gone].last;
  }

  /// Reduces the list to the new element, elements with vertices outside it, and neighbours outside
  /// it. A vertex with neither of the last two is eliminated with the pivot.
  void shorten(Vertex pivot, Vertex v, Scratch& scratch) {
    std::vector<Vertex>& kept = scratch.kept;
    kept.assign(1, pivot);
    for (const Vertex e : elements(v)) {
      if (nodes_[e].left == 0) members_[e] = {};
      if (!members_[e].empty()) kept.push_back(e);
    }
    const auto elements = static_cast<std::uint32_t>(kept.size());
    for (const Vertex u : neighbours(v))
      if (is_left(u) && nodes_[u].mark != pivot) kept.push_back(u);
    nodes_[v].elements = elements;
    nodes_[v].neighbours = static_cast<std::uint32_t>(kept.size()) - elements;
    std::copy(kept.begin(), kept.end(), lists_.begin() + nodes_[v].begin);
    if (kept.size() == 1) {
      nodes_[pivot].degree -= nodes_[v].size;
      unite(pivot, v);
    } else {
      scratch.hashes.emplace_back(std::accumulate(kept.begin(), kept.end(), std::uint64_t{0}), v);
    }
  }

  /// Merges vertices with the same lists, comparing only those with the same hash. Lists have a
  /// fixed order: the newest element first, neighbours as in the rows of the graph.
  void unite_alike(std::vector<std::pair<std::uint64_t, Vertex>>& hashes) {
    std::sort(hashes.begin(), hashes.end());
    for (auto one = hashes.begin(); one != hashes.end(); ++one)
      for (auto two = one + 1; two != hashes.end() && two->first == one->first; ++two) {
        const Vertex v = one->second, other = two->second;
        if (is_left(v) && is_left(other) && nodes_[v].elements == nodes_[other].elements &&
            std::ranges::equal(list(v), list(other)))
          unite(v, other);
      }
  }

  /// Bounds the degree of v; vertices in two elements other than the new one count twice.
  void bound_degree(Vertex pivot, Vertex v) {
    const std::uint32_t others = nodes_[pivot].degree - nodes_[v].size;
    std::uint32_t sum = others;
    for (const Vertex e : elements(v).subspan(1)) sum += nodes_[e].left;
    for (const Vertex u : neighbours(v)) sum += nodes_[u].size;
    nodes_[v].degree = std::min(sum, nodes_[v].degree + others);
  }

  std::vector<Node> nodes_;
  std::vector<Vertex> lists_;
  std::vector<std::vector<Vertex>> members_;  // [element]
};

}  // namespace example
