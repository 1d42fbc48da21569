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

#include "ductile/runtime/hash.hpp"

// The thread sanitizer has these functions itself and lets nobody replace them.
#if !defined(__has_feature)
#define DUCTILE_REPLACES_NEW
#elif !__has_feature(thread_sanitizer)
#define DUCTILE_REPLACES_NEW
#endif
#ifdef DUCTILE_REPLACES_NEW
namespace {
std::atomic<std::size_t> most_bytes = SIZE_MAX;  // that over-aligned types get at once
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

std::vector<std::uint32_t> filled(Worklist<std::uint32_t>& list, const Executor& executor,
                                  std::size_t n) {
  parallel_for(executor, n, [&](std::size_t i) {
    list.append(item(i));
    if (i % 97 == 0) list.publish();
  });
  list.collect();
  return {list.items().begin(), list.items().end()};
}

TEST(Worklist, HoldsWhatWasAppendedInAnyOrder) {
  for (std::size_t n : {0, 1, 100, 30000}) {
    std::multiset<std::uint32_t> expected;
    for (std::size_t i = 0; i < n; ++i) expected.insert(item(i));
    for (int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      Worklist<std::uint32_t> list(executor, {.order = WorkOrder::arrival});
      for (int round = 0; round < 3; ++round) {
        const auto items = filled(list, executor, n);
        EXPECT_EQ(std::multiset(items.begin(), items.end()), expected) << threads;
        list.clear();
      }
    }
  }
}

TEST(Worklist, IsSortedAndWithoutDuplicatesOnRequest) {
  for (std::size_t n : {0, 1, 100, 100000}) {
    std::vector<std::uint32_t> sorted(n);
    for (std::size_t i = 0; i < n; ++i) sorted[i] = item(i);
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> unique = sorted;
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    for (int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      Worklist<std::uint32_t> by_item(executor), once(executor, {.unique = true});
      EXPECT_EQ(filled(by_item, executor, n), sorted) << threads;
      EXPECT_EQ(filled(once, executor, n), unique) << threads;
      EXPECT_TRUE(std::ranges::equal(once.take(), unique));
      EXPECT_TRUE(once.empty());
    }
  }
}

TEST(Worklist, TakesMoreAfterCollecting) {
  const Executor executor({.threads = 2});
  Worklist<std::uint32_t> list(executor, {.unique = true, .batch = 3});
  for (std::uint32_t i = 0; i < 5000; ++i) list.append(i / 2);
  list.collect();
  EXPECT_EQ(list.size(), 2500U);
  for (std::uint32_t i = 0; i < 5000; ++i) list.append(i);
  list.collect();
  EXPECT_EQ(list.size(), 5000U);
  list.release();
  list.append(3);
  list.collect();
  EXPECT_EQ(list.take(), UnsetVector<std::uint32_t>{3});
}

TEST(Worklist, SortsItemsThatAreNotNumbers) {
  struct Edge {
    std::uint32_t a, b;
    bool operator<(const Edge& other) const {
      return std::pair(a, b) < std::pair(other.a, other.b);
    }
  };
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    Worklist<Edge> list(executor);
    parallel_for(executor, 100000, [&](std::size_t i) {
      list.append({item(i), static_cast<std::uint32_t>(i)});
    });
    list.collect();
    EXPECT_EQ(list.size(), 100000U);
    EXPECT_TRUE(std::is_sorted(list.items().begin(), list.items().end()));
  }
}

/// Knows where it lives; counts those that live.
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
  for (int threads : {1, 2, 3, 8}) {
    for (const bool unique : {false, true}) {
      const Executor executor({.threads = threads});
      Worklist<Large> list(executor, {.unique = unique});
      for (int round = 0; round < 2; ++round) {
        parallel_for(executor, n, [&](std::size_t i) {
          list.append(Large(item(i) % (n / 2)));
          if (i % 97 == 0) list.publish();
        });
        list.collect();
        const auto items = list.items();
        EXPECT_TRUE(
            std::all_of(items.begin(), items.end(), [](const Large& l) { return l.whole(); }));
        EXPECT_TRUE(std::is_sorted(items.begin(), items.end()));
        std::multiset<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < n; ++i) expected.insert(item(i) % (n / 2));
        const std::set<std::uint32_t> once(expected.begin(), expected.end());
        EXPECT_EQ(items.size(), unique ? once.size() : expected.size()) << threads;
        EXPECT_EQ(Large::alive, static_cast<int>(items.size()));
        list.clear();
        EXPECT_EQ(Large::alive, 0);
      }
    }
  }
}

#ifdef DUCTILE_REPLACES_NEW
TEST(Worklist, LosesNoMemoryWhenThereIsNone) {
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    Worklist<Large> list(executor, {.order = WorkOrder::arrival});
    const auto fill = [&] {
      parallel_for(executor, 3000, [&](std::size_t i) { list.append(Large(item(i))); });
      list.collect();
    };
    most_bytes = 200 * sizeof(Large);
    EXPECT_THROW(fill(), std::bad_alloc);
    EXPECT_GT(Large::alive, 0);
    EXPECT_THROW(list.collect(), std::bad_alloc);
    list.clear();
    EXPECT_EQ(Large::alive, 0);
    most_bytes = SIZE_MAX;
    fill();
    EXPECT_EQ(list.size(), 3000U);
    most_bytes = 3500 * sizeof(Large);
    EXPECT_THROW(fill(), std::bad_alloc);  // 6000 of them
    most_bytes = SIZE_MAX;
    list.release();
    EXPECT_EQ(Large::alive, 0);
  }
}
#endif

TEST(Worklist, HoldsItemsThatCanOnlyBeMoved) {
  constexpr std::size_t n = 20000;
  for (int threads : {1, 2, 3, 8}) {
    const Executor executor({.threads = threads});
    Worklist<std::unique_ptr<std::size_t>> list(executor, {.order = WorkOrder::arrival});
    UnsetVector<std::unique_ptr<std::size_t>> all;
    for (int round = 0; round < 2; ++round) {
      parallel_for(executor, n,
                   [&](std::size_t i) { list.append(std::make_unique<std::size_t>(i)); });
      list.collect();
      all = list.take();
      EXPECT_TRUE(list.empty());
      std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return *a < *b; });
      ASSERT_EQ(all.size(), n) << threads;
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(*all[i], i);
      list.append(std::move(all[3]));
      list.collect();
      list.append(std::move(all[4]));
      list.clear();
    }
    list.append(std::move(all[5]));
    list.release();
    EXPECT_TRUE(list.empty());
    list.append(std::move(all[6]));  // never collected: must not leak
  }
}

TEST(Worklist, SortsItemsThatCanOnlyBeMoved) {
  struct Task {
    explicit Task(std::uint32_t n) : number(std::make_unique<std::uint32_t>(n)) {}
    bool operator<(const Task& other) const { return *number < *other.number; }
    std::unique_ptr<std::uint32_t> number;
  };
  std::set<std::uint32_t> numbers;
  for (std::size_t i = 0; i < 30000; ++i) numbers.insert(item(i));
  const std::vector<std::uint32_t> expected(numbers.begin(), numbers.end());
  for (int threads : {1, 2, 3, 8}) {
    const Executor executor({.threads = threads});
    Worklist<Task> list(executor, {.unique = true});
    parallel_for(executor, 30000, [&](std::size_t i) { list.append(Task(item(i))); });
    list.collect();
    std::vector<std::uint32_t> got;
    for (const Task& task : list.items()) got.push_back(*task.number);
    EXPECT_EQ(got, expected) << threads;
  }
}

TEST(Worklist, SaysThatItCannotSortWhatHasNoOrder) {
  struct Thing {
    int value;
  };
  const Executor executor({.threads = 2});
  EXPECT_THROW(Worklist<Thing>{executor}, std::invalid_argument);
  Worklist<Thing> list(executor, {.order = WorkOrder::arrival});
  list.append({3});
  list.collect();
  EXPECT_EQ(list.items().front().value, 3);
}

}  // namespace
}  // namespace ductile::runtime::worklist_test
