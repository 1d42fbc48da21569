/// @file
/// Cost of a write to data that another thread may own: deferred and committed (DeferredUpdate), or
/// immediate under a lock or by an atomic, or kept in other containers. Item i of a loop adds i to
/// the sum of an owner. Floor: each update is written to a place of its own; arrays.read_back adds
/// the cost of carrying it out.

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <mutex>
#include <numeric>
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
  std::uint32_t count;  // number of updates, and of owners
  std::uint32_t reach;  // largest distance from an item to its owner

  Update update(std::size_t i) const {
    const auto item = static_cast<std::uint32_t>(i);
    std::uint64_t hash = mix32(item);
    asm("" : "+r"(hash));  // or compilers would make several at once of the floor's
    const auto owner = item + static_cast<std::uint32_t>(hash * reach >> 32U);
    return {owner < count ? owner : owner - count, item};
  }
};

std::vector<Case> cases() {
  constexpr std::uint32_t near = 64;  // as on a renumbered mesh
  const auto many = by_extent<std::uint32_t>(10000, 1000000, 10000000);
  const std::string size = by_extent("1e4", "1e6", "1e7");
  return {{"near_" + size, many, near}, {"anywhere_" + size, many, many}, {"few_300", 300, near}};
}

std::string title(std::string subject, const Case& c, const std::string& candidate) {
  return subject.append("/").append(c.name).append("/").append(candidate);
}

/// `make(executor, case)` returns a function that carries out all updates of a case on sums.
template <class Make>
void add_buffers(const std::string& subject, const std::string& candidate, Make make) {
  for (const Case& c : cases())
    add(title(subject, c, candidate), thread_counts(),
        [c, make](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          Sums sums(c.count);
          auto carry_out = make(executor, c);
          carry_out(sums);  // its memory is there from now on, as the floor's is
          std::fill(sums.begin(), sums.end(), 0U);
          for (auto _ : state) carry_out(sums);
          const auto sum = std::accumulate(sums.begin(), sums.end(), 0U);  // all sums wrap
          const std::uint32_t once =
              c.count % 2 == 0 ? c.count / 2 * (c.count - 1) : (c.count - 1) / 2 * c.count;
          if (sum != once * static_cast<std::uint32_t>(state.iterations()))
            state.SkipWithError("updates were lost");
        });
}

/// The stored part of an update.
struct Plain {
  std::uint32_t owner, value;
  Plain() = default;
  Plain(std::size_t, const Update& update) : owner(update.owner), value(update.value) {}
};
struct Sourced {
  std::uint64_t source;
  std::uint32_t owner, value;
  Sourced() = default;
  Sourced(std::size_t item, const Update& update)
      : source(item), owner(update.owner), value(update.value) {}
};

/// The floor: every method that stores updates must write what it keeps to memory.
template <class Kept>
void add_floor(const std::string& subject) {
  for (const Case& c : cases())
    add(title(subject, c, "floor"), thread_counts(), [c](benchmark::State& state, int threads) {
      const Executor executor({.threads = threads});
      const auto own = std::make_unique_for_overwrite<Kept[]>(c.count);
      for (auto _ : state) {
        parallel_for(executor, c.count, [&](std::size_t i) { own[i] = Kept(i, c.update(i)); });
        benchmark::ClobberMemory();
      }
    });
}

/// The minimum for carrying out updates later, in no particular order: each thread writes updates
/// to one array per target thread; then each thread reads the arrays for it and carries them out. A
/// thread owns consecutive owners.
template <class Kept>
class ArraysForThreads {
 public:
  ArraysForThreads(const Executor& executor, const Case& c)
      : executor_(&executor), case_(&c), lanes_(executor) {
    const std::uint32_t share = (c.count - 1) / static_cast<std::uint32_t>(executor.threads()) + 1;
    shift_ = static_cast<unsigned>(std::bit_width(share - 1));
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      for (std::size_t u = 0; u < lanes_.size(); ++u)
        lanes_[t].for_thread.push_back(std::make_unique_for_overwrite<Kept[]>(c.count));
  }

  void operator()(Sums& sums) {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].next = starts(lanes_[t]);
    runtime::parallel_for_ranges(*executor_, case_->count, [&](std::size_t begin, std::size_t end) {
      Kept** const next = lanes_.mine().next.data();
      for (std::size_t i = begin; i < end; ++i) {
        const Update update = case_->update(i);
        *next[update.owner >> shift_]++ = Kept(i, update);
      }
    });
    const auto carry_out = [&](std::size_t thread) {
      for (std::size_t t = 0; t < lanes_.size(); ++t)
        for (const Kept* u = lanes_[t].for_thread[thread].get(); u != lanes_[t].next[thread]; ++u)
          sums[u->owner] += u->value;
    };
    parallel_for(*executor_, lanes_.size(), carry_out, {.grain = 1});
  }

 private:
  struct Lane {
    std::vector<std::unique_ptr<Kept[]>> for_thread;
    std::vector<Kept*> next;  // [thread], where its next update goes
  };

  static std::vector<Kept*> starts(const Lane& lane) {
    std::vector<Kept*> all;
    for (const auto& array : lane.for_thread) all.push_back(array.get());
    return all;
  }

  const Executor* executor_;
  const Case* case_;
  unsigned shift_;  // maps an owner to its thread
  runtime::PerThread<Lane> lanes_;
};

template <CommitOrder order>
using Deferred = runtime::DeferredUpdate<std::uint32_t, order>;

/// How a loop defers.
enum class Way {
  each,   ///< asks for a Deferrer for every update
  range,  ///< parallel_for() asks for one for every range of iterations that a thread gets
};

std::string name_of(Way way) {
  return way == Way::range ? "ductile.deferred" : "ductile.one_by_one";
}

/// Suffix of a subject. In loop order, updates are kept with their sources, which doubles their
/// size.
std::string suffix(CommitOrder order) { return order == CommitOrder::any ? "" : "_by_loop"; }

template <CommitOrder order>
void defer_all(const Executor& executor, const Case& c, Deferred<order>& deferred, Way way) {
  if (way == Way::each) {
    parallel_for(executor, c.count, [&](std::size_t i) {
      const Update update = c.update(i);
      deferred.mine().defer(update.owner, update.value);
    });
  } else {
    parallel_for(executor, c.count, runtime::with(deferred), [&](std::size_t i, const auto& mine) {
      const Update update = c.update(i);
      mine.defer(update.owner, update.value);
    });
  }
}

template <CommitOrder order>
void add_deferred(Way way) {
  add_buffers(
      "buffers" + suffix(order), name_of(way), [way](const Executor& executor, const Case& c) {
        return [&executor, &c, way,
                deferred = std::make_unique<Deferred<order>>(executor)](Sums& sums) {
          defer_all(executor, c, *deferred, way);
          deferred->commit([&](std::uint32_t owner, std::uint32_t value) { sums[owner] += value; });
        };
      });
}

/// Measures deferring without the commit: the cost in the loop.
template <CommitOrder order>
void add_deferring(Way way) {
  for (const Case& c : cases())
    add(title("deferring" + suffix(order), c, name_of(way)), thread_counts(),
        [c, way](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          Deferred<order> deferred(executor);
          defer_all(executor, c, deferred, way);  // its memory is there from now on
          for (auto _ : state) {
            deferred.clear();
            defer_all(executor, c, deferred, way);
          }
          if (deferred.size() != c.count) state.SkipWithError("updates were lost");
        });
}

void add_atomic() {
  add_buffers("buffers", "atomic.fetch_add", [](const Executor& executor, const Case& c) {
    return [&](Sums& sums) {
      parallel_for(executor, c.count, [&](std::size_t i) {
        const Update update = c.update(i);
        std::atomic_ref(sums[update.owner]).fetch_add(update.value, std::memory_order_relaxed);
      });
    };
  });
}

/// Locks shared among the owners, assigned cyclically.
void add_mutexes(const std::string& name, std::size_t lock_count) {
  add_buffers("buffers", name, [lock_count](const Executor& executor, const Case& c) {
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
/// One list for all owners, committed by one thread.
void add_concurrent_vector() {
  add_buffers("buffers", "tbb.concurrent_vector", [](const Executor& executor, const Case& c) {
    return [&, list = std::make_shared<tbb::concurrent_vector<Update>>()](Sums& sums) {
      list->clear();
      parallel_for(executor, c.count, [&](std::size_t i) { list->push_back(c.update(i)); });
      for (const Update& update : *list) sums[update.owner] += update.value;
    };
  });
}
#endif

/// Two passes: blocks of items count the updates for each group of owners, a prefix sum over blocks
/// within groups gives positions, and then blocks write the updates there. Deterministic, because
/// blocks do not depend on threads; computes everything twice.
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

/// Adds the methods that commit in this order and store a Kept per update.
template <class Kept, CommitOrder order>
void add_keepers() {
  const std::string buffers = "buffers" + suffix(order), deferring = "deferring" + suffix(order);
  add_floor<Kept>(buffers);
  add_floor<Kept>(deferring);
  for (const Way way : {Way::each, Way::range}) {
    add_deferred<order>(way);
    add_deferring<order>(way);
  }
  add_buffers(buffers, "arrays.read_back", [](const Executor& executor, const Case& c) {
    return ArraysForThreads<Kept>(executor, c);
  });
  add_buffers(buffers, "prefix_sum.two_passes",
              [](const Executor& executor, const Case& c) { return TwoPasses(executor, c); });
}

void add_all() {
  add_keepers<Plain, CommitOrder::any>();
  add_keepers<Sourced, CommitOrder::by_loop>();
  add_atomic();
  add_mutexes("mutex.one", 1);
  add_mutexes("mutex.striped", 1024);
#ifdef DUCTILE_BENCH_TBB
  add_concurrent_vector();
#endif
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
