#include "ductile/runtime/arrays.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/growing_array.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::arrays_test {
namespace {

/// Memory for which the system has not provided pages yet.
class Mapping {
 public:
  explicit Mapping(std::size_t pages) : bytes_(pages * page) {
    place_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    madvise(place_, bytes_, MADV_NOHUGEPAGE);
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() { munmap(place_, bytes_); }

  std::uint8_t* at(std::size_t byte) const { return static_cast<std::uint8_t*>(place_) + byte; }

  /// [page] 1 if the page is resident.
  std::vector<std::uint8_t> there() const {
    std::vector<std::uint8_t> result(bytes_ / page);
    EXPECT_EQ(mincore(place_, bytes_, result.data()), 0);
    for (std::uint8_t& one : result) one &= 1U;
    return result;
  }
  std::size_t count() const {
    const auto all = there();
    return std::accumulate(all.begin(), all.end(), std::size_t{0});
  }

  static inline const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));

 private:
  std::size_t bytes_;
  void* place_;
};

/// True on Linux since 5.14.
bool system_can() {
  constexpr int populate_write = 23;
  const Mapping one(1);
  return madvise(one.at(0), Mapping::page, populate_write) == 0 || errno != EINVAL;
}

TEST(FreshMemory, GetsThePagesOfAllThatWasAddedAndNoOthers) {
  if (!system_can()) GTEST_SKIP() << "this system cannot provide pages before they are written";
  constexpr std::size_t page_count = 300;
  for (const int threads : {1, 2, 3, 8}) {
    const Mapping memory(page_count);
    FreshMemory fresh;
    fresh.add(memory.at(10 * Mapping::page), 200 * Mapping::page);
    fresh.add(memory.at(250 * Mapping::page + 1), 3 * Mapping::page);
    fresh.add(memory.at(290 * Mapping::page + 7), Mapping::page - 1);  // covers no whole page
    fresh.touch(Executor({.threads = threads}));
    const std::vector<std::uint8_t> there = memory.there();
    for (std::size_t i = 0; i < page_count; ++i)
      EXPECT_EQ(there[i] != 0, (i >= 10 && i < 210) || (i >= 250 && i < 253)) << i;
  }
}

TEST(FreshMemory, GetsThePagesOfZerosBeforeTheyAreRead) {
  if (!system_can()) GTEST_SKIP() << "this system cannot provide pages before they are written";
  GrowingArray<std::uint64_t> without, with;
  without.resize(1000000);
  FreshMemory fresh;
  with.resize(1000000, fresh);
  fresh.touch(Executor({.threads = 2}));
  const bool given_without = !detail::is_fresh(without.data(), without.bytes());
  // Sanitizers replace malloc, which then may have provided the pages.
  EXPECT_TRUE(given_without || !detail::is_fresh(with.data(), with.size() * sizeof(std::uint64_t)));
  EXPECT_EQ(std::count(with.begin(), with.end(), 0U), 1000000);
}

TEST(FreshMemory, KeepsWhatIsThere) {
  std::vector<std::uint32_t> values(1000000);
  std::iota(values.begin(), values.end(), 3U);
  const auto before = values;
  FreshMemory fresh;
  fresh.add(values.data() + 11, (values.size() - 20) * sizeof(values[0]));
  fresh.touch(Executor({.threads = 3}));
  fresh.touch(Executor({.threads = 3}));  // nothing is left to touch
  EXPECT_EQ(values, before);
}

TEST(TouchPages, AsksForManyOfWhichTheLastIsNotThere) {
  if (!system_can()) GTEST_SKIP() << "this system cannot provide pages before they are written";
  const Executor executor({.threads = 2});
  const std::size_t page = Mapping::page;
  const Mapping fresh(1000), few(1000), reused(1000);
  detail::touch_pages(executor, fresh.at(0), 1000 * page);
  EXPECT_EQ(fresh.count(), 1000U);
  detail::touch_pages(executor, few.at(0), 10 * page);
  EXPECT_EQ(few.count(), 0U);
  *reused.at(999 * page) = 1;
  detail::touch_pages(executor, reused.at(0), 1000 * page);
  EXPECT_EQ(reused.count(), 1U);
}

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
  numbers.resize(11, 9);  // the given value is used
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

TEST(GrowFilled, KeepsWhatItHasAndFillsTheRest) {
  for (const int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    UnsetVector<std::uint32_t> array;
    std::size_t before = 0;
    for (const std::size_t n : {0UL, 1UL, 1000UL, 999UL, 40000UL, 40001UL, 300000UL}) {
      grow_filled(executor, array, n, static_cast<std::uint32_t>(7 * n));
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

TEST(GrowFilled, FillsAnewOnceItIsCleared) {
  const Executor executor({.threads = 3});
  auto array = make_filled<std::uint8_t>(executor, 100000, 7);
  const std::uint8_t* const memory = array.data();
  array.clear();
  EXPECT_TRUE(array.empty());
  grow_filled(executor, array, 90000, 5);
  EXPECT_EQ(array.data(), memory);
  EXPECT_EQ(std::count(array.begin(), array.end(), 5), 90000);
}

}  // namespace
}  // namespace ductile::runtime::arrays_test
