#include "ductile/runtime/deferred_update.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"

namespace ductile::runtime::deferred_update_test {
namespace {

using History = std::vector<std::vector<std::uint64_t>>;  // [owner], updates as committed

/// Source s defers s % 5 updates to owners that depend on s.
template <class Defer>
void updates_of(std::uint32_t source, std::uint32_t owners, Defer&& defer) {
  for (std::uint32_t k = 0; k < source % 5; ++k)
    defer(mix32(source / 3 + 7 * k) % owners, std::uint64_t{source} * 8 + k);
}

History serial_history(std::uint32_t sources, std::uint32_t owners) {
  History history(owners);
  for (std::uint32_t s = 0; s < sources; ++s)
    updates_of(s, owners, [&](std::uint32_t o, std::uint64_t u) { history[o].push_back(u); });
  return history;
}

History deferred_history(DeferredUpdate<std::uint64_t>& deferred, const Executor& executor,
                         std::uint32_t sources, std::uint32_t owners) {
  parallel_for(executor, sources, [&](std::size_t i) {
    updates_of(static_cast<std::uint32_t>(i), owners,
               [&](std::uint32_t o, std::uint64_t u) { deferred.defer(o, i, u); });
  });
  History history(owners);
  deferred.commit([&](std::uint32_t o, std::uint64_t& u) { history[o].push_back(u); });
  return history;
}

TEST(DeferredUpdate, CommitsEachOwnersUpdatesOrderedBySource) {
  for (std::uint32_t sources : {1U, 10U, 300U, 20000U}) {
    const std::uint32_t owners = sources / 2 + 1;
    const History expected = serial_history(sources, owners);
    for (int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      DeferredUpdate<std::uint64_t> deferred(executor, {.order = CommitOrder::by_source});
      for (int round = 0; round < 3; ++round)
        EXPECT_EQ(deferred_history(deferred, executor, sources, owners), expected) << threads;
    }
  }
}

TEST(DeferredUpdate, CommitsTheSameUpdatesInAnyOrder) {
  constexpr std::uint32_t sources = 20000, owners = 3000;
  History expected = serial_history(sources, owners);
  for (int threads : {1, 2, 3, 8}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::uint64_t> deferred(executor);
    History history = deferred_history(deferred, executor, sources, owners);
    for (auto& updates : history) std::sort(updates.begin(), updates.end());
    EXPECT_EQ(history, expected) << threads;
  }
}

TEST(DeferredUpdate, SortsSourcesThatCameInNoOrder) {
  constexpr std::uint32_t sources = 30011;
  for (int threads : {1, 2, 4}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::uint32_t> deferred(executor, {.order = CommitOrder::by_source});
    parallel_for(executor, sources, [&](std::size_t i) {
      const std::uint32_t s = mix32(static_cast<std::uint32_t>(i));
      deferred.defer(s % 700, s, 2 * s);
      deferred.defer(s % 700, s, 2 * s + 1);
    });
    std::vector<std::vector<std::uint32_t>> got(700), expected(700);
    deferred.commit([&](std::uint32_t o, std::uint32_t u) { got[o].push_back(u); });
    std::map<std::uint32_t, std::uint32_t> ordered;
    for (std::uint32_t i = 0; i < sources; ++i) ordered[mix32(i)] = mix32(i) % 700;
    for (const auto& [s, o] : ordered) {
      expected[o].push_back(2 * s);
      expected[o].push_back(2 * s + 1);
    }
    EXPECT_EQ(got, expected) << threads;
  }
}

/// Threads that take parts of a loop from each other leave pieces in order, which may reach over
/// each other.
TEST(DeferredUpdate, MergesPiecesOfALoop) {
  constexpr std::uint64_t far = std::uint64_t{1} << 40U;  // sources of more than 32 bits
  const std::vector<std::vector<std::uint64_t>> starts = {
      {0, 1000, 2000},      {2000, 0, 1000}, {0, 2000, 1000}, {0, 400, 200},
      {far, 0, far + 1000}, {500, 0, 1000},  {0, 0, 500}};
  for (const auto& start : starts) {
    DeferredUpdate<std::uint64_t> deferred(Executor({.threads = 1}),
                                           {.order = CommitOrder::by_source});
    std::vector<std::pair<std::uint64_t, std::uint64_t>> expected, got;  // source, update
    for (const std::uint64_t first : start)
      for (std::uint64_t source = first; source < first + 1000; ++source) {
        expected.emplace_back(source, expected.size());
        deferred.defer(7, source, expected.size() - 1);
      }
    const auto by_source = [](const auto& a, const auto& b) { return a.first < b.first; };
    const auto deferred_in_order = expected;
    std::stable_sort(expected.begin(), expected.end(), by_source);
    EXPECT_EQ(deferred.commit([&](std::uint32_t, std::uint64_t update) {
      got.push_back(deferred_in_order[update]);
    }),
              3000U);
    EXPECT_EQ(got, expected);
  }
}

TEST(DeferredUpdate, LendsADeferrerForManyUpdates) {
  constexpr std::uint32_t sources = 20000, owners = 3000;
  const History expected = serial_history(sources, owners);
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::uint64_t> deferred(executor, {.order = CommitOrder::by_source});
    for (int round = 0; round < 3; ++round) {
      parallel_for_ranges(executor, sources, [&](std::size_t begin, std::size_t end) {
        const Deferrer<std::uint64_t> mine = deferred.deferrer();
        for (std::size_t i = begin; i < end; ++i)
          updates_of(static_cast<std::uint32_t>(i), owners,
                     [&](std::uint32_t o, std::uint64_t u) { mine.defer(o, i, u); });
      });
      History history(owners);
      deferred.commit([&](std::uint32_t o, std::uint64_t& u) { history[o].push_back(u); });
      EXPECT_EQ(history, expected) << threads;
      if (round == 1) deferred.release();
    }
  }
}

TEST(DeferredUpdate, KeepsNothingOfAnUpdateThatCannotBeCopied) {
  struct Stubborn {
    bool stubborn = false;
    Stubborn() = default;
    explicit Stubborn(bool is) : stubborn(is) {}
    Stubborn(const Stubborn& other) : stubborn(other.stubborn) {
      if (stubborn) throw std::runtime_error("no");
    }
    Stubborn(Stubborn&&) noexcept = default;
  };
  DeferredUpdate<Stubborn> deferred(Executor({.threads = 1}));
  const Stubborn bad(true), good(false);
  EXPECT_THROW(deferred.defer(1, 1, bad), std::runtime_error);
  EXPECT_EQ(deferred.size(), 0U);
  deferred.defer(1, 1, good);
  EXPECT_THROW(deferred.defer(1, 1, bad), std::runtime_error);
  EXPECT_EQ(deferred.commit([](std::uint32_t, Stubborn& s) { EXPECT_FALSE(s.stubborn); }), 1U);
}

TEST(DeferredUpdate, CarriesMoveOnlyAndLargeUpdates) {
  const Executor executor({.threads = 2});
  DeferredUpdate<std::unique_ptr<int>> owned(executor, {.order = CommitOrder::by_source});
  DeferredUpdate<std::array<char, 100000>> large(executor);
  parallel_for(executor, 3000, [&](std::size_t i) {
    owned.defer(static_cast<std::uint32_t>(i % 50), i, std::make_unique<int>(1));
    if (i < 20) large.defer(static_cast<std::uint32_t>(i), i, {static_cast<char>(i)});
  });
  std::vector<int> sum(50);
  owned.commit([&](std::uint32_t o, std::unique_ptr<int>& u) { sum[o] += *u; });
  EXPECT_EQ(sum, std::vector<int>(50, 60));
  int letters = 0;
  large.commit([&](std::uint32_t o, std::array<char, 100000>& u) {
    letters += u[0] == static_cast<char>(o);
  });
  EXPECT_EQ(letters, 20);
  owned.defer(1, 1, std::make_unique<int>(3));  // never committed: must not leak
}

TEST(DeferredUpdate, CommitsOverAlignedUpdatesWhereTheyWerePut) {
  struct alignas(128) Aligned {
    std::array<std::uint32_t, 1024> values;
  };
  for (const CommitOrder order : {CommitOrder::any, CommitOrder::by_source}) {
    for (int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      DeferredUpdate<Aligned> deferred(executor, {.order = order});
      for (int round = 0; round < 2; ++round) {
        parallel_for(executor, 1000, [&](std::size_t i) {
          Aligned update;
          update.values.fill(static_cast<std::uint32_t>(i));
          deferred.defer(static_cast<std::uint32_t>(i), i, update);
        });
        std::vector<int> seen(1000);
        deferred.commit([&](std::uint32_t owner, const Aligned& update) {
          const bool aligned = reinterpret_cast<std::uintptr_t>(&update) % 128 == 0;
          const auto& v = update.values;
          seen[owner] += aligned && std::count(v.begin(), v.end(), owner) == 1024;
        });
        EXPECT_EQ(seen, std::vector<int>(1000, 1)) << threads;
        deferred.release();
      }
    }
  }
}

TEST(DeferredUpdate, LetsTheCommitKeepWhatWasDeferred) {
  const Executor executor({.threads = 2});
  DeferredUpdate<std::unique_ptr<int>> deferred(executor);
  parallel_for(executor, 2000, [&](std::size_t i) {
    deferred.defer(static_cast<std::uint32_t>(i), i, std::make_unique<int>(static_cast<int>(i)));
  });
  std::vector<std::unique_ptr<int>> kept(2000);
  deferred.commit([&](std::uint32_t o, std::unique_ptr<int>& u) { kept[o] = std::move(u); });
  for (int i = 0; i < 2000; ++i) EXPECT_EQ(*kept[static_cast<std::size_t>(i)], i);
}

TEST(DeferredUpdate, TakesOwnersOfAllNumbers) {
  constexpr std::uint32_t n = 20000, last = ~std::uint32_t{0};
  const auto owner_of = [](std::uint32_t i) { return i < 100 ? last - i : mix32(i); };
  for (int threads : {1, 2, 8})
    for (const CommitOrder order : {CommitOrder::any, CommitOrder::by_source}) {
      const Executor executor({.threads = threads});
      DeferredUpdate<std::uint32_t> deferred(executor, {.order = order});
      parallel_for(executor, n, [&](std::size_t i) {
        const auto update = static_cast<std::uint32_t>(i);
        deferred.defer(owner_of(update), i, update);
      });
      std::vector<std::uint32_t> owner_found(n);
      EXPECT_EQ(deferred.commit([&](std::uint32_t o, std::uint32_t u) { owner_found[u] = o; }), n);
      for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(owner_found[i], owner_of(i)) << threads;
    }
}

TEST(DeferredUpdate, CountsDropsAndReleases) {
  const Executor executor({.threads = 2});
  DeferredUpdate<int> deferred(executor);
  EXPECT_EQ(deferred.size(), 0U);
  parallel_for(executor, 5000,
               [&](std::size_t i) { deferred.defer(static_cast<std::uint32_t>(i), i, 1); });
  EXPECT_EQ(deferred.size(), 5000U);
  deferred.clear();
  EXPECT_EQ(deferred.size(), 0U);
  deferred.release();
  deferred.defer(3, 3, 1);
  EXPECT_EQ(deferred.size(), 1U);
}

TEST(DeferredUpdate, PassesOnAnExceptionAndIsEmptyAfterwards) {
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::shared_ptr<int>> deferred(executor);
    const auto shared = std::make_shared<int>(7);
    for (std::uint32_t i = 0; i < 5000; ++i) deferred.defer(i, i, shared);
    EXPECT_THROW(deferred.commit([](std::uint32_t owner, auto&) {
      if (owner == 1234) throw std::runtime_error("stop");
    }),
                 std::runtime_error);
    EXPECT_EQ(deferred.size(), 0U);
    EXPECT_EQ(shared.use_count(), 1);
  }
}

}  // namespace
}  // namespace ductile::runtime::deferred_update_test
