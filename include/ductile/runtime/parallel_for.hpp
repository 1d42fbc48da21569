/// @file
/// parallel_for: a for-loop over [0, n) shared among an Executor's threads, and what builds on it:
/// loops over fixed blocks, deterministic reductions, prefix sums, and per-thread storage.
/// The first exception thrown in a body reaches the caller after all threads have joined. A loop
/// started inside another loop runs on the calling thread alone.
/// A loop outside of a team (with_team) starts and joins OpenMP's threads, which spin by default
/// while they wait: on a shared machine it may take as long as the system's time slice,
/// milliseconds. Run repeated loops in with_team(), or with OMP_WAIT_POLICY=passive in the
/// environment.
/// After fork(), the child of a process that has run a loop runs loops on one thread only: with
/// GCC's OpenMP, others would wait for ever for threads that the child does not have.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

/// How a loop is divided among threads.
struct LoopOptions {
  std::size_t grain = 0;  ///< iterations handed out at once; 0: chosen. Stealing by atomics hands
                          ///< out more while many are left
  Schedule schedule = Schedule::automatic;  ///< automatic: the executor's
  std::size_t serial_below = 0;             ///< fewer iterations than this run on the caller alone
};

/// For bodies of a few nanoseconds, such as copying a number: some hundred of them take as long as
/// starting the threads of a team (with_team).
constexpr LoopOptions few_nanoseconds{.grain = 128, .serial_below = 512};

namespace detail {

/// The loop and iterations that the calling thread runs. In a nested loop, loop and range are those
/// of the outer loop, whose order decides.
struct LoopPlace {
  int thread = 0;                                    // see this_thread()
  int threads = 0;                                   // of the loop's executor; 0 outside of loops
  std::uint64_t loop = 0;                            // index of the loop among those its starter
                                                     // has started
  std::size_t begin = ~std::size_t{0}, end = begin;  // outside of loops: past the end
};
extern constinit thread_local LoopPlace loop_place;

/// Throws std::invalid_argument if the calling thread is in a loop of an executor with another
/// number of threads, because per-thread data would lack a slot for it.
void expect_loop_of(const Executor& executor, const char* what);

}  // namespace detail

/// Index of the calling thread in the running loop, in [0, executor.threads()); 0 outside of loops.
/// In a nested loop it is the index in the outer loop, even for another executor, or 0 if that has
/// no such thread: several threads may then be 0 at once and must not share PerThread data of that
/// executor.
inline int this_thread() noexcept { return detail::loop_place.thread; }

/// Type-erased loop body, called with disjoint ranges that together cover [0, n).
using RangeBody = void (*)(void* context, std::size_t begin, std::size_t end);

/// Runs `body(context, begin, end)` over [0, n). Thread safety: any thread.
void run_loop(const Executor& executor, std::size_t n, RangeBody body, void* context,
              const LoopOptions& options);

/// Calls body(begin, end) with disjoint ranges covering [0, n); their bounds depend on timing.
template <class Body>
void parallel_for_ranges(const Executor& executor, std::size_t n, Body&& body,
                         const LoopOptions& options = {}) {
  using Plain = std::remove_reference_t<Body>;
  run_loop(
      executor, n,
      [](void* context, std::size_t begin, std::size_t end) {
        (*static_cast<Plain*>(context))(begin, end);
      },
      const_cast<std::remove_const_t<Plain>*>(&body), options);
}

/// Objects lent to loop bodies (see parallel_for()): mine() of each returns the calling thread's
/// access.
template <class... Lender>
using Lent = std::tuple<Lender&...>;
/// Gives a loop body, besides its index, access to each of these lists or updates; see
/// parallel_for().
template <class... Lender>
Lent<Lender...> with(Lender&... lender) {
  return {lender...};
}

namespace detail {
/// The body that a loop calls: a copy if it is a small temporary. Compilers keep the references in
/// a copy in registers, because no iteration can change them.
template <class Body, class... Mine>
decltype(auto) own_copy(std::remove_reference_t<Body>& body) {
  // False for references, that is, for bodies that are not temporaries.
  constexpr bool is_small = std::is_trivially_copyable_v<Body> &&
                            std::is_copy_constructible_v<Body> && sizeof(Body) <= 64;
  if constexpr (is_small && std::is_invocable_v<const Body&, std::size_t, Mine&...>) {
    return Body(body);
  } else {
    return (body);
  }
}
}  // namespace detail

/// Calls body(i, mine...) once for every i in [0, n), where `mine` are the results of the lenders'
/// mine(), called once per range of iterations:
/// parallel_for(executor, n, with(found), [&](std::size_t i, auto& mine) { mine.append(i); })
template <class... Lender, class Body>
void parallel_for(const Executor& executor, std::size_t n, Lent<Lender...> lent, Body&& body,
                  const LoopOptions& options = {}) {
  parallel_for_ranges(
      executor, n,
      [&body, lent](std::size_t begin, std::size_t end) {
        const auto run = [&]<class... Mine>(Mine&&... mine) {
          auto&& own_body = detail::own_copy<Body, Mine...>(body);
          for (std::size_t i = begin; i < end; ++i) own_body(i, mine...);
        };
        std::apply([&](auto&... lender) { run(lender.mine()...); }, lent);
      },
      options);
}

/// Calls body(i) once for every i in [0, n).
template <class Body>
void parallel_for(const Executor& executor, std::size_t n, Body&& body,
                  const LoopOptions& options = {}) {
  parallel_for(executor, n, Lent<>(), std::forward<Body>(body), options);
}

/// Calls body(block, begin, end) once for each block of `block_size` iterations of [0, n). Blocks
/// do not depend on threads or timing, so what is computed per block is deterministic.
template <class Body>
void parallel_for_blocks(const Executor& executor, std::size_t n, std::size_t block_size,
                         Body&& body, const LoopOptions& options = {.grain = 1}) {
  const std::size_t blocks = n / block_size + (n % block_size != 0);
  parallel_for(
      executor, blocks,
      [&](std::size_t block) {
        const std::size_t begin = block * block_size;
        body(block, begin, begin + std::min(n - begin, block_size));
      },
      options);
}

/// Combines map(i) for i in [0, n) in an order that does not depend on threads or timing: sums of
/// doubles are bit-identical at any thread count. `combine` is associative in exact arithmetic and
/// `identity` its neutral element.
template <class T, class Map, class Combine>
T parallel_reduce(const Executor& executor, std::size_t n, T identity, Map&& map,
                  Combine&& combine) {
  constexpr std::size_t block_size = 2048;
  struct Part {  // not T: vectors of bool pack them, which threads may not write side by side
    T value;
  };
  std::vector<Part> partial((n + block_size - 1) / block_size, Part{identity});
  parallel_for_blocks(executor, n, block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        T sum = identity;
                        for (std::size_t i = begin; i < end; ++i)
                          sum = combine(std::move(sum), map(i));
                        partial[block].value = std::move(sum);
                      });
  T total = identity;
  for (Part& part : partial) total = combine(std::move(total), std::move(part.value));
  return total;
}

namespace detail {

/// Replaces each value by `before` plus the sum of the values before it; returns `before` plus the
/// total.
template <class T>
T scan_from(T before, std::span<T> values) {
  for (T& value : values) before += std::exchange(value, before);
  return before;
}

}  // namespace detail

/// Replaces each value by the sum of those before it and returns the total. T is an integer.
template <class T>
T exclusive_scan(const Executor& executor, std::span<T> values) {
  constexpr std::size_t block_size = 4096, worth_sharing = 8 * block_size;
  if (executor.threads() == 1 || values.size() < worth_sharing)
    return detail::scan_from(T{}, values);
  const std::size_t blocks = (values.size() + block_size - 1) / block_size;
  std::vector<T> offset(blocks + 1, T{});
  parallel_for_blocks(executor, values.size(), block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        offset[block + 1] =
                            std::accumulate(values.data() + begin, values.data() + end, T{});
                      });
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  parallel_for_blocks(executor, values.size(), block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        detail::scan_from(offset[block], values.subspan(begin, end - begin));
                      });
  return offset[blocks];
}

/// One T per thread, each on its own cache lines. `mine()` is the calling thread's; it uses loads
/// only, because a loop may call it in each iteration, where arithmetic would add latency.
template <class T>
class PerThread {
 public:
  explicit PerThread(const Executor& executor)
      : slots_(static_cast<std::size_t>(executor.threads())),
        value_of_(std::make_unique_for_overwrite<T*[]>(slots_.size())) {
    for (std::size_t t = 0; t < slots_.size(); ++t) value_of_[t] = &slots_[t].value;
  }
  T& mine() { return *value_of_[static_cast<std::size_t>(this_thread())]; }
  std::size_t size() const { return slots_.size(); }
  T& operator[](std::size_t thread) { return slots_[thread].value; }
  const T& operator[](std::size_t thread) const { return slots_[thread].value; }

 private:
  struct alignas(128) Slot {
    T value{};
  };
  std::vector<Slot> slots_;
  std::unique_ptr<T*[]> value_of_;  // [thread]
};

}  // namespace ductile::runtime
