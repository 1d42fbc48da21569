/// @file
/// A minimum-degree ordering by a quotient graph, serially (George & Liu, SIAM Review 31, 1989). An
/// eliminated vertex becomes an element, a list of its neighbours, which are a clique from then on;
/// elements inside the new one are absorbed. Vertices with the same neighbours are merged into one
/// with a size. Its degree is exact and external: the number of other vertices adjacent to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "../graphs.hpp"

namespace lean {

struct Ordering {
  std::vector<example::Vertex> order;
  std::vector<std::uint32_t> steps;  ///< indices in `order` at which steps begin
  std::uint64_t fill = 0;            ///< number of entries of the factor L, including its diagonal
};

class MinimumDegree {
 public:
  using Vertex = example::Vertex;

  /// The graph has no loops or repeated edges.
  explicit MinimumDegree(ductile::runtime::CsrGraph<> graph)
      : nodes_(graph.vertex_count()),
        first_(graph.vertex_count(), none),
        lists_(graph.neighbour.begin(), graph.neighbour.end()),
        mark_(graph.vertex_count()),
        seen_(graph.vertex_count()),
        left_(graph.vertex_count()) {
    for (Vertex v = 0; v < nodes_.size(); ++v) {
      nodes_[v].begin = graph.offset[v];
      nodes_[v].degree = nodes_[v].neighbours = graph.offset[v + 1] - graph.offset[v];
      nodes_[v].last = v;
      put(v);
    }
  }

  Ordering run() {
    Ordering result;
    while (result.order.size() < nodes_.size()) {
      while (first_[least_] == none) ++least_;
      const Vertex pivot = first_[least_];
      const std::uint32_t size = nodes_[pivot].size, degree = nodes_[pivot].degree;
      eliminate(pivot);
      const std::uint64_t all = nodes_[pivot].size;  // includes those eliminated with it
      result.fill += all * (degree + size - all) + all * (all + 1) / 2;
      result.steps.push_back(static_cast<std::uint32_t>(result.order.size()));
      for (Vertex v = pivot; v != none; v = nodes_[v].next) result.order.push_back(v);
      nodes_[pivot].size = 0;
    }
    return result;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// The list of a vertex has elements first, then neighbours; that of an element has vertices.
  struct Node {
    std::size_t begin = 0;
    std::uint32_t elements = 0, neighbours = 0;
    std::uint32_t size = 1;  // 0 if eliminated or merged into another
    std::uint32_t degree = 0;
    bool is_element = false;
    Vertex next = none, last = none;     // the vertices merged into this one
    Vertex before = none, after = none;  // in the bucket
  };

  void put(Vertex v) {
    Node& node = nodes_[v];
    node.before = none;
    node.after = std::exchange(first_[node.degree], v);
    if (node.after != none) nodes_[node.after].before = v;
    least_ = std::min(least_, node.degree);
  }
  void take(Vertex v) {
    const Node& node = nodes_[v];
    (node.before == none ? first_[node.degree] : nodes_[node.before].after) = node.after;
    if (node.after != none) nodes_[node.after].before = node.before;
  }
  /// Merges vertex `gone` into `kept`.
  void unite(Vertex kept, Vertex gone) {
    nodes_[kept].size += std::exchange(nodes_[gone].size, 0);
    nodes_[nodes_[kept].last].next = gone;
    nodes_[kept].last = nodes_[gone].last;
  }
  bool is_new(std::vector<std::uint32_t>& stamps, Vertex v) const {
    return std::exchange(stamps[v], now_) != now_;
  }
  const Vertex* list(Vertex v) const { return lists_.data() + nodes_[v].begin; }

  void eliminate(Vertex pivot) {
    take(pivot);
    mark_[pivot] = in_clique_ = ++now_;
    gather(pivot);
    for (const Vertex v : clique_) take(v);
    for (const Vertex v : clique_)  // the part of other elements that is outside the new one
      for (const Vertex* e = list(v); e != list(v) + nodes_[v].elements; ++e) {
        if (!nodes_[*e].is_element) continue;
        if (is_new(seen_, *e)) left_[*e] = nodes_[*e].degree;
        left_[*e] -= nodes_[v].size;
      }
    hashes_.clear();
    for (const Vertex v : clique_) shorten(pivot, v);
    unite_alike();
    std::erase_if(clique_, [&](Vertex v) { return nodes_[v].size == 0; });
    Node& element = nodes_[pivot];
    element.is_element = !clique_.empty();
    element.begin = lists_.size();
    element.elements = static_cast<std::uint32_t>(clique_.size());
    element.degree = weight_;
    lists_.insert(lists_.end(), clique_.begin(), clique_.end());
    for (const Vertex v : clique_) {
      nodes_[v].degree = degree(v);
      put(v);
    }
  }

  /// Fills in clique_ and weight_ with the neighbours of the pivot, and absorbs its elements.
  void gather(Vertex pivot) {
    clique_.clear();
    weight_ = 0;
    const auto add = [&](const Vertex* begin, std::uint32_t count) {
      for (const Vertex* v = begin; v != begin + count; ++v) {
        if (nodes_[*v].size == 0 || !is_new(mark_, *v)) continue;
        clique_.push_back(*v);
        weight_ += nodes_[*v].size;
      }
    };
    const Node& node = nodes_[pivot];
    for (std::uint32_t i = 0; i < node.elements; ++i) {
      const Vertex e = list(pivot)[i];
      if (!std::exchange(nodes_[e].is_element, false)) continue;
      add(list(e), nodes_[e].elements);
    }
    add(list(pivot) + node.elements, node.neighbours);
  }

  /// Reduces the list to the new element, elements with vertices outside it, and neighbours outside
  /// it. A vertex with neither of the last two is eliminated with the pivot.
  void shorten(Vertex pivot, Vertex v) {
    Node& node = nodes_[v];
    Vertex* const begin = lists_.data() + node.begin;
    const Vertex *from = begin, *const middle = begin + node.elements;
    const Vertex* const end = middle + node.neighbours;
    kept_.clear();
    kept_.push_back(pivot);
    std::uint64_t hash = 0;
    for (; from != middle; ++from) {
      if (!nodes_[*from].is_element) continue;
      if (left_[*from] == 0) {
        nodes_[*from].is_element = false;
        continue;
      }
      kept_.push_back(*from);
      hash += *from;
    }
    node.elements = static_cast<std::uint32_t>(kept_.size());
    for (; from != end; ++from) {
      if (nodes_[*from].size == 0 || mark_[*from] == in_clique_) continue;
      kept_.push_back(*from);
      hash += *from;
    }
    node.neighbours = static_cast<std::uint32_t>(kept_.size()) - node.elements;
    std::copy(kept_.begin(), kept_.end(), begin);
    if (kept_.size() == 1) {
      weight_ -= node.size;
      unite(pivot, v);
    } else {
      hashes_.emplace_back(hash << 32U | kept_.size(), v);
    }
  }

  /// Merges vertices with the same lists, comparing only those with the same hash.
  void unite_alike() {
    std::sort(hashes_.begin(), hashes_.end());
    for (std::size_t i = 0; i < hashes_.size(); ++i) {
      const auto [hash, v] = hashes_[i];
      if (nodes_[v].size == 0) continue;
      bool marked = false;
      for (std::size_t j = i + 1; j < hashes_.size() && hashes_[j].first == hash; ++j) {
        const Vertex other = hashes_[j].second;
        const std::uint32_t length = nodes_[v].elements + nodes_[v].neighbours;
        if (nodes_[other].size == 0 || nodes_[other].elements != nodes_[v].elements) continue;
        if (!std::exchange(marked, true)) {
          ++now_;
          for (std::uint32_t k = 0; k < length; ++k) seen_[list(v)[k]] = now_;
        }
        if (std::all_of(list(other), list(other) + length,
                        [&](Vertex u) { return seen_[u] == now_; }))
          unite(v, other);
      }
    }
  }

  /// The degree of a vertex of the new element, which is first in its list. If there is only one
  /// other element, it is disjoint from the neighbours; with more elements, each vertex is counted
  /// once.
  std::uint32_t degree(Vertex v) {
    const Node& node = nodes_[v];
    const Vertex *const begin = list(v), *const middle = begin + node.elements;
    std::uint32_t sum = weight_ - node.size;
    for (const Vertex* u = middle; u != middle + node.neighbours; ++u) sum += nodes_[*u].size;
    if (node.elements == 2) return sum + left_[begin[1]];
    ++now_;
    for (const Vertex* e = begin + 1; e < middle; ++e)
      for (const Vertex* u = list(*e); u != list(*e) + nodes_[*e].elements; ++u)
        if (mark_[*u] != in_clique_ && is_new(seen_, *u)) sum += nodes_[*u].size;
    return sum;
  }

  std::vector<Node> nodes_;
  std::vector<Vertex> first_;  // [degree], the bucket
  std::vector<Vertex> lists_;
  std::vector<std::uint32_t> mark_, seen_;  // [vertex], the last value of now_ to mark it
  std::vector<std::uint32_t> left_;         // [element], see eliminate()
  std::vector<Vertex> clique_, kept_;
  std::vector<std::pair<std::uint64_t, Vertex>> hashes_;
  std::uint32_t now_ = 0, in_clique_ = 0, least_ = 0, weight_ = 0;
};

}  // namespace lean
