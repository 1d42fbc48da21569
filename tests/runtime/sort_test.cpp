#include "ductile/runtime/sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "ductile/runtime/hash.hpp"

namespace ductile::runtime::sort_test {
namespace {

template <class T>
class ParallelSort : public testing::Test {};
using Types =
    testing::Types<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t, std::int64_t>;
TYPED_TEST_SUITE(ParallelSort, Types);

TYPED_TEST(ParallelSort, AgreesWithTheStandardOne) {
  for (std::size_t n : {0, 1, 2, 1000, 1024, 10000, 32768, 32769, 150000}) {
    std::vector<TypeParam> values(n);
    for (std::size_t i = 0; i < n; ++i)
      values[i] = static_cast<TypeParam>(mix64(i) >> (i % 3 == 0 ? 40U : 0U));
    std::vector<TypeParam> expected = values;
    std::sort(expected.begin(), expected.end());
    for (int threads : {1, 2, 3, 8, 64}) {
      std::vector<TypeParam> sorted = values;
      parallel_sort(Executor({.threads = threads}), std::span(sorted));
      EXPECT_EQ(sorted, expected) << n << " values, " << threads << " threads";
    }
  }
}

TEST(ParallelSort, SortsCharacters) {
  std::u32string text(5000, U' ');
  for (std::size_t i = 0; i < text.size(); ++i)
    text[i] = static_cast<char32_t>(mix32(static_cast<std::uint32_t>(i)));
  std::u32string expected = text;
  std::sort(expected.begin(), expected.end());
  parallel_sort(Executor({.threads = 2}), std::span(text));
  EXPECT_EQ(text, expected);
}

TEST(ParallelSort, SortsNumbersThatAreAllThere) {
  // Their digits begin powers of two apart, so whole cache lines are written at once.
  for (const std::size_t n : {131072U, 262144U, 300007U}) {
    std::vector<std::uint64_t> expected(n), values(n);
    std::iota(expected.begin(), expected.end(), 0U);
    for (const std::size_t stride : {1U, 7U, 40961U}) {
      for (std::size_t i = 0; i < n; ++i) values[i] = (i * stride % n) ^ (n % 2 == 0 ? 1U : 0U);
      for (int threads : {1, 2, 3, 8}) {
        const Executor executor({.threads = threads});
        std::vector<std::uint64_t> sorted = values;
        parallel_sort(executor, std::span(sorted));
        EXPECT_EQ(sorted, expected) << n << " values, stride " << stride;
        std::vector<std::uint32_t> narrow(values.begin(), values.end());
        parallel_sort(executor, std::span(narrow));
        EXPECT_TRUE(std::equal(narrow.begin(), narrow.end(), expected.begin()));
      }
    }
  }
}

TEST(ParallelSort, KeepsWordsOfTheSameUpperBitsInOrder) {
  for (const std::size_t n : {0U, 1U, 5000U, 32768U, 150000U}) {
    std::vector<std::uint64_t> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = mix64(i % 1000);
    for (const unsigned low : {0U, 20U, 60U}) {
      std::vector<std::uint64_t> expected = values;
      std::stable_sort(expected.begin(), expected.end(),
                       [low](auto a, auto b) { return a >> low < b >> low; });
      for (int threads : {1, 2, 3, 8, 64}) {
        std::vector<std::uint64_t> sorted = values;
        parallel_sort_above(Executor({.threads = threads}), std::span(sorted), low);
        EXPECT_EQ(sorted, expected) << n << " values, bit " << low << ", " << threads;
      }
    }
  }
}

TEST(ParallelSort, SortsWhatHasFewKeysOrOneOfMany) {
  const std::size_t n = 100000;
  for (const std::uint32_t keys : {1U, 2U, 50U})
    for (const bool greatest : {false, true}) {
      std::vector<std::uint32_t> values(n);
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t often = greatest ? ~0U : 1000U;
        values[i] = i % 3 != 0 ? often : mix32(i % (3 * keys));
      }
      std::vector<std::uint32_t> expected = values;
      std::sort(expected.begin(), expected.end());
      for (int threads : {2, 3, 4, 8, 64}) {
        std::vector<std::uint32_t> sorted = values;
        parallel_sort(Executor({.threads = threads}), std::span(sorted));
        EXPECT_EQ(sorted, expected) << keys << " keys, " << threads << " threads";
      }
    }
}

TEST(ParallelSort, SeesWhatIsOutOfOrderBetweenBlocks) {
  for (std::size_t at : {1U, 8191U, 8192U, 8193U, 16384U, 19999U}) {
    std::vector<std::uint32_t> values(20000);
    std::iota(values.begin(), values.end(), 0U);
    std::swap(values[at - 1], values[at]);
    parallel_sort(Executor({.threads = 3}), std::span(values));
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end())) << at;
  }
}

TEST(ParallelUnique, AgreesWithTheStandardOne) {
  for (std::size_t n : {0, 1, 1000, 32768, 32769, 200000})
    for (std::uint32_t repeat : {1U, 3U, 100000U}) {
      std::vector<std::uint32_t> values(n);
      for (std::uint32_t i = 0; i < n; ++i) values[i] = i / repeat;
      std::vector<std::uint32_t> expected = values;
      expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
      for (int threads : {1, 2, 8}) {
        std::vector<std::uint32_t> unique = values;
        unique.resize(parallel_unique(Executor({.threads = threads}), std::span(unique)));
        EXPECT_EQ(unique, expected) << n << " values, " << threads << " threads";
      }
    }
}

}  // namespace
}  // namespace ductile::runtime::sort_test
