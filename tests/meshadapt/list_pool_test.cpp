#include "mesh/list_pool.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt::list_pool_test {
namespace {

const runtime::Executor executor({.threads = 2});

TEST(ListPool, BehavesLikeSortedSets) {
  constexpr std::uint32_t lists = 50;
  ListPool<std::uint32_t> pool;
  std::vector<std::set<std::uint32_t>> expected(lists);
  pool.reset(executor, lists);
  std::mt19937 random(1);
  for (int step = 0; step < 50000; ++step) {
    const std::uint32_t list = random() % lists, value = random() % 200;
    const auto action = random() % 100;
    if (action == 0) {
      pool.clear(list);
      expected[list].clear();
    } else if (action < 55) {
      if (expected[list].insert(value).second) pool.insert(list, value);
    } else if (expected[list].erase(value) == 1) {
      pool.erase(list, value);
    }
    if (step % 97 == 0) pool.reserve(list, 10);
  }
  for (std::uint32_t i = 0; i < lists; ++i)
    EXPECT_TRUE(
        std::equal(pool.of(i).begin(), pool.of(i).end(), expected[i].begin(), expected[i].end()));
}

TEST(ListPool, ReplacesValuesByOthers) {
  ListPool<std::uint32_t> pool;
  std::set<std::uint32_t> expected;
  pool.reset(executor, 1);
  std::mt19937 random(2);
  for (int step = 0; step < 2000; ++step) {
    std::vector<std::uint32_t> gone, come;
    const std::uint32_t wanted = random() % 40;
    for (std::uint32_t value = 0; value < 100; ++value) {
      if (random() % 2 == 0) continue;
      if (expected.count(value) != 0)
        gone.push_back(value);
      else if (random() % 40 < wanted)
        come.push_back(value);
    }
    for (const std::uint32_t value : gone) expected.erase(value);
    expected.insert(come.begin(), come.end());
    pool.replace(0, gone, come);
    const auto list = pool.of(0);
    ASSERT_TRUE(std::equal(list.begin(), list.end(), expected.begin(), expected.end())) << step;
  }
}

TEST(ListPool, ManyThreadsChangeAListThatTheyHold) {
  const runtime::Executor many({.threads = 4});
  constexpr std::uint32_t lists = 3, values = 3000;
  ListPool<std::uint32_t> pool;
  pool.reset(many, lists);
  for (std::uint32_t list = 0; list < lists; ++list)
    for (std::uint32_t value = 0; value < values; value += 2) pool.insert(list, value);
  runtime::parallel_for(many, values,
                        [&](std::size_t i) {
                          const auto value = static_cast<std::uint32_t>(i);
                          for (std::uint32_t list = 0; list < lists; ++list) {
                            const auto held = pool.hold(list);
                            if (value % 2 == 0)
                              pool.erase(list, value);
                            else
                              pool.insert(list, value);
                          }
                        },
                        {.grain = 1});
  for (std::uint32_t list = 0; list < lists; ++list) {
    ASSERT_EQ(pool.of(list).size(), values / 2);
    for (std::uint32_t i = 0; i < values / 2; ++i) ASSERT_EQ(pool.of(list)[i], 2 * i + 1);
  }
}

TEST(ListPool, GrowsAndForgets) {
  ListPool<std::uint32_t> pool;
  pool.reset(executor, 2);
  pool.insert(1, 7);
  runtime::FreshMemory fresh;
  pool.grow(4, fresh);
  fresh.touch(executor);
  EXPECT_EQ(pool.size(), 4U);
  EXPECT_EQ(pool.of(1).size(), 1U);
  EXPECT_TRUE(pool.of(3).empty());
  for (const std::uint32_t lists :
       {3U, 50000U, 100U}) {  // on one thread, on all, fewer than before
    pool.reset(executor, lists);
    ASSERT_EQ(pool.size(), lists);
    for (std::uint32_t i = 0; i < lists; ++i) {
      ASSERT_TRUE(pool.of(i).empty()) << i;
      pool.insert(i, i);
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::list_pool_test
