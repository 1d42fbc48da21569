#include "ductile/runtime/disjoint_sets.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace ductile::runtime::disjoint_sets_test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// [number], the lowest of its set, by giving all of a set the lower of two names over and over.
std::vector<std::uint32_t> lowest_of(std::size_t n, const Pairs& pairs) {
  std::vector<std::uint32_t> name(n);
  std::iota(name.begin(), name.end(), 0U);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : pairs) {
      const std::uint32_t low = std::min(name[a], name[b]);
      changed = changed || name[a] != name[b];
      name[a] = name[b] = low;
    }
  }
  return name;
}

TEST(DisjointSets, AreNamedByTheirLowestNumberAtEveryThreadCount) {
  std::mt19937 random(7);
  for (const std::size_t n : {1U, 10U, 3000U}) {
    Pairs pairs(n / 2 + n / 5);
    for (auto& [a, b] : pairs) {
      a = static_cast<std::uint32_t>(random() % n);
      b = static_cast<std::uint32_t>(random() % n);
    }
    const auto expected = lowest_of(n, pairs);
    for (const int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      DisjointSets sets(executor, n);
      ASSERT_EQ(sets.size(), n);
      parallel_for(executor, pairs.size(),
                   [&](std::size_t i) { sets.unite(pairs[i].first, pairs[i].second); });
      for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(sets.lowest(i), expected[i]) << i;
    }
  }
}

TEST(DisjointSets, OfOneLongChainAreOne) {
  const std::uint32_t n = 100000;
  const Executor executor({.threads = 4});
  DisjointSets sets(executor, n);
  parallel_for(executor, n - 1, [&](std::size_t i) {
    const auto at = static_cast<std::uint32_t>(n - 1 - i);
    sets.unite(at, at - 1);
  });
  for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(sets.lowest(i), 0U);
}

}  // namespace
}  // namespace ductile::runtime::disjoint_sets_test
