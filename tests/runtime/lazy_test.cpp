#include "ductile/runtime/lazy.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::lazy_test {
namespace {

TEST(Lazy, IsMadeOnceHoweverManyThreadsAsk) {
  for (const int threads : {1, 2, 8}) {
    Lazy<std::vector<int>> lazy;
    EXPECT_EQ(lazy.made(), nullptr);
    std::atomic<int> makings = 0;
    std::vector<long> sum_of(5000);
    parallel_for(Executor({.threads = threads}), sum_of.size(), [&](std::size_t i) {
      const std::vector<int>& value = lazy.get([&] {
        ++makings;
        return std::vector<int>(100, 7);
      });
      sum_of[i] = std::accumulate(value.begin(), value.end(), 0L);
    });
    EXPECT_EQ(makings, 1);
    EXPECT_EQ(sum_of, std::vector<long>(sum_of.size(), 700));
    ASSERT_NE(lazy.made(), nullptr);
    EXPECT_EQ(lazy.made()->size(), 100U);
  }
}

TEST(Lazy, IsTriedAgainAfterAnException) {
  Lazy<int> lazy;
  EXPECT_THROW(lazy.get([]() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(lazy.made(), nullptr);
  EXPECT_EQ(lazy.get([] { return 3; }), 3);
  EXPECT_EQ(lazy.get([] { return 4; }), 3);
}

}  // namespace
}  // namespace ductile::runtime::lazy_test
