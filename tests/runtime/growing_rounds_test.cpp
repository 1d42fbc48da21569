/// @file
/// Rounds by colours of an operator that makes new items.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::growing_rounds_test {
namespace {

using test::all_items;
using test::thread_counts;
using test::Vertex;

/// Halves what a pile holds and puts it on a new pile, until each holds one.
class Split {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  std::optional<Plan> plan(Vertex pile) const {
    if (size[pile] < 2) return {};
    return pile;
  }
  void conflicts(Vertex pile, auto&& visit) const {
    if (made_by[pile] != pile) visit(made_by[pile]);
    if (last_made[pile] != pile) visit(last_made[pile]);
  }
  std::size_t item_count() const { return size.size(); }
  std::array<std::uint32_t, 1> demand(const Plan&) const { return {1}; }
  std::array<std::uint32_t, 1> grow(std::array<std::uint32_t, 1> count) {
    const auto first = static_cast<Vertex>(size.size());
    for (auto* array : {&size, &made_by, &last_made}) array->resize(first + count[0]);
    std::iota(made_by.begin() + first, made_by.end(), first);
    std::iota(last_made.begin() + first, last_made.end(), first);
    return {first};
  }
  void apply(const Plan& pile, Commit<Split>& commit) {
    const Vertex fresh = commit.fresh();
    size[fresh] = size[pile] / 2;
    size[pile] -= size[fresh];
    if (last_made[pile] != pile) made_by[last_made[pile]] = last_made[pile];
    last_made[pile] = fresh;
    made_by[fresh] = pile;
    commit.wake(pile);
    commit.wake(fresh);
  }
  void commit(std::uint32_t, const Update&) {}

  std::vector<Vertex> size = std::vector<Vertex>(1000, 64);  // [pile]
  std::vector<Vertex> made_by = all_items(1000), last_made = all_items(1000);
};

TEST(RunRounds, WakesNewItemsInTheRoundThatMakesThem) {
  for (const int threads : thread_counts)
    for (const std::size_t window : {0U, 100U}) {
      Split split;
      run_rounds(Executor({.threads = threads}), split, all_items(1000), {.window = window});
      EXPECT_EQ(split.size, std::vector<Vertex>(64000, 1));
    }
  Split split;
  run_rounds_checked(Executor({.threads = 1}), split, all_items(1000));
  EXPECT_EQ(split.size.size(), 64000U);
}

TEST(RunRounds, TakesAnyWindow) {
  for (const std::size_t window : {std::size_t{1}, ~std::size_t{0} - 1, ~std::size_t{0}}) {
    Split split;
    run_rounds(Executor({.threads = 2}), split, all_items(1000), {.window = window});
    EXPECT_EQ(split.size, std::vector<Vertex>(64000, 1));
  }
}

}  // namespace
}  // namespace ductile::runtime::growing_rounds_test
