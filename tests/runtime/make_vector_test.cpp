#include "ductile/runtime/make_vector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace ductile::runtime::make_vector_test {
namespace {

TEST(MakeVector, HoldsZeros) {
  for (const int threads : {1, 2, 8})
    for (const std::size_t n : {0UL, 1UL, 1000UL, 300001UL}) {
      const auto numbers = make_vector<std::uint32_t>(Executor({.threads = threads}), n);
      EXPECT_EQ(numbers.size(), n);
      EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 0U), static_cast<std::ptrdiff_t>(n));
    }
}

TEST(MakeVector, HoldsDefaultValues) {
  const auto names = make_vector<std::string>(Executor({.threads = 3}), 50000);
  EXPECT_EQ(std::count(names.begin(), names.end(), ""), 50000);
}

TEST(MakeVector, ForgetsWhatMemoryHeld) {
  const Executor executor({.threads = 3});
  std::vector<std::uint64_t> values(200000, 7);
  values.clear();
  resize_empty(executor, EmptyVector{values, 100000});
  EXPECT_EQ(std::count(values.begin(), values.end(), 0U), 100000);
}

}  // namespace
}  // namespace ductile::runtime::make_vector_test
