#include "ductile/runtime/worklist.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"

namespace ductile::runtime {
namespace {

std::uint32_t item(std::size_t i) { return mix32(static_cast<std::uint32_t>(i)) % 50000; }

std::vector<std::uint32_t> filled(Worklist<std::uint32_t>& list, const Executor& executor,
                                  std::size_t n) {
  parallel_for(executor, n, [&](std::size_t i) {
    list.append(item(i));
    if (i % 97 == 0) list.publish();
  });
  list.collect();
  return {list.items().begin(), list.items().end()};
}

TEST(Worklist, HoldsWhatWasAppendedInAnyOrder) {
  for (std::size_t n : {0, 1, 100, 30000}) {
    std::multiset<std::uint32_t> expected;
    for (std::size_t i = 0; i < n; ++i) expected.insert(item(i));
    for (int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      Worklist<std::uint32_t> list(executor, {.order = WorkOrder::arrival});
      for (int round = 0; round < 3; ++round) {
        const auto items = filled(list, executor, n);
        EXPECT_EQ(std::multiset(items.begin(), items.end()), expected) << threads;
        list.clear();
      }
    }
  }
}

TEST(Worklist, IsSortedAndWithoutDuplicatesOnRequest) {
  for (std::size_t n : {0, 1, 100, 100000}) {
    std::vector<std::uint32_t> sorted(n);
    for (std::size_t i = 0; i < n; ++i) sorted[i] = item(i);
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> unique = sorted;
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    for (int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      Worklist<std::uint32_t> by_item(executor), once(executor, {.unique = true});
      EXPECT_EQ(filled(by_item, executor, n), sorted) << threads;
      EXPECT_EQ(filled(once, executor, n), unique) << threads;
      EXPECT_EQ(once.take(), unique);
      EXPECT_TRUE(once.empty());
    }
  }
}

TEST(Worklist, TakesMoreAfterCollecting) {
  const Executor executor({.threads = 2});
  Worklist<std::uint32_t> list(executor, {.unique = true, .batch = 3});
  for (std::uint32_t i = 0; i < 5000; ++i) list.append(i / 2);
  list.collect();
  EXPECT_EQ(list.size(), 2500U);
  for (std::uint32_t i = 0; i < 5000; ++i) list.append(i);
  list.collect();
  EXPECT_EQ(list.size(), 5000U);
  list.release();
  list.append(3);
  list.collect();
  EXPECT_EQ(list.take(), std::vector<std::uint32_t>{3});
}

TEST(Worklist, SortsItemsThatAreNotNumbers) {
  struct Edge {
    std::uint32_t a, b;
    bool operator<(const Edge& other) const {
      return std::pair(a, b) < std::pair(other.a, other.b);
    }
  };
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    Worklist<Edge> list(executor);
    parallel_for(executor, 100000, [&](std::size_t i) {
      list.append({item(i), static_cast<std::uint32_t>(i)});
    });
    list.collect();
    EXPECT_EQ(list.size(), 100000U);
    EXPECT_TRUE(std::is_sorted(list.items().begin(), list.items().end()));
  }
}

}  // namespace
}  // namespace ductile::runtime
