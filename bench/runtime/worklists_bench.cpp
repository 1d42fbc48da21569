/// @file
/// Cost of collecting the items that the threads of a loop find: in a Worklist, in one list under a
/// lock, in oneTBB's concurrent vector, or by counting first and a prefix sum. Floor: every item
/// found is written to a place of its own.

#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>
#ifdef DUCTILE_BENCH_TBB
#include <tbb/concurrent_vector.h>
#endif

#include "support/add.hpp"
#include "support/extent.hpp"

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::bench {
namespace {

using runtime::Executor;

/// A loop over `count` indices that finds an item at one of `one_in`, at random.
struct Case {
  std::string name;
  std::uint32_t count, one_in;

  bool finds(std::size_t i) const {
    std::uint64_t bound = (std::uint64_t{1} << 32U) / one_in;
    asm("" : "+r"(bound));  // or compilers would know that a loop finds all
    return runtime::mix32(static_cast<std::uint32_t>(i)) < bound;
  }
  static std::uint32_t item(std::size_t i) { return static_cast<std::uint32_t>(i) ^ 1U; }
};

std::vector<Case> cases() {
  const auto count = by_extent<std::uint32_t>(10000, 1000000, 10000000);
  const std::string size = by_extent("1e4", "1e6", "1e7");
  return {
      {"all_of_" + size, count, 1}, {"half_of_" + size, count, 2}, {"few_of_" + size, count, 1000}};
}

/// `make(executor, case)` returns a function that collects the items of a case and returns them as
/// a range, in any order.
template <class Make>
void add_worklists(const std::string& candidate, const std::vector<int>& threads_of, Make make) {
  for (const Case& c : cases())
    add("worklists/" + c.name + '/' + candidate, threads_of,
        [c, make](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          auto collect = make(executor, c);
          for (auto _ : state) benchmark::DoNotOptimize(collect().begin());
          std::uint64_t sum = 0, expected = 0;
          for (const std::uint32_t item : collect()) sum += item + 1ULL;
          for (std::size_t i = 0; i < c.count; ++i)
            if (c.finds(i)) expected += Case::item(i) + 1ULL;
          if (sum != expected) state.SkipWithError("items were lost");
        });
}

void add_floor() {
  for (const Case& c : cases())
    add("worklists/" + c.name + "/floor", thread_counts(),
        [c](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          std::vector<std::uint32_t> own(c.count);
          for (auto _ : state) {
            parallel_for(executor, c.count, [&](std::size_t i) {
              if (c.finds(i)) own[i] = Case::item(i);
            });
            benchmark::ClobberMemory();
          }
        });
}

using List = runtime::Worklist<std::uint32_t>;

void fill(List& list, const Executor& executor, const Case& c) {
  list.clear();
  parallel_for(executor, c.count, runtime::with(list), [&c](std::size_t i, auto& mine) {
    if (c.finds(i)) mine.append(Case::item(i));
  });
}

/// Calls mine() for every item.
void fill_one_by_one(List& list, const Executor& executor, const Case& c) {
  list.clear();
  parallel_for(executor, c.count, [&](std::size_t i) {
    if (c.finds(i)) list.mine().append(Case::item(i));
  });
}

template <class Fill>
void add_worklist(const std::string& name, Fill fill, void (List::*collect)()) {
  add_worklists(name, thread_counts(), [=](const Executor& executor, const Case& c) {
    return [=, &executor, &c, list = std::make_shared<List>(executor)] {
      fill(*list, executor, c);
      (*list.*collect)();
      return list->items();
    };
  });
}

void add_collect() {
  add_worklists("ductile.parallel_collect", thread_counts(),
                [](const Executor& executor, const Case& c) {
                  return [&] {
                    return runtime::parallel_collect<std::uint32_t>(
                        executor, c.count, [&](std::size_t i, auto&& append) {
                          if (c.finds(i)) append(Case::item(i));
                        });
                  };
                });
}

void add_push_back() {
  add_worklists("std.push_back", {1}, [](const Executor&, const Case& c) {
    return [&, list = std::make_shared<std::vector<std::uint32_t>>()] {
      list->clear();
      for (std::size_t i = 0; i < c.count; ++i)
        if (c.finds(i)) list->push_back(Case::item(i));
      return std::span(*list);
    };
  });
}

/// Collects into a common list by `place(list, items)`, which any thread may call, in batches of
/// `batch` items of one thread.
template <class List, class Place>
void add_batches(const std::string& name, std::size_t batch, Place place) {
  using Batches = runtime::PerThread<std::vector<std::uint32_t>>;
  add_worklists(name, thread_counts(), [batch, place](const Executor& executor, const Case& c) {
    return [&executor, &c, batch, place, list = std::make_shared<List>(),
            batches = std::make_shared<Batches>(executor)]() -> const List& {
      const auto publish = [&](std::vector<std::uint32_t>& items) {
        if (!items.empty()) place(*list, items);
        items.clear();
      };
      list->clear();
      parallel_for(executor, c.count, [&](std::size_t i) {
        if (!c.finds(i)) return;
        std::vector<std::uint32_t>& mine = batches->mine();
        mine.push_back(Case::item(i));
        if (mine.size() == batch) publish(mine);
      });
      for (std::size_t t = 0; t < batches->size(); ++t) publish((*batches)[t]);
      return *list;
    };
  });
}

/// A vector that threads change one at a time.
class LockedList {
 public:
  void append(std::span<const std::uint32_t> items) {
    const std::lock_guard lock(mutex_);
    items_.insert(items_.end(), items.begin(), items.end());
  }
  void clear() { items_.clear(); }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }

 private:
  std::mutex mutex_;
  std::vector<std::uint32_t> items_;
};

void add_locked_and_concurrent() {
  const auto append = [](LockedList& list, std::span<const std::uint32_t> items) {
    list.append(items);
  };
  add_batches<LockedList>("mutex.push_back", 1, append);
  add_batches<LockedList>("mutex.batches", 1024, append);
#ifdef DUCTILE_BENCH_TBB
  using Concurrent = tbb::concurrent_vector<std::uint32_t>;
  add_batches<Concurrent>("tbb.push_back", 1,
                          [](Concurrent& list, std::span<const std::uint32_t> items) {
                            list.push_back(items.front());
                          });
  add_batches<Concurrent>("tbb.grow_by", 1024,
                          [](Concurrent& list, std::span<const std::uint32_t> items) {
                            list.grow_by(items.begin(), items.end());
                          });
#endif
}

/// Two passes: blocks of the loop count their items, a prefix sum gives positions, and then blocks
/// write the items there. Deterministic; runs everything twice.
class TwoPasses {
 public:
  TwoPasses(const Executor& executor, const Case& c)
      : executor_(&executor), case_(&c), begin_of_((c.count + block_size - 1) / block_size) {}

  std::span<const std::uint32_t> operator()() {
    parallel_for_blocks(*executor_, case_->count, block_size,
                        [&](std::size_t block, std::size_t begin, std::size_t end) {
                          std::size_t found = 0;
                          for (std::size_t i = begin; i < end; ++i) found += case_->finds(i);
                          begin_of_[block] = found;
                        });
    items_.resize(exclusive_scan(*executor_, std::span(begin_of_)));
    parallel_for_blocks(*executor_, case_->count, block_size,
                        [&](std::size_t block, std::size_t begin, std::size_t end) {
                          std::size_t to = begin_of_[block];
                          for (std::size_t i = begin; i < end; ++i)
                            if (case_->finds(i)) items_[to++] = Case::item(i);
                        });
    return items_;
  }

 private:
  static constexpr std::size_t block_size = 4096;

  const Executor* executor_;
  const Case* case_;
  std::vector<std::size_t> begin_of_;  // [block]
  std::vector<std::uint32_t> items_;
};

void add_all() {
  add_floor();
  add_worklist("ductile.worklist", fill, &List::collect);
  add_worklist("ductile.one_by_one", fill_one_by_one, &List::collect);
  add_worklist("ductile.unique", fill, &List::collect_unique);
  add_collect();
  add_push_back();
  add_locked_and_concurrent();
  add_worklists("prefix_sum.two_passes", thread_counts(),
                [](const Executor& executor, const Case& c) { return TwoPasses(executor, c); });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
