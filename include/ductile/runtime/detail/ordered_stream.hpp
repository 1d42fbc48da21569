/// @file
/// OrderedStream: the strategy `in_order` for operators with conflicts(). Threads take blocks of
/// the work in order. An item that reaches for an earlier unfinished one is put aside, and the
/// thread goes on, up to some blocks ahead of the first unfinished one.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// One run. Work has size() and operator[]. The first unfinished item waits for none, so the thread
/// that has it can proceed.
template <ConflictingOperator Op, class Work>
class OrderedStream {
 public:
  using Item = std::uint32_t;
  using Plan = typename Op::Plan;
  using Place = std::uint32_t;  // in the part of the work that runs

  OrderedStream(const Executor& executor, Op& op, const Work& work)
      : executor_(executor), op_(op), work_(work), done_(ring_size) {
    number_places();
  }

  /// Runs a part of the work, after all earlier parts. apply(item, plan) carries a plan out;
  /// applied(item) is called for each, in the order of the work.
  void run(std::size_t begin, std::size_t end, auto&& apply, auto&& applied, RoundsReport& report) {
    start(begin, end);
    const auto threads = static_cast<std::size_t>(executor_.threads());
    parallel_for(executor_, threads,
                 [&](std::size_t) {
                   try {
                     Worker worker(*this);
                     worker.run(apply);
                   } catch (...) {
                     failed_.store(true);
                     tell_progress();
                     throw;
                   }
                 },
                 {.grain = 1});
    if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(applied)>, TellNobody>)
      for (std::size_t block = 0; block < applied_in_.size(); ++block)
        for (std::size_t word = 0; word < applied_in_[block].size(); ++word)
          for (std::uint64_t bits = applied_in_[block][word]; bits != 0; bits &= bits - 1)
            applied(work_[begin_ + (block << block_bits) + 64 * word +
                          static_cast<std::size_t>(std::countr_zero(bits))]);
    report.planned += planned_.load();
    report.lost += planned_.load() - count_;
    report.applied += applied_.load();
  }

 private:
  static constexpr unsigned block_bits = 8, ring_bits = 15;
  static constexpr Place block_size = 1U << block_bits, ring_size = 1U << ring_bits,
                         blocks_ahead = (ring_size >> block_bits) - 1;
  static constexpr Place absent = 0x80000000U;

  void start(std::size_t begin, std::size_t end) {
    begin_ = static_cast<Place>(begin);
    count_ = static_cast<Place>(end - begin);
    const std::size_t blocks = (count_ + block_size - 1) / block_size;
    block_done_.assign(blocks, 0);
    applied_in_.assign(blocks, {});
    std::fill(done_.begin(), done_.end(), std::uint8_t{0});
    next_ = first_open_ = 0;
    planned_ = applied_ = 0;
  }

  void number_places() {
    const bool in_place = parallel_reduce(
        executor_, work_.size(), true, [&](std::size_t i) { return work_[i] == i; },
        std::logical_and<>());
    if (in_place) return;
    place_of_.resize(op_.resource_count());
    parallel_for(executor_, place_of_.size(), [&](std::size_t r) { place_of_[r] = absent; });
    parallel_for(executor_, work_.size(), [&](std::size_t i) {
      if (work_[i] >= place_of_.size())
        throw std::out_of_range("item " + std::to_string(work_[i]) +
                                " is in the work, but there are " +
                                std::to_string(place_of_.size()) + " resources");
      std::atomic_ref(place_of_[work_[i]]).store(static_cast<Place>(i), std::memory_order_relaxed);
    });
    parallel_for(executor_, work_.size(), [&](std::size_t i) {
      if (place_of_[work_[i]] != i)
        throw std::invalid_argument(
            "item " + std::to_string(work_[i]) +
            " is in the work twice, which strategy in_order does not allow");
    });
  }
  /// Place in the current part. Items that are not in the work, or come before this part, get a
  /// place past its end.
  Place place_of(Item item) const { return (place_of_.empty() ? item : place_of_[item]) - begin_; }

  /// Marks differ from one pass over the ring to the next.
  static std::uint8_t mark_of(Place place) {
    return static_cast<std::uint8_t>((place >> ring_bits) + 1);
  }
  bool is_done(Place place) {
    return std::atomic_ref(done_[place % ring_size]).load(std::memory_order_acquire) ==
           mark_of(place);
  }
  void set_done(Place place) {
    std::atomic_ref(done_[place % ring_size]).store(mark_of(place), std::memory_order_release);
  }
  void tell_progress() {
    progress_.fetch_add(1, std::memory_order_release);
    progress_.notify_all();
  }

  class Worker {
   public:
    explicit Worker(OrderedStream& all) : all_(all) {}
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    ~Worker() {
      all_.planned_ += planned_;
      all_.applied_ += applied_;
    }

    void run(auto&& apply) {
      while (!all_.failed_.load(std::memory_order_relaxed)) {
        const std::uint32_t seen = all_.progress_.load(std::memory_order_acquire);
        find_first_open();
        const bool helped = !aside_.empty() && try_again(apply);
        if (take_block(apply) || helped) continue;
        if (aside_.empty() && next_block() >= all_.block_done_.size()) return;
        wait_for_progress(seen);
      }
    }

   private:
    struct Open {
      Place block, left;
    };

    Place next_block() const { return all_.next_.load(std::memory_order_relaxed); }

    void find_first_open() {
      first_open_ = std::max(first_open_, all_.first_open_.load(std::memory_order_acquire));
      const Place before = first_open_;
      while (first_open_ < all_.block_done_.size() &&
             std::atomic_ref(all_.block_done_[first_open_]).load(std::memory_order_acquire) != 0)
        ++first_open_;
      // A slow thread may set it back, which costs only another look.
      if (first_open_ != before) all_.first_open_.store(first_open_, std::memory_order_release);
    }

    /// False if none is left, or all that is left is too far ahead.
    bool take_block(auto&& apply) {
      Place block = next_block();
      do {
        if (block >= all_.block_done_.size() || block - first_open_ >= blocks_ahead) return false;
      } while (!all_.next_.compare_exchange_weak(block, block + 1, std::memory_order_relaxed));
      const Place begin = block << block_bits, end = std::min(all_.count_, begin + block_size);
      Place left = 0;
      for (Place place = begin; place < end; ++place)
        if (!try_item(place, apply)) {
          aside_.push_back(place);
          ++left;
        }
      if (left > 0) {
        open_.push_back({block, left});
      } else {
        end_block(block);
      }
      return true;
    }

    void end_block(Place block) {
      std::atomic_ref(all_.block_done_[block]).store(1, std::memory_order_release);
      all_.tell_progress();
    }

    bool try_item(Place place, auto&& apply) {
      const Place first = first_open_ << block_bits, range = place - first;
      bool denied = false;
      const Item item = all_.work_[all_.begin_ + place];
      auto reach = [&](Item other) {
        const Place at = all_.place_of(other);
        if (at - first >= range || all_.is_done(at)) return true;
        denied = true;
        return false;
      };
      ++planned_;
      const bool found = all_.op_.plan(item, plan_, reach);
      if (denied) return false;
      if (found) {
        apply(item, plan_);
        ++applied_;
        const Place in_block = place % block_size;
        all_.applied_in_[place >> block_bits][in_block / 64] |= std::uint64_t{1} << in_block % 64;
      }
      all_.set_done(place);
      return true;
    }

    bool try_again(auto&& apply) {
      std::size_t waiting = 0;
      for (const Place place : aside_) {
        if (try_item(place, apply)) {
          end_item(place >> block_bits);
        } else {
          aside_[waiting++] = place;
        }
      }
      const bool helped = waiting < aside_.size();
      aside_.resize(waiting);
      std::erase_if(open_, [](const Open& open) { return open.left == 0; });
      if (helped) all_.tell_progress();
      return helped;
    }
    void end_item(Place block) {
      for (Open& open : open_)
        if (open.block == block && --open.left == 0) end_block(block);
    }

    /// Spins shortly first, because most waits are short.
    void wait_for_progress(std::uint32_t seen) {
      constexpr int looks = 200;
      for (int i = 0; i < looks; ++i)
        if (all_.progress_.load(std::memory_order_relaxed) != seen) return;
      all_.progress_.wait(seen, std::memory_order_relaxed);
    }

    OrderedStream& all_;
    Plan plan_{};
    std::vector<Place> aside_;
    std::vector<Open> open_;  // blocks with items aside
    Place first_open_ = 0;    // all blocks before it are done
    std::size_t planned_ = 0, applied_ = 0;
  };

  const Executor& executor_;
  Op& op_;
  const Work& work_;
  Place begin_ = 0, count_ = 0;  // the current part
  UnsetVector<Place> place_of_;  // [item], empty if each item is its own place
  std::vector<std::uint8_t> block_done_;
  std::vector<std::array<std::uint64_t, block_size / 64>> applied_in_;  // [block], bits
  std::vector<std::uint8_t> done_;                                      // [place % ring_size]
  alignas(128) std::atomic<Place> next_{0};
  alignas(128) std::atomic<Place> first_open_{0};
  alignas(128) std::atomic<std::uint32_t> progress_{0};
  std::atomic<bool> failed_{false};
  std::atomic<std::size_t> planned_{0}, applied_{0};
};

}  // namespace ductile::runtime::detail
