#include "ductile/runtime/growing_array.hpp"

#include <gtest/gtest.h>
#ifdef __linux__
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::growing_array_test {
namespace {

struct Pair {
  std::uint32_t a, b;
  friend bool operator==(const Pair&, const Pair&) = default;
};

TEST(GrowingArray, IsLikeAVectorOfZeros) {
  std::mt19937 random(3);
  GrowingArray<Pair> array;
  std::vector<Pair> expected;
  for (int step = 0; step < 300; ++step) {
    // Some of them no longer small.
    const std::size_t n = random() % 2 == 0 ? random() % 150000 : expected.size() + random() % 2000;
    array.resize(n);
    expected.resize(n);
    ASSERT_TRUE(std::equal(array.begin(), array.end(), expected.begin(), expected.end())) << step;
    for (std::size_t i = step % 3; i < n; i += 3)
      array[i] = expected[i] = {static_cast<std::uint32_t>(random()), 1};
  }
}

TEST(GrowingArray, IsWrittenByAllThreadsAfterItGrew) {
  const Executor executor({.threads = 8});
  GrowingArray<std::uint64_t> array;
  for (const std::size_t n : {1000UL, 100000UL, 1000000UL}) {
    array.resize(n);
    parallel_for(executor, n, [&](std::size_t i) { array[i] += i; });
  }
  for (std::size_t i = 0; i < array.size(); ++i)
    ASSERT_EQ(array[i], i * (i < 1000 ? 3 : i < 100000 ? 2 : 1));
}

/// The array grows from one page to many times the reserve behind it.
TEST(GrowingArray, KeepsWhatItHoldsWhereItsPagesAreAskedFor) {
  const Executor executor({.threads = 3});
  GrowingArray<std::uint32_t> array;
  for (std::size_t n = 100; n < 3000000; n += n / 3) {
    const std::size_t before = array.size();
    FreshMemory fresh;
    array.resize_for_overwrite(n, fresh);
    fresh.touch(executor);
    for (std::size_t i = before; i < n; ++i) array[i] = static_cast<std::uint32_t>(3 * i);
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(array[i], 3 * i) << n;
  }
}

#ifdef __linux__
/// Makes the system refuse to move pages, unless it ignores such filters.
void forbid_moving_pages() {
  std::array<sock_filter, 4> filter = {
      {{BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
       {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, SYS_mremap},
       {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ERRNO | EFAULT},
       {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW}}};
  const sock_fprog program = {filter.size(), filter.data()};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0);
}

/// Linux before 6.17 could not move pages of several mappings.
TEST(GrowingArray, KeepsWhatItHoldsWherePagesCannotBeMoved) {
  const auto grow = [] {
    forbid_moving_pages();
    GrowingArray<std::uint64_t> array;
    for (const std::size_t n : {20000UL, 1000000UL, 2000000UL}) {  // to more than is held free
      const std::size_t before = array.size();
      array.resize(n);
      for (std::size_t i = before; i < n; ++i) array[i] += 3 * i;
      for (std::size_t i = 0; i < n; ++i)
        if (array[i] != 3 * i) std::exit(1);
    }
    std::exit(0);
  };
  EXPECT_EXIT(grow(), testing::ExitedWithCode(0), "");
}
#endif

TEST(GrowingArray, GivesItsElementsAwayWhenMoved) {
  GrowingArray<int> a;
  a.resize(10);
  a[3] = 7;
  GrowingArray<int> b(std::move(a));
  EXPECT_EQ(b.size(), 10U);
  EXPECT_EQ(b[3], 7);
  GrowingArray<int> c;
  c.resize(5000);
  c = std::move(b);
  EXPECT_EQ(c.size(), 10U);
  EXPECT_EQ(c[3], 7);
}

TEST(GrowingArray, IsEmptyAndGrowsAnewAfterItsRelease) {
  for (const int threads : {1, 3})
    for (const std::size_t n : {0U, 10U, 1000000U}) {
      GrowingArray<std::uint64_t> array;
      array.resize(n);
      for (std::uint64_t& value : array) value = 7;
      array.release(Executor({.threads = threads}));
      EXPECT_EQ(array.size(), 0U);
      EXPECT_EQ(array.bytes(), 0U);
      array.resize(n + 5);
      EXPECT_EQ(std::count(array.begin(), array.end(), 0U), static_cast<std::ptrdiff_t>(n + 5));
    }
}

TEST(SpentMemory, TakesWhatArraysOfAnySizeLeave) {
  for (const int threads : {1, 2, 8}) {
    SpentMemory spent;
    std::vector<GrowingArray<std::uint32_t>> arrays(5);
    for (int turn = 0; turn < 2; ++turn) {
      for (std::size_t a = 0; a < arrays.size(); ++a) {
        arrays[a].resize(std::array{0U, 10U, 100000U, 1000000U, 3000001U}[a]);
        for (std::uint32_t& value : arrays[a]) value = 7;
        arrays[a].release(spent);
        EXPECT_EQ(arrays[a].size(), 0U);
        EXPECT_EQ(arrays[a].bytes(), 0U);
      }
      spent.give_back(Executor({.threads = threads}));
    }
    for (auto& array : arrays) {
      array.resize(1000);
      EXPECT_EQ(std::count(array.begin(), array.end(), 0U), 1000);
    }
  }
}

TEST(GrowingArray, StaysAsItIsWhereAskedForTooMuch) {
  GrowingArray<std::uint64_t> array;
  array.resize(100);
  array[99] = 5;
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  for (const std::size_t n : {most / 10, most / 8 + 1, most})
    EXPECT_THROW(array.resize(n), std::bad_alloc);
  EXPECT_EQ(array.size(), 100U);
  EXPECT_EQ(array[99], 5U);
}

}  // namespace
}  // namespace ductile::runtime::growing_array_test
