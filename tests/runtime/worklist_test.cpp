#include "ductile/runtime/worklist.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"

// The thread sanitizer has its own versions of these functions, which cannot be replaced.
#if !defined(__has_feature)
#define DUCTILE_REPLACES_NEW
#elif !__has_feature(thread_sanitizer)
#define DUCTILE_REPLACES_NEW
#endif
#ifdef DUCTILE_REPLACES_NEW
namespace {
std::atomic<std::size_t> most_bytes = SIZE_MAX;  // for one allocation of an over-aligned type
}

[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  void* const memory =
      bytes > most_bytes ? nullptr : std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif

namespace ductile::runtime::worklist_test {
namespace {

std::uint32_t item(std::size_t i) { return mix32(static_cast<std::uint32_t>(i)) % 50000; }

constexpr int thread_counts[] = {1, 2, 3, 4, 8};

/// Item i is appended item(i) % 4 times.
void append_items(Worklist<std::uint32_t>& list, const Executor& executor, std::size_t n) {
  parallel_for(executor, n, with(list), [](std::size_t i, auto& mine) {
    for (std::uint32_t k = 0; k < item(i) % 4; ++k) mine.append(item(i));
  });
}

std::vector<std::uint32_t> items_in_order(std::size_t n) {
  std::vector<std::uint32_t> items;
  for (std::size_t i = 0; i < n; ++i) items.insert(items.end(), item(i) % 4, item(i));
  return items;
}

void expect_items(const Worklist<std::uint32_t>& list, const std::vector<std::uint32_t>& expected) {
  EXPECT_TRUE(std::ranges::equal(list.items(), expected));
}

TEST(Worklist, HasItemsInTheOrderOfTheLoop) {
  for (const Schedule schedule : {Schedule::automatic, Schedule::omp_dynamic, Schedule::omp_guided,
                                  Schedule::steal_by_signal})
    for (std::size_t n : {0, 1, 100, 30000, 200000})
      for (int threads : thread_counts) {
        const Executor executor({.threads = threads, .schedule = schedule});
        Worklist<std::uint32_t> list(executor);
        for (int round = 0; round < 2; ++round) {
          append_items(list, executor, n);
          list.collect();
          expect_items(list, items_in_order(n));
          list.clear();
        }
      }
}

TEST(Worklist, HasItemsOfOneLoopBeforeThoseOfTheNext) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Worklist<std::uint32_t> list(executor);
    std::vector<std::uint32_t> expected;
    const auto expect_more = [&](const std::vector<std::uint32_t>& more) {
      expected.insert(expected.end(), more.begin(), more.end());
    };
    list.mine().append(7), expect_more({7});
    append_items(list, executor, 20000), expect_more(items_in_order(20000));
    list.mine().append(8), expect_more({8});
    append_items(list, executor, 3), expect_more(items_in_order(3));
    append_items(list, executor, 10000), expect_more(items_in_order(10000));
    list.collect();
    expect_items(list, expected);
    append_items(list, executor, 5000), expect_more(items_in_order(5000));
    list.collect();
    expect_items(list, expected);
    EXPECT_TRUE(std::ranges::equal(list.take(), expected));
    EXPECT_TRUE(list.empty());
  }
}

TEST(Worklist, HasTheSameOrderInEveryFormOfLoop) {
  constexpr std::size_t n = 20000, inner = 10;
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Worklist<std::uint32_t> by_ranges(executor), one_by_one(executor), nested(executor);
    parallel_for_ranges(executor, n, [&](std::size_t begin, std::size_t end) {
      auto mine = by_ranges.mine();
      for (std::size_t i = begin; i < end; ++i)
        for (std::uint32_t k = 0; k < item(i) % 4; ++k) mine.append(item(i));
    });
    parallel_for(executor, n, [&](std::size_t i) {
      for (std::uint32_t k = 0; k < item(i) % 4; ++k) one_by_one.mine().append(item(i));
    });
    parallel_for(executor, n / inner, [&](std::size_t i) {
      parallel_for(executor, inner, with(nested), [&](std::size_t k, auto& mine) {
        const std::size_t place = inner * i + k;
        for (std::uint32_t times = item(place) % 4; times > 0; --times) mine.append(item(place));
      });
    });
    for (auto* list : {&by_ranges, &one_by_one, &nested}) {
      list->collect();
      expect_items(*list, items_in_order(n));
    }
  }
}

TEST(Worklist, BelongsToTheThreadOfALoopAroundIt) {
  const Executor executor({.threads = 4}), alone({.threads = 1});
  parallel_for(executor, 64, [&](std::size_t n) {
    for (const Executor* inner : {&executor, &alone}) {
      Worklist<std::uint32_t> list(*inner);
      append_items(list, *inner, n);
      list.collect();
      expect_items(list, items_in_order(n));
    }
  });
}

TEST(Worklist, RefusesALoopOfAnotherExecutor) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads}), other({.threads = threads + 1});
    Worklist<std::uint32_t> list(executor);
    const auto append = [](std::size_t, auto& mine) { mine.append(1); };
    EXPECT_THROW(parallel_for(other, 1000, with(list), append), std::invalid_argument);
    EXPECT_THROW(parallel_for(other, 1, with(list), append), std::invalid_argument);
    EXPECT_THROW(parallel_for(executor, 1000,
                              [&](std::size_t) { parallel_for(other, 2, with(list), append); }),
                 std::invalid_argument);
    list.collect();
    EXPECT_TRUE(list.empty());
  }
}

TEST(Worklist, LendsAThreadOneAppenderAtATime) {
  const Executor executor({.threads = 2});
  Worklist<std::uint32_t> list(executor);
  const auto append_twice = [&](std::size_t, auto& mine) { mine.append(1), list.mine().append(2); };
  EXPECT_THROW(parallel_for(executor, 100, with(list), append_twice), std::logic_error);
  append_items(list, executor, 100);
}

TEST(Worklist, CanBeClearedAfterALoopThatThrew) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Worklist<std::uint32_t> list(executor);
    const auto append = [](std::size_t i, auto& mine) {
      if (i == 7000) throw std::runtime_error("stop");
      mine.append(item(i));
    };
    EXPECT_THROW(parallel_for(executor, 10000, with(list), append), std::runtime_error);
    list.collect();
    EXPECT_LT(list.size(), 10000U);
    list.clear();
    append_items(list, executor, 1000);
    list.collect();
    expect_items(list, items_in_order(1000));
  }
}

TEST(Worklist, IsSortedAndWithoutDuplicatesOnRequest) {
  for (std::size_t n : {0, 1, 100, 100000}) {
    const std::vector<std::uint32_t> items = items_in_order(n);
    const std::set<std::uint32_t> unique(items.begin(), items.end());
    for (int threads : thread_counts) {
      const Executor executor({.threads = threads});
      Worklist<std::uint32_t> list(executor);
      append_items(list, executor, n);
      list.collect_unique();
      EXPECT_TRUE(std::ranges::equal(list.items(), unique));
      list.mine().append(60000);
      list.mine().append(60000);
      list.collect_unique();
      EXPECT_EQ(list.size(), unique.size() + 1);
    }
  }
}

/// An over-aligned item that knows whether it is intact; counts living objects.
struct alignas(128) Large {
  static inline std::atomic<int> alive = 0;

  explicit Large(std::uint32_t n) : number(n) {
    rest.fill(static_cast<std::uint8_t>(n));
    ++alive;
  }
  Large(Large&& other) noexcept : number(other.number), rest(other.rest) { ++alive; }
  Large& operator=(Large&& other) noexcept = default;
  ~Large() { --alive; }
  bool operator<(const Large& other) const { return number < other.number; }
  bool whole() const {
    return reinterpret_cast<std::uintptr_t>(this) % 128 == 0 &&
           std::all_of(rest.begin(), rest.end(), [&](std::uint8_t byte) {
             return byte == static_cast<std::uint8_t>(number);
           });
  }

  std::uint32_t number;
  std::array<std::uint8_t, 4096> rest;
};

TEST(Worklist, HoldsLargeOverAlignedItems) {
  constexpr std::uint32_t n = 3000;
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Worklist<Large> list(executor);
    for (const bool unique : {false, true}) {
      parallel_for(executor, n, with(list),
                   [](std::size_t i, auto& mine) { mine.append(Large(item(i) % (n / 2))); });
      unique ? list.collect_unique() : list.collect();
      const auto items = list.items();
      EXPECT_TRUE(
          std::all_of(items.begin(), items.end(), [](const Large& l) { return l.whole(); }));
      std::set<std::uint32_t> once;
      for (std::uint32_t i = 0; i < n; ++i) {
        once.insert(item(i) % (n / 2));
        EXPECT_TRUE(unique || items[i].number == item(i) % (n / 2));
      }
      EXPECT_EQ(items.size(), unique ? once.size() : n) << threads;
      EXPECT_EQ(Large::alive, static_cast<int>(items.size()));
      list.clear();
      EXPECT_EQ(Large::alive, 0);
    }
  }
}

#ifdef DUCTILE_REPLACES_NEW
TEST(Worklist, LosesNothingWhenThereIsNoMemory) {
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    Worklist<Large> list(executor);
    const auto fill = [&] {
      parallel_for(executor, 3000, with(list),
                   [](std::size_t i, auto& mine) { mine.append(Large(item(i))); });
    };
    most_bytes = 200 * sizeof(Large);
    EXPECT_THROW(fill(), std::bad_alloc);
    list.clear();
    EXPECT_EQ(Large::alive, 0);
    most_bytes = SIZE_MAX;
    fill();
    list.mine().append(Large(1));
    list.collect();
    EXPECT_EQ(list.size(), 3001U);
    fill();
    most_bytes = 4000 * sizeof(Large);
    EXPECT_THROW(list.collect(), std::bad_alloc);
    EXPECT_EQ(list.size(), 3001U);
    most_bytes = SIZE_MAX;
    list.collect();
    EXPECT_EQ(list.size(), 6001U);
  }
  EXPECT_EQ(Large::alive, 0);
}
#endif

TEST(Worklist, HoldsItemsThatCanOnlyBeMoved) {
  constexpr std::size_t n = 20000;
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Worklist<std::unique_ptr<std::size_t>> list(executor);
    parallel_for(executor, n, with(list),
                 [](std::size_t i, auto& mine) { mine.append(std::make_unique<std::size_t>(i)); });
    list.collect();
    const auto all = list.take();
    ASSERT_EQ(all.size(), n) << threads;
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(*all[i], i);
    list.mine().append(std::make_unique<std::size_t>(6));  // never collected: must not leak
  }
}

}  // namespace
}  // namespace ductile::runtime::worklist_test
