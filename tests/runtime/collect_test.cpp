#include "ductile/runtime/worklist.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::collect_test {
namespace {

/// Number of items found at i, 0 to 3 by its hash.
std::uint32_t finds(std::size_t i) { return mix32(static_cast<std::uint32_t>(i)) % 4; }

TEST(ParallelCollect, KeepsTheOrderOfIndicesOnAnyNumberOfThreads) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{17}, std::size_t{100000}})
    for (const int threads : test::thread_counts) {
      UnsetVector<std::size_t> expected;
      for (std::size_t i = 0; i < n; ++i) expected.insert(expected.end(), finds(i), i);
      const auto all = parallel_collect<std::size_t>(Executor({.threads = threads}), n,
                                                     [](std::size_t i, auto&& append) {
                                                       for (std::uint32_t k = 0; k < finds(i); ++k)
                                                         append(i);
                                                     });
      EXPECT_EQ(all, expected) << n << " on " << threads << " threads";
    }
}

TEST(ParallelCollect, MovesWhatCanOnlyBeMoved) {
  const auto all = parallel_collect<std::unique_ptr<std::size_t>>(
      Executor({.threads = 4}), 5000,
      [](std::size_t i, auto&& append) { append(std::make_unique<std::size_t>(i)); });
  ASSERT_EQ(all.size(), 5000U);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(*all[i], i);
}

TEST(ParallelCollect, WorksInsideALoop) {
  const Executor executor({.threads = 4});
  std::vector<std::size_t> found(64);
  parallel_for(executor, found.size(), [&](std::size_t i) {
    const auto all =
        parallel_collect<std::size_t>(executor, 1000, [&](std::size_t k, auto&& append) {
          if (k % (i + 1) == 0) append(k);
        });
    found[i] = all.size();
  });
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], (1000 + i) / (i + 1));
}

TEST(ParallelCollect, PassesOnWhatIsThrown) {
  const auto throwing = [](std::size_t i, auto&& append) {
    if (i == 700) throw std::runtime_error("found it");
    append(i);
  };
  EXPECT_THROW(parallel_collect<std::size_t>(Executor({.threads = 3}), 10000, throwing),
               std::runtime_error);
}

}  // namespace
}  // namespace ductile::runtime::collect_test
