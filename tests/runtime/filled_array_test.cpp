#include "ductile/runtime/detail/filled_array.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace ductile::runtime::detail {
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

}  // namespace
}  // namespace ductile::runtime::detail
