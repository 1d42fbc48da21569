/// @file
/// What it costs to hand an item from the thread that found it to the one that owns it
/// (DeferredUpdate), or to the next round (Worklist, parallel_sort), beside doing the same on one
/// thread with plain containers.

#include <benchmark/benchmark.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/worklist.hpp"

namespace {

using namespace ductile::runtime;

constexpr std::uint32_t owners = 1 << 20;

/// Item i touches an owner near i, as it does on a renumbered mesh.
std::uint32_t owner_of(std::size_t i) {
  return static_cast<std::uint32_t>(i + mix32(static_cast<std::uint32_t>(i)) % 64) % owners;
}

void thread_counts(benchmark::internal::Benchmark* b) {
  b->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime();
}

void count_items(benchmark::State& state, std::size_t items) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

/// Writes what an item brings to a place of its own: what no buffer can avoid.
template <class Bytes, class Make>
void private_array(benchmark::State& state, Make&& make) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  std::vector<Bytes> array(owners);
  for (auto _ : state) {
    parallel_for(executor, owners, [&](std::size_t i) { array[i] = make(i); });
    benchmark::DoNotOptimize(array.data());
    benchmark::ClobberMemory();
  }
  count_items(state, owners);
}

struct Deferred {
  std::uint32_t owner, update;
};

void private_updates(benchmark::State& state) {
  private_array<Deferred>(state, [](std::size_t i) {
    return Deferred{owner_of(i), static_cast<std::uint32_t>(i)};
  });
}
BENCHMARK(private_updates)->Apply(thread_counts);

void private_items(benchmark::State& state) { private_array<std::uint32_t>(state, owner_of); }
BENCHMARK(private_items)->Apply(thread_counts);

/// Without the commit.
void defer_only(benchmark::State& state, CommitOrder order) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  DeferredUpdate<std::uint32_t> deferred(executor, {.order = order});
  for (auto _ : state) {
    parallel_for(executor, owners, [&](std::size_t i) {
      deferred.defer(owner_of(i), i, static_cast<std::uint32_t>(i));
    });
    deferred.clear();
  }
  count_items(state, owners);
}
BENCHMARK_CAPTURE(defer_only, any, CommitOrder::any)->Apply(thread_counts);
BENCHMARK_CAPTURE(defer_only, by_source, CommitOrder::by_source)->Apply(thread_counts);

void deferred_update(benchmark::State& state, CommitOrder order) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  DeferredUpdate<std::uint32_t> deferred(executor, {.order = order});
  std::vector<std::uint32_t> sum(owners);
  for (auto _ : state) {
    parallel_for(executor, owners, [&](std::size_t i) {
      deferred.defer(owner_of(i), i, static_cast<std::uint32_t>(i));
    });
    deferred.commit([&](std::uint32_t owner, std::uint32_t update) { sum[owner] += update; });
  }
  count_items(state, owners);
}
BENCHMARK_CAPTURE(deferred_update, any, CommitOrder::any)->Apply(thread_counts);
BENCHMARK_CAPTURE(deferred_update, by_source, CommitOrder::by_source)->Apply(thread_counts);

void fetch_and_add(benchmark::State& state) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  std::vector<std::uint32_t> sum(owners);
  for (auto _ : state)
    parallel_for(executor, owners, [&](std::size_t i) {
      std::atomic_ref(sum[owner_of(i)])
          .fetch_add(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
    });
  count_items(state, owners);
}
BENCHMARK(fetch_and_add)->Apply(thread_counts);

void worklist(benchmark::State& state, WorkOrder order) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  Worklist<std::uint32_t> list(executor, {.order = order});
  for (auto _ : state) {
    parallel_for(executor, owners, [&](std::size_t i) { list.append(owner_of(i)); });
    list.collect();
    list.clear();
  }
  count_items(state, owners);
}
BENCHMARK_CAPTURE(worklist, arrival, WorkOrder::arrival)->Apply(thread_counts);
BENCHMARK_CAPTURE(worklist, by_item, WorkOrder::by_item)->Apply(thread_counts);

/// Without making the items contiguous.
void publish_only(benchmark::State& state) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  Worklist<std::uint32_t> list(executor, {.order = WorkOrder::arrival});
  for (auto _ : state) {
    parallel_for(executor, owners, [&](std::size_t i) { list.append(owner_of(i)); });
    list.clear();
  }
  count_items(state, owners);
}
BENCHMARK(publish_only)->Apply(thread_counts);

void push_back(benchmark::State& state) {
  std::vector<std::uint32_t> list;
  for (auto _ : state) {
    list.clear();
    for (std::size_t i = 0; i < owners; ++i) list.push_back(owner_of(i));
    benchmark::DoNotOptimize(list.data());
  }
  count_items(state, owners);
}
BENCHMARK(push_back)->UseRealTime();

void sort_random(benchmark::State& state) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  std::vector<std::uint32_t> values(owners), sorted;
  for (std::uint32_t i = 0; i < owners; ++i) values[i] = mix32(i);
  for (auto _ : state) {
    sorted = values;
    parallel_sort(executor, std::span(sorted));
  }
  count_items(state, owners);
}
BENCHMARK(sort_random)->Apply(thread_counts);

void commit_few(benchmark::State& state) {
  const Executor executor({.threads = static_cast<int>(state.range(0))});
  DeferredUpdate<std::uint32_t> deferred(executor, {.order = CommitOrder::by_source});
  std::vector<std::uint32_t> sum(owners);
  for (auto _ : state) {
    for (std::uint32_t i = 0; i < 300; ++i) deferred.defer(i * 13, i, i);
    deferred.commit([&](std::uint32_t owner, std::uint32_t update) { sum[owner] += update; });
  }
  count_items(state, 300);
}
BENCHMARK(commit_few)->Apply(thread_counts);

}  // namespace
