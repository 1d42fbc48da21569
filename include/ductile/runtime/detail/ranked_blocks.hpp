/// @file
/// RankedBlocks: blocks of work, each with a rank, of which those that meet run in the order of
/// their ranks, without a barrier between one rank and the next. Threads take blocks as they lie
/// side by side. One that meets a block of lower rank that is not done does that first, or, if
/// another thread has begun it, other blocks meanwhile: of no higher rank than the one that waits.
/// No deadlock: ranks never increase along a thread's stack, and a block waits only for a lower
/// rank, so a started block of lowest rank can always proceed.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// How a sequence is cut into blocks of 2^block_bits, with ranks below 2^rank_bits.
struct BlockLayout {
  unsigned block_bits, rank_bits;

  std::size_t block_size() const { return std::size_t{1} << block_bits; }
  /// Of 2^rank_bits blocks in a row each has another rank, in an order that changes from row to
  /// row: where the bits of numbers have a meaning, equal low bits would gather related blocks in
  /// one rank. Blocks next to each other mostly meet. If their ranks followed each other, all
  /// blocks of a row would wait in a chain, so their ranks are far apart.
  std::uint8_t rank_of(std::size_t block) const {
    const std::size_t last = (std::size_t{1} << rank_bits) - 1;
    return static_cast<std::uint8_t>(7 * (block ^ block >> rank_bits) & last);
  }
};

/// One run. Begun is what a thread knows of a block that it has begun.
template <class Begun>
class RankedBlocks {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  /// rank_of(block) is less than 255.
  RankedBlocks(const Executor& executor, std::size_t count, auto&& rank_of)
      : executor_(executor), rank_of_(count), claimed_(count), begun_(executor) {
    parallel_for(executor_, count,
                 [&](std::size_t block) {
                   rank_of_[block] = static_cast<std::uint8_t>(rank_of(block));
                   claimed_[block] = 0;
                 },
                 {.serial_below = 4096});
  }

  /// Runs all blocks. begin(block) makes a Begun; advance(begun) goes on until the block is done,
  /// and returns none then, or until another has to come before, and returns that.
  void run(auto&& begin, auto&& advance) {
    parallel_for(executor_, rank_of_.size(),
                 [&](std::size_t block) { run_from(block, begin, advance); }, {.grain = 1});
  }

  /// Whether a block has to be done before one of this rank and is not. Who gets false for one of
  /// lower rank sees what that one did. Thread safety: any thread.
  bool comes_before(std::size_t block, std::uint8_t rank) {
    return std::atomic_ref(rank_of_[block]).load(std::memory_order_acquire) < rank;
  }

 private:
  struct Entry {
    std::size_t block;
    Begun begun;
  };
  static constexpr std::uint8_t done = 0xff;  // no block's rank

  /// If a block ends by an exception, nobody is to wait for what will never be done.
  struct FailsIfThrown {
    std::atomic<bool>& failed;
    int exceptions = std::uncaught_exceptions();
    ~FailsIfThrown() {
      if (std::uncaught_exceptions() > exceptions) failed.store(true);
    }
  };

  /// Runs a block unless somebody has begun it, and whichever have to come before, of which it
  /// keeps a stack: their ranks fall.
  void run_from(std::size_t first, auto&& begin, auto&& advance) {
    if (!claim(first)) return;
    const FailsIfThrown guard{failed_};
    std::vector<Entry>& stack = begun_.mine();
    stack.clear();
    const auto push = [&](std::size_t block) { stack.push_back({block, begin(block)}); };
    push(first);
    while (!stack.empty() && !failed_.load(std::memory_order_relaxed)) {
      const std::size_t before = advance(stack.back().begun);
      if (before == none) {
        std::atomic_ref(rank_of_[stack.back().block]).store(done, std::memory_order_release);
        stack.pop_back();
      } else if (claim(before)) {
        push(before);
      } else if (!is_done_soon(before)) {
        const std::size_t other = claim_instead(stack.back().block, first);
        if (other != none) {
          push(other);
        } else {
          std::this_thread::yield();  // whoever has begun it may have lost its core
        }
      }
    }
  }

  bool claim(std::size_t block) {
    // Relaxed: what a block reads is ordered by the ranks of those before it.
    return std::atomic_ref(claimed_[block]).exchange(1, std::memory_order_relaxed) == 0;
  }

  /// Waits for a short while.
  bool is_done_soon(std::size_t block) {
    constexpr int looks = 200;
    for (int i = 0; i < looks; ++i)
      if (!comes_before(block, done) || failed_.load(std::memory_order_relaxed)) return true;
    return false;
  }

  /// Claims one of the blocks after `first` that may run while one waits; none if there is none
  /// near by.
  std::size_t claim_instead(std::size_t waiting, std::size_t first) {
    constexpr std::size_t near = 512;
    const std::size_t count = rank_of_.size();
    const std::uint8_t most = std::atomic_ref(rank_of_[waiting]).load(std::memory_order_relaxed);
    for (std::size_t i = 1; i < std::min(near, count); ++i) {
      const std::size_t block = first + i < count ? first + i : first + i - count;
      if (std::atomic_ref(rank_of_[block]).load(std::memory_order_relaxed) <= most &&
          std::atomic_ref(claimed_[block]).load(std::memory_order_relaxed) == 0 && claim(block))
        return block;
    }
    return none;
  }

  const Executor& executor_;
  UnsetVector<std::uint8_t> rank_of_;    // [block], or done
  UnsetVector<std::uint8_t> claimed_;    // [block], by a thread that has begun it
  PerThread<std::vector<Entry>> begun_;  // the thread's
  std::atomic<bool> failed_{false};
};

}  // namespace ductile::runtime::detail
