#include "mesh/grouping.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "support/metrics.hpp"

namespace ductile::meshadapt::grouping_test {
namespace {

using Items = std::vector<std::vector<std::uint32_t>>;  // [item], its keys

/// Items with up to four keys each, sorted by the first, or in random order.
Items random_items(test::Random& random, std::size_t count, std::uint32_t keys, bool in_order) {
  Items items(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(in_order ? i * keys / count : random() % keys);
    for (std::size_t k = random() % 5; k > 0; --k)
      items[i].push_back(std::min(keys - 1, first + static_cast<std::uint32_t>(random() % 90)));
  }
  return items;
}

/// [key] Its items, in order.
Items grouped(const Items& items, std::uint32_t keys, int threads) {
  const runtime::Executor executor({.threads = threads});
  std::vector<std::uint32_t> count_of(keys, 7);  // must be overwritten
  Grouping grouping(executor, GroupingBounds::even(executor, items.size(), keys), count_of,
                    [&items](std::uint32_t item, auto&& visit) {
                      for (const std::uint32_t key : items[item]) visit(key);
                    });
  Items items_of(keys);
  std::vector<std::uint32_t> before_of(keys);
  grouping.visit(
      [&](std::uint32_t begin, std::uint32_t end, std::uint32_t before) {
        for (std::uint32_t key = begin; key < end; ++key) {
          before_of[key] = before;
          before += count_of[key];
        }
      },
      [&](std::uint32_t key, std::uint32_t item) { items_of[key].push_back(item); });
  std::uint32_t before = 0;
  for (std::uint32_t key = 0; key < keys; ++key) {
    EXPECT_EQ(count_of[key], items_of[key].size());
    EXPECT_EQ(before_of[key], before);
    before += count_of[key];
  }
  EXPECT_EQ(grouping.size(), before);
  return items_of;
}

TEST(Grouping, IsTheSameAsOneItemAfterTheOther) {
  test::Random random(5);
  for (const std::size_t count : {0, 1, 3000, 50000})
    for (const std::uint32_t keys : {1U, 100U, 9000U})
      for (const bool in_order : {false, true}) {
        const Items items = random_items(random, count, keys, in_order);
        Items expected(keys);
        for (std::uint32_t item = 0; item < count; ++item)
          for (const std::uint32_t key : items[item]) expected[key].push_back(item);
        for (const int threads : {1, 2, 3, 8}) EXPECT_EQ(grouped(items, keys, threads), expected);
      }
}

TEST(Grouping, SaysThatItCannotCountSoMuch) {
  const runtime::Executor executor({.threads = 2});
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  EXPECT_EQ(GroupingBounds::even(executor, most, most).items.back(), most);
  EXPECT_THROW(GroupingBounds::even(executor, most + 1, 1), std::length_error);
  EXPECT_THROW(GroupingBounds::even(executor, 1, most + 1), std::length_error);
}

}  // namespace
}  // namespace ductile::meshadapt::grouping_test
