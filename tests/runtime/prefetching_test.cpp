/// @file
/// Rounds prefetch items ahead of their plans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::prefetching_test {
namespace {

using test::all_items;
using test::Vertex;

/// Plans each item once; notes the stages for which it was prefetched before.
struct AskedAhead {
  using Item = Vertex;
  struct Plan {};
  explicit AskedAhead(Vertex n) : stages(n), planned(n) {}

  bool plan(Vertex v, Plan&, auto& reach) const {
    planned[v] = stages[v];
    return reach(v);
  }
  void apply(Vertex, Plan&, auto&) {}
  std::size_t resource_count() const { return stages.size(); }
  void prefetch(Vertex v, int stage) const { stages[v] |= 1U << static_cast<unsigned>(stage); }

  mutable std::vector<unsigned> stages, planned;  // [vertex], bits
};
struct AskedAheadInTiles : AskedAhead {
  using AskedAhead::AskedAhead;
  void conflicts(Vertex, auto&&) const {}
};

TEST(Prefetching, IsAskedForInAllStages) {
  constexpr Vertex n = 5000;
  const auto asked = [](const AskedAhead& op) {
    return std::count(op.planned.begin(), op.planned.end(), 7U);
  };
  AskedAheadInTiles in_tiles(n);
  run_rounds(Executor({.threads = 1}), in_tiles, all_items(n), {.strategy = Strategy::tiles});
  EXPECT_EQ(asked(in_tiles), n);
  AskedAhead reserving(n);
  run_rounds(Executor({.threads = 1}), reserving, all_items(n),
             {.strategy = Strategy::reservations});
  EXPECT_GT(asked(reserving), n - 64);
}

}  // namespace
}  // namespace ductile::runtime::prefetching_test
