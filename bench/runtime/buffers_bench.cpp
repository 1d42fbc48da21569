/// @file
/// What it costs to carry out a write for data that another thread may own: kept and committed
/// (DeferredUpdate), or at once under a lock or by an atomic, or kept in other containers.
/// Item i of a loop adds i to the sum of an owner. Floor: it writes both into an array of its own.

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <numeric>
#include <tuple>
#include <utility>
#ifdef DUCTILE_BENCH_TBB
#include <tbb/concurrent_vector.h>
#endif

#include "support/add.hpp"
#include "support/extent.hpp"

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/hash.hpp"

namespace ductile::bench {
namespace {

using runtime::CommitOrder;
using runtime::Executor;
using runtime::mix32;

using Sums = std::vector<std::uint32_t>;  // [owner]
struct Update {
  std::uint32_t owner, value;
};

struct Case {
  std::string name;
  std::uint32_t count;                      // of updates, and of owners
  std::uint32_t (*owner)(std::uint32_t i);  // to be taken modulo the owners

  Update update(std::size_t i) const {
    const auto item = static_cast<std::uint32_t>(i);
    return {owner(item) % count, item};
  }
};

std::vector<Case> cases() {
  // Near by as on a renumbered mesh, or anywhere.
  constexpr auto near = [](std::uint32_t i) { return i + mix32(i) % 64; };
  constexpr auto anywhere = [](std::uint32_t i) { return mix32(i); };
  const auto many = by_extent<std::uint32_t>(10000, 1000000, 10000000);
  const std::string size = by_extent("1e4", "1e6", "1e7");
  return {
      {"near_" + size, many, near}, {"anywhere_" + size, many, anywhere}, {"few_300", 300, near}};
}

/// `make(executor, case)` returns a function that carries out all updates of a case on sums.
template <class Make>
void add_buffers(const std::string& candidate, Make make) {
  for (const Case& c : cases())
    add("buffers/" + c.name + '/' + candidate, thread_counts(),
        [c, make](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          Sums sums(c.count);
          auto carry_out = make(executor, c);
          carry_out(sums);  // its memory is there from now on, as the floor's is
          std::fill(sums.begin(), sums.end(), 0U);
          for (auto _ : state) carry_out(sums);
          const auto sum = std::accumulate(sums.begin(), sums.end(), 0U);  // all of these wrap
          const std::uint32_t once =
              c.count % 2 == 0 ? c.count / 2 * (c.count - 1) : (c.count - 1) / 2 * c.count;
          if (sum != once * static_cast<std::uint32_t>(state.iterations()))
            state.SkipWithError("updates were lost");
        });
}

void add_floor(const std::string& subject) {
  for (const Case& c : cases())
    add(subject + '/' + c.name + "/floor", thread_counts(),
        [c](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          std::vector<Update> own(c.count);
          for (auto _ : state) {
            parallel_for(executor, c.count, [&](std::size_t i) { own[i] = c.update(i); });
            benchmark::ClobberMemory();
          }
        });
}

using Deferred = runtime::DeferredUpdate<std::uint32_t>;

/// How a loop defers.
enum class Way {
  each,  ///< DeferredUpdate::defer() for every update
  run,   ///< a Deferrer for every run of iterations that a thread gets, as run_rounds has it
};

void defer_all(const Executor& executor, const Case& c, Deferred& deferred, Way way) {
  if (way == Way::each) {
    parallel_for(executor, c.count, [&](std::size_t i) {
      const Update update = c.update(i);
      deferred.defer(update.owner, i, update.value);
    });
  } else {
    runtime::parallel_for_ranges(executor, c.count, [&](std::size_t begin, std::size_t end) {
      const auto deferrer = deferred.deferrer();
      for (std::size_t i = begin; i < end; ++i) {
        const Update update = c.update(i);
        deferrer.defer(update.owner, i, update.value);
      }
    });
  }
}

void add_deferred(const std::string& name, CommitOrder order, Way way) {
  add_buffers(name, [order, way](const Executor& executor, const Case& c) {
    return [&executor, &c, way,
            deferred = std::make_unique<Deferred>(
                executor, runtime::DeferredUpdateOptions{.order = order})](Sums& sums) {
      defer_all(executor, c, *deferred, way);
      deferred->commit([&](std::uint32_t owner, std::uint32_t value) { sums[owner] += value; });
    };
  });
}

/// Without the commit: what a loop pays for an update that it defers.
void add_deferring(const std::string& name, CommitOrder order, Way way) {
  for (const Case& c : cases())
    add("deferring/" + c.name + '/' + name, thread_counts(),
        [c, order, way](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          Deferred deferred(executor, {.order = order});
          defer_all(executor, c, deferred, way);  // its memory is there from now on
          for (auto _ : state) {
            deferred.clear();
            defer_all(executor, c, deferred, way);
          }
          if (deferred.size() != c.count) state.SkipWithError("updates were lost");
        });
}

void add_atomic() {
  add_buffers("atomic.fetch_add", [](const Executor& executor, const Case& c) {
    return [&](Sums& sums) {
      parallel_for(executor, c.count, [&](std::size_t i) {
        const Update update = c.update(i);
        std::atomic_ref(sums[update.owner]).fetch_add(update.value, std::memory_order_relaxed);
      });
    };
  });
}

/// Locks shared among the owners in turn.
void add_mutexes(const std::string& name, std::size_t lock_count) {
  add_buffers(name, [lock_count](const Executor& executor, const Case& c) {
    struct alignas(64) Lock {
      std::mutex mutex;
    };
    return [&, locks = std::make_shared<std::vector<Lock>>(lock_count)](Sums& sums) {
      parallel_for(executor, c.count, [&](std::size_t i) {
        const Update update = c.update(i);
        const std::lock_guard lock((*locks)[update.owner % locks->size()].mutex);
        sums[update.owner] += update.value;
      });
    };
  });
}

#ifdef DUCTILE_BENCH_TBB
/// One list for all owners, so that one thread commits it.
void add_concurrent_vector() {
  add_buffers("tbb.concurrent_vector", [](const Executor& executor, const Case& c) {
    return [&, list = std::make_shared<tbb::concurrent_vector<Update>>()](Sums& sums) {
      list->clear();
      parallel_for(executor, c.count, [&](std::size_t i) { list->push_back(c.update(i)); });
      for (const Update& update : *list) sums[update.owner] += update.value;
    };
  });
}
#endif

/// Two passes: blocks of items count what goes to which group of owners, a prefix sum over blocks
/// within groups says where, and then they write it there. Deterministic, as blocks do not depend
/// on threads; decides everything twice.
class TwoPasses {
 public:
  TwoPasses(const Executor& executor, const Case& c)
      : executor_(&executor), case_(&c), place_of_(group_count * block_count()), list_(c.count) {}

  void operator()(Sums& sums) {
    std::fill(place_of_.begin(), place_of_.end(), 0U);
    for_each_update([&](std::size_t place, const Update&) { ++place_of_[place]; });
    exclusive_scan(*executor_, std::span(place_of_));
    for_each_update([&](std::size_t place, const Update& u) { list_[place_of_[place]++] = u; });
    parallel_for(*executor_, group_count, [&](std::size_t group) { commit(group, sums); },
                 {.grain = 1});
  }

 private:
  static constexpr std::size_t group_count = 64;
  static constexpr std::size_t block_size = 4096;

  std::size_t block_count() const { return (case_->count + block_size - 1) / block_size; }

  /// visit(place in the table of groups and blocks, update)
  template <class Visit>
  void for_each_update(Visit&& visit) const {
    parallel_for_blocks(*executor_, case_->count, block_size,
                        [&](std::size_t block, std::size_t begin, std::size_t end) {
                          for (std::size_t i = begin; i < end; ++i) {
                            const Update update = case_->update(i);
                            const std::size_t group = update.owner / 256 % group_count;
                            visit(group * block_count() + block, update);
                          }
                        });
  }

  void commit(std::size_t group, Sums& sums) const {
    // After the second pass a place is where the one after it began.
    const std::size_t first = group * block_count(), last = first + block_count() - 1;
    const std::size_t begin = first == 0 ? 0 : place_of_[first - 1];
    for (std::size_t i = begin; i < place_of_[last]; ++i) sums[list_[i].owner] += list_[i].value;
  }

  const Executor* executor_;
  const Case* case_;
  std::vector<std::uint32_t> place_of_;  // [group, block]
  std::vector<Update> list_;             // by group, then block
};

void add_all() {
  add_floor("buffers");
  add_floor("deferring");
  const std::tuple<const char*, CommitOrder, Way> ways[] = {
      {"ductile.any_order", CommitOrder::any, Way::each},
      {"ductile.any_order_in_runs", CommitOrder::any, Way::run},
      {"ductile.by_source", CommitOrder::by_source, Way::each},
      {"ductile.by_source_in_runs", CommitOrder::by_source, Way::run}};
  for (const auto& [name, order, way] : ways) {
    add_deferred(name, order, way);
    add_deferring(name, order, way);
  }
  add_atomic();
  add_mutexes("mutex.one", 1);
  add_mutexes("mutex.striped", 1024);
#ifdef DUCTILE_BENCH_TBB
  add_concurrent_vector();
#endif
  add_buffers("prefix_sum.two_passes",
              [](const Executor& executor, const Case& c) { return TwoPasses(executor, c); });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
