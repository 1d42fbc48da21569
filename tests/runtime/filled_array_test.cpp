#include "ductile/runtime/filled_array.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace ductile::runtime::filled_array_test {
namespace {

TEST(FilledArray, KeepsWhatItHasAndFillsTheRest) {
  for (const int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    FilledArray<std::uint32_t> array;
    std::size_t before = 0;
    for (const std::size_t n : {0UL, 1UL, 1000UL, 999UL, 40000UL, 40001UL, 300000UL}) {
      array.resize(executor, n, static_cast<std::uint32_t>(7 * n));
      ASSERT_EQ(array.size(), std::max(before, n));
      for (std::size_t i = 0; i < array.size(); ++i) {
        const auto expected = i < before ? i : 7 * n;
        ASSERT_EQ(array[i], expected) << i << " of " << n;
        array[i] = static_cast<std::uint32_t>(i);
      }
      before = array.size();
    }
  }
}

TEST(FilledArray, FillsAnewOnceItIsCleared) {
  const Executor executor({.threads = 3});
  FilledArray<std::uint8_t> array(executor, 100000, 7);
  const std::uint8_t* const memory = array.data();
  array.clear();
  EXPECT_TRUE(array.empty());
  array.resize(executor, 90000, 5);
  EXPECT_EQ(array.data(), memory);
  EXPECT_EQ(std::count(array.begin(), array.end(), 5), 90000);
}

TEST(FilledArray, MovesItsElementsAndLeavesNone) {
  const Executor executor({.threads = 2});
  FilledArray<int> from(executor, 10, 3), to(executor, 5, 4);
  to = std::move(from);
  EXPECT_EQ(std::count(to.begin(), to.end(), 3), 10);
  const FilledArray<int> last(std::move(to));
  EXPECT_EQ(last.size(), 10U);
  // What is left of them is what is tested here. NOLINTNEXTLINE(bugprone-use-after-move)
  for (const auto* array : {&from, &to}) EXPECT_TRUE(array->empty());
}

}  // namespace
}  // namespace ductile::runtime::filled_array_test
