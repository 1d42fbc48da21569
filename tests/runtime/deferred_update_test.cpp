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

constexpr int thread_counts[] = {1, 2, 3, 4, 8};

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

template <CommitOrder order>
History deferred_history(DeferredUpdate<std::uint64_t, order>& deferred, const Executor& executor,
                         std::uint32_t sources, std::uint32_t owners) {
  parallel_for(executor, sources, with(deferred), [&](std::size_t i, const auto& mine) {
    updates_of(static_cast<std::uint32_t>(i), owners,
               [&](std::uint32_t o, std::uint64_t u) { mine.defer(o, u); });
  });
  History history(owners);
  deferred.commit([&](std::uint32_t o, std::uint64_t& u) { history[o].push_back(u); });
  return history;
}

TEST(DeferredUpdate, CommitsEachOwnersUpdatesInTheOrderOfTheLoop) {
  for (std::uint32_t sources : {1U, 10U, 300U, 20000U}) {
    const std::uint32_t owners = sources / 2 + 1;
    const History expected = serial_history(sources, owners);
    for (int threads : thread_counts) {
      const Executor executor({.threads = threads});
      DeferredUpdate<std::uint64_t, CommitOrder::by_loop> deferred(executor);
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

TEST(DeferredUpdate, HasTheSameOrderInEveryFormOfLoop) {
  constexpr std::uint32_t sources = 20000, owners = 3000, inner = 10;
  const History expected = serial_history(sources, owners);
  using Ordered = DeferredUpdate<std::uint64_t, CommitOrder::by_loop>;
  for (const Schedule schedule :
       {Schedule::automatic, Schedule::omp_dynamic, Schedule::steal_by_signal})
    for (int threads : thread_counts) {
      const Executor executor({.threads = threads, .schedule = schedule});
      Ordered by_ranges(executor), one_by_one(executor), nested(executor);
      parallel_for_ranges(executor, sources, [&](std::size_t begin, std::size_t end) {
        const auto mine = by_ranges.mine();
        for (std::size_t i = begin; i < end; ++i)
          updates_of(static_cast<std::uint32_t>(i), owners,
                     [&](std::uint32_t o, std::uint64_t u) { mine.defer(o, u); });
      });
      parallel_for(executor, sources, [&](std::size_t i) {
        updates_of(static_cast<std::uint32_t>(i), owners,
                   [&](std::uint32_t o, std::uint64_t u) { one_by_one.mine().defer(o, u); });
      });
      parallel_for(executor, sources / inner, [&](std::size_t i) {
        parallel_for(executor, inner, with(nested), [&](std::size_t k, const auto& mine) {
          updates_of(static_cast<std::uint32_t>(inner * i + k), owners,
                     [&](std::uint32_t o, std::uint64_t u) { mine.defer(o, u); });
        });
      });
      for (Ordered* deferred : {&by_ranges, &one_by_one, &nested}) {
        History history(owners);
        deferred->commit([&](std::uint32_t o, std::uint64_t u) { history[o].push_back(u); });
        EXPECT_EQ(history, expected) << threads;
      }
    }
}

TEST(DeferredUpdate, CommitsOneLoopBeforeTheNext) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::uint32_t, CommitOrder::by_loop> deferred(executor);
    std::vector<std::uint32_t> expected, got;
    const auto defer = [&](std::uint32_t update) {
      expected.push_back(update);
      deferred.mine().defer(7, update);
    };
    const auto defer_many = [&](std::uint32_t n, std::uint32_t first) {
      for (std::uint32_t i = 0; i < n; ++i) expected.push_back(first + i);
      parallel_for(executor, n, with(deferred), [=](std::size_t i, const auto& mine) {
        mine.defer(7, first + static_cast<std::uint32_t>(i));
      });
    };
    for (int round = 0; round < 2; ++round) {
      defer(1);
      defer_many(10000, 100), defer(2), defer_many(3, 50), defer_many(5000, 20000);
      deferred.commit([&](std::uint32_t, std::uint32_t u) { got.push_back(u); });
      EXPECT_EQ(got, expected) << threads;
    }
  }
}

TEST(DeferredUpdate, RefusesALoopOfAnotherExecutor) {
  const Executor executor({.threads = 2}), other({.threads = 3});
  DeferredUpdate<int> deferred(executor);
  const auto defer = [](std::size_t, const auto& mine) { mine.defer(1, 1); };
  EXPECT_THROW(parallel_for(other, 1000, with(deferred), defer), std::invalid_argument);
  EXPECT_EQ(deferred.size(), 0U);
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
  EXPECT_THROW(deferred.mine().defer(1, bad), std::runtime_error);
  EXPECT_EQ(deferred.size(), 0U);
  deferred.mine().defer(1, good);
  EXPECT_THROW(deferred.mine().defer(1, bad), std::runtime_error);
  EXPECT_EQ(deferred.commit([](std::uint32_t, Stubborn& s) { EXPECT_FALSE(s.stubborn); }), 1U);
}

TEST(DeferredUpdate, CarriesMoveOnlyAndLargeUpdates) {
  const Executor executor({.threads = 2});
  DeferredUpdate<std::unique_ptr<int>, CommitOrder::by_loop> owned(executor);
  DeferredUpdate<std::array<char, 100000>> large(executor);
  const auto defer_both = [](std::size_t i, const auto& small, const auto& big) {
    small.defer(static_cast<std::uint32_t>(i % 50), std::make_unique<int>(1));
    if (i < 20) big.defer(static_cast<std::uint32_t>(i), {static_cast<char>(i)});
  };
  parallel_for(executor, 3000, with(owned, large), defer_both);
  std::vector<int> sum(50);
  owned.commit([&](std::uint32_t o, std::unique_ptr<int>& u) { sum[o] += *u; });
  EXPECT_EQ(sum, std::vector<int>(50, 60));
  int letters = 0;
  large.commit([&](std::uint32_t o, std::array<char, 100000>& u) {
    letters += u[0] == static_cast<char>(o);
  });
  EXPECT_EQ(letters, 20);
  owned.mine().defer(1, std::make_unique<int>(3));  // never committed: must not leak
}

struct alignas(128) Aligned {
  std::array<std::uint32_t, 1024> values;
};

template <CommitOrder order>
void expect_aligned(const Executor& executor) {
  DeferredUpdate<Aligned, order> deferred(executor);
  for (int round = 0; round < 2; ++round) {
    parallel_for(executor, 1000, with(deferred), [](std::size_t i, const auto& mine) {
      Aligned update;
      update.values.fill(static_cast<std::uint32_t>(i));
      mine.defer(static_cast<std::uint32_t>(i), update);
    });
    std::vector<int> seen(1000);
    deferred.commit([&](std::uint32_t owner, const Aligned& update) {
      const bool aligned = reinterpret_cast<std::uintptr_t>(&update) % 128 == 0;
      const auto& v = update.values;
      seen[owner] += aligned && std::count(v.begin(), v.end(), owner) == 1024;
    });
    EXPECT_EQ(seen, std::vector<int>(1000, 1)) << executor.threads();
  }
}

TEST(DeferredUpdate, CommitsOverAlignedUpdatesWhereTheyWerePut) {
  for (int threads : {1, 2, 8}) {
    expect_aligned<CommitOrder::any>(Executor({.threads = threads}));
    expect_aligned<CommitOrder::by_loop>(Executor({.threads = threads}));
  }
}

TEST(DeferredUpdate, LetsTheCommitKeepWhatWasDeferred) {
  const Executor executor({.threads = 2});
  DeferredUpdate<std::unique_ptr<int>> deferred(executor);
  parallel_for(executor, 2000, with(deferred), [](std::size_t i, const auto& mine) {
    mine.defer(static_cast<std::uint32_t>(i), std::make_unique<int>(static_cast<int>(i)));
  });
  std::vector<std::unique_ptr<int>> kept(2000);
  deferred.commit([&](std::uint32_t o, std::unique_ptr<int>& u) { kept[o] = std::move(u); });
  for (int i = 0; i < 2000; ++i) EXPECT_EQ(*kept[static_cast<std::size_t>(i)], i);
}

TEST(DeferredUpdate, TakesOwnersOfAllNumbers) {
  constexpr std::uint32_t n = 20000, last = ~std::uint32_t{0};
  const auto owner_of = [](std::uint32_t i) { return i < 100 ? last - i : mix32(i); };
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::uint32_t> deferred(executor);
    parallel_for(executor, n, with(deferred), [&](std::size_t i, const auto& mine) {
      const auto update = static_cast<std::uint32_t>(i);
      mine.defer(owner_of(update), update);
    });
    std::vector<std::uint32_t> owner_found(n);
    EXPECT_EQ(deferred.commit([&](std::uint32_t o, std::uint32_t u) { owner_found[u] = o; }), n);
    for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(owner_found[i], owner_of(i)) << threads;
  }
}

TEST(DeferredUpdate, CountsAndDrops) {
  const Executor executor({.threads = 2});
  DeferredUpdate<int> deferred(executor);
  EXPECT_EQ(deferred.size(), 0U);
  parallel_for(executor, 5000, with(deferred), [](std::size_t i, const auto& mine) {
    mine.defer(static_cast<std::uint32_t>(i), 1);
  });
  EXPECT_EQ(deferred.size(), 5000U);
  deferred.clear();
  EXPECT_EQ(deferred.size(), 0U);
  deferred.mine().defer(3, 1);
  EXPECT_EQ(deferred.size(), 1U);
}

TEST(DeferredUpdate, PassesOnAnExceptionAndIsEmptyAfterwards) {
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    DeferredUpdate<std::shared_ptr<int>> deferred(executor);
    const auto shared = std::make_shared<int>(7);
    for (std::uint32_t i = 0; i < 5000; ++i) deferred.mine().defer(i, shared);
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
