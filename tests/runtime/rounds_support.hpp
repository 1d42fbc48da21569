/// @file
/// What tests of run_rounds share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace ductile::runtime::test {

using Vertex = std::uint32_t;
inline constexpr std::array thread_counts{1, 2, 3, 4, 8};

inline std::vector<Vertex> all_items(std::size_t n) {
  std::vector<Vertex> items(n);
  std::iota(items.begin(), items.end(), 0U);
  return items;
}

/// For operators that prefetch, on one thread: which stages they were asked for, item by item.
class AskedAhead {
 public:
  static constexpr Vertex first = 8;  ///< those before it cannot have been asked for

  explicit AskedAhead(std::size_t n) : stages_(n) {}

  void prefetch(Vertex item, int stage) const {
    EXPECT_TRUE(item < first || stage == 2 || was_asked(item, stage + 1)) << item;
    stages_[item] |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(stage));
  }
  bool was_asked(Vertex item, int stage) const {
    return (stages_[item] >> static_cast<unsigned>(stage) & 1U) != 0;
  }

 private:
  mutable std::vector<std::uint8_t> stages_;  // [item], a bit for each
};

/// The same, but for each time that an item is looked at: what was asked for before its last time
/// does not count, so that each phase of a round is seen alone.
class AskedEachTime {
 public:
  /// Of the n-th looks of all items.
  struct Looks {
    std::size_t all = 0, asked_for = 0;
  };

  explicit AskedEachTime(std::size_t n) : stages_(n) {}

  void prefetch(Vertex item, int stage) const {
    stages_[item] |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(stage));
  }
  void look(Vertex item, int stage, Looks& looks) const {
    ++looks.all;
    looks.asked_for +=
        std::exchange(stages_[item], std::uint8_t{0}) >> static_cast<unsigned>(stage) & 1U;
  }

 private:
  mutable std::vector<std::uint8_t> stages_;  // [item], a bit for each
};

}  // namespace ductile::runtime::test
