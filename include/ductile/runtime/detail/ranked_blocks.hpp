/// @file
/// RankedBlocks: runs blocks of work, each with a rank; blocks that touch run in the order of their
/// ranks, without barriers between ranks. Threads take blocks in order of position. A thread whose
/// block touches an unfinished one of lower rank runs that first; if another thread has begun it,
/// it runs other blocks meanwhile, of no higher rank than the waiting one. No deadlock: ranks never
/// increase along a thread's stack, and a block waits only for a lower rank, so a started block of
/// lowest rank can always proceed.
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

/// Cuts a sequence into blocks of 2^block_bits, with ranks below 2^rank_bits.
struct BlockLayout {
  unsigned block_bits, rank_bits;

  std::size_t block_size() const { return std::size_t{1} << block_bits; }
  /// Any 2^rank_bits consecutive blocks have different ranks, in an order that changes from group
  /// to group: if the bits of numbers have a meaning, equal low bits would give related blocks the
  /// same rank. Adjacent blocks mostly touch, so their ranks are far apart; otherwise all blocks of
  /// a group would wait in a chain.
  std::uint8_t rank_of(std::size_t block) const {
    const std::size_t last = (std::size_t{1} << rank_bits) - 1;
    return static_cast<std::uint8_t>(7 * (block ^ block >> rank_bits) & last);
  }
};

/// One run. Begun is a thread's state of a block it has begun.
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

  /// Runs all blocks. begin(block) makes a Begun; advance(begun) works until the block is done and
  /// returns none, or until another block must come first and returns that.
  void run(auto&& begin, auto&& advance) {
    parallel_for(executor_, rank_of_.size(),
                 [&](std::size_t block) { run_from(block, begin, advance); }, {.grain = 1});
  }

  /// Is a block of lower rank than this one and unfinished? If false for a block of lower rank, the
  /// thread sees that block's writes. Thread safety: any thread.
  bool comes_before(std::size_t block, std::uint8_t rank) {
    return std::atomic_ref(rank_of_[block]).load(std::memory_order_acquire) < rank;
  }

 private:
  struct Entry {
    std::size_t block;
    Begun begun;
  };
  static constexpr std::uint8_t done = 0xff;  // greater than any rank

  /// If a block ends by an exception, no thread waits for it.
  struct FailsIfThrown {
    std::atomic<bool>& failed;
    int exceptions = std::uncaught_exceptions();
    ~FailsIfThrown() {
      if (std::uncaught_exceptions() > exceptions) failed.store(true);
    }
  };

  /// Runs a block unless a thread has begun it, and those that must come first, on a stack of
  /// falling ranks.
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
          std::this_thread::yield();  // the thread that has begun it may have lost its core
        }
      }
    }
  }

  bool claim(std::size_t block) {
    // Relaxed: the ranks of earlier blocks order what a block reads.
    return std::atomic_ref(claimed_[block]).exchange(1, std::memory_order_relaxed) == 0;
  }

  /// Spins shortly.
  bool is_done_soon(std::size_t block) {
    constexpr int looks = 200;
    for (int i = 0; i < looks; ++i)
      if (!comes_before(block, done) || failed_.load(std::memory_order_relaxed)) return true;
    return false;
  }

  /// Claims a nearby block after `first` that may run while one waits; none if there is none.
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
  UnsetVector<std::uint8_t> rank_of_;    // [block], or `done`
  UnsetVector<std::uint8_t> claimed_;    // [block], has a thread begun it?
  PerThread<std::vector<Entry>> begun_;  // each thread's stack
  std::atomic<bool> failed_{false};
};

}  // namespace ductile::runtime::detail
