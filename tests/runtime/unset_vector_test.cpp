#include "ductile/runtime/unset_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::unset_vector_test {
namespace {

struct Counted {
  static inline int made = 0;
  Counted() { ++made; }
  std::uint32_t value = 3;
};

TEST(UnsetVector, MakesNothingOfWhatIsTriviallyCopyable) {
  UnsetVector<Counted> values;
  values.resize(1000);
  EXPECT_EQ(Counted::made, 0);
  EXPECT_EQ(values.size(), 1000U);
  UnsetVector<std::uint32_t> numbers(10, 7);
  numbers.resize(11, 9);  // a value that is given counts
  EXPECT_EQ(numbers.front(), 7U);
  EXPECT_EQ(numbers.back(), 9U);
}

TEST(UnsetVector, ConstructsAllElse) {
  UnsetVector<std::string> names(3);
  EXPECT_EQ(names, UnsetVector<std::string>(3, ""));
  UnsetVector<std::unique_ptr<int>> owned(2);
  EXPECT_EQ(owned[1], nullptr);
}

TEST(UnsetVector, KeepsItsElementsWhenItGrows) {
  UnsetVector<std::uint64_t> numbers;
  for (std::uint64_t i = 0; i < 5000; ++i) numbers.push_back(i * i);
  const UnsetVector<std::uint64_t> copy = numbers;
  ASSERT_EQ(copy.size(), 5000U);
  for (std::uint64_t i = 0; i < 5000; ++i) EXPECT_EQ(copy[i], i * i);
}

TEST(UnsetVector, IsMadeForAllThreadsToFill) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3000000}}) {
    const Executor executor({.threads = 3});
    auto numbers = make_unset_vector<std::uint32_t>(executor, n);
    ASSERT_EQ(numbers.size(), n);
    parallel_for(executor, n, [&](std::size_t i) { numbers[i] = static_cast<std::uint32_t>(i); });
    for (std::size_t i = 0; i < n; i += 1000) ASSERT_EQ(numbers[i], i);
  }
}

}  // namespace
}  // namespace ductile::runtime::unset_vector_test
