/// @file
/// Contract: an operator whose conflicts change, and work lists for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::test {

/// Contracts edges of a graph: a vertex of few neighbours is removed, and one of these takes over
/// the others. So conflicts change, and two items without conflict may change the neighbours of a
/// third.
class Contract {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex kept;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  static constexpr bool forgoes_wakes = true;

  explicit Contract(Vertex side)
      : neighbours(std::size_t{side} * side),
        turns(neighbours.size()),
        mutex_of_(std::make_unique<std::mutex[]>(neighbours.size())) {
    for (Vertex v = 0; v < neighbours.size(); ++v) {
      if (v % side + 1 < side) join(v, v + 1);
      if (v + side < neighbours.size()) join(v, v + side);
      if (v % side + 1 < side && v + side < neighbours.size()) join(v, v + side + 1);
    }
  }
  void join(Vertex a, Vertex b) {
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }

  bool plan(Vertex v, Plan& plan, auto& reach) const {
    if (v == throws_at) throw std::runtime_error("plan");
    if (!reach(v)) return false;
    const std::set<Vertex>& around = neighbours[v];
    for (const Vertex other : around)
      if (!reach(other)) return false;
    if (around.empty() || around.size() > 7 || mix32(v) % 3 == 0) return false;
    plan.kept = *std::next(around.begin(), mix32(v) % static_cast<Vertex>(around.size()));
    return true;
  }
  void conflicts(Vertex v, auto&& visit) const {
    for (const Vertex other : neighbours[v]) visit(other);
  }
  std::size_t resource_count() const { return neighbours.size(); }

  void apply(Vertex gone, const Plan& plan, auto& commit) {
    ++turns[gone];
    const std::set<Vertex> around = std::move(neighbours[gone]);
    neighbours[gone].clear();
    for (const Vertex other : around) {
      const std::lock_guard held(mutex_of_[other]);
      neighbours[other].erase(gone);
      if (other == plan.kept) {
        neighbours[other].insert(around.begin(), around.end());
        neighbours[other].erase(plan.kept);
      } else {
        neighbours[other].insert(plan.kept);
        if (other % 4 == 0) commit.wake(other);
      }
    }
    if (postpones_kept) commit.postpone(plan.kept);
    if (wakes_unknown) commit.wake(static_cast<Vertex>(neighbours.size()));
  }

  std::vector<std::set<Vertex>> neighbours;  // [vertex]
  std::vector<int> turns;                    // [vertex], how often it was applied
  Vertex throws_at = ~0U;
  bool postpones_kept = true, wakes_unknown = false;

 private:
  std::unique_ptr<std::mutex[]> mutex_of_;
};

/// Work lists of many and few items, adjacent and scattered, sorted and unsorted.
inline std::vector<std::vector<Vertex>> works(Vertex side) {
  std::vector<std::vector<Vertex>> works{all_items(side * side), {}, {}, {side + 1}};
  for (Vertex v = 0; v < side * side; v += 7) works[1].push_back(v);
  for (Vertex v = 0; v < 100; ++v) works[2].push_back(mix32(v) % (side * side));
  std::sort(works[2].begin(), works[2].end());
  works[2].erase(std::unique(works[2].begin(), works[2].end()), works[2].end());
  std::reverse(works[2].begin(), works[2].end());
  return works;
}

}  // namespace ductile::runtime::test
