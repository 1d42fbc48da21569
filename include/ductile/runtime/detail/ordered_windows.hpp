/// @file
/// OrderedWindows: the strategy `in_order` for operators without conflicts(), also used within a
/// level. A window of the work is planned in parallel; an item with a plan reserves what it has
/// reached, the earliest place wins, and items that hold all they have reached are applied. The
/// others of the window are then planned and applied one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// The steps of a window. apply(item, plan, woken) carries a plan out and adds the items it wakes
/// to a vector; then applied(item) and wake(woken) are called in the order of the work.
template <class Apply, class Applied, class Wake>
struct WindowSteps {
  Apply apply;
  Applied applied;
  Wake wake;
};
template <class Apply, class Applied, class Wake>
WindowSteps(Apply, Applied, Wake) -> WindowSteps<Apply, Applied, Wake>;

/// One run. Work has size() and operator[]. An item without a plan is done, because earlier items
/// of its window cannot give it one.
template <Operator Op, class Work>
class OrderedWindows {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  OrderedWindows(const Executor& executor, Op& op, const Work& work)
      : executor_(executor), op_(op), work_(work), blocks_(window / block_size) {}

  /// Runs a part of the work, after all earlier parts. apply(item, plan) carries a plan out;
  /// applied(item) is called for each, in the order of the work.
  void run(std::size_t begin, std::size_t end, auto&& apply, auto&& applied, RoundsReport& report) {
    const auto apply_alone = [&](const Item& item, Plan& plan, auto&) { apply(item, plan); };
    run_waking(begin, end, WindowSteps{apply_alone, applied, TellNobody()}, report);
  }

  /// The same for items that may wake others.
  void run_waking(std::size_t begin, std::size_t end, const auto& steps, RoundsReport& report) {
    holder_of_.resize(op_.resource_count(), nobody);
    for (; begin < end; begin += window)
      run_window(begin, std::min<std::size_t>(begin + window, end), steps, report);
  }

 private:
  static constexpr std::size_t window = 8192, block_size = 256, least_block_size = 16;
  static constexpr std::uint32_t nobody = 0xffffffffU;

  struct Candidate {
    Plan plan{};
    std::uint32_t place = 0;        // in the work
    std::uint32_t reached_end = 0;  // in the block's list; the previous one's end is the beginning
    std::uint32_t woken_end = 0;    // likewise
    bool won = false;
  };
  /// A part of a window. The first `count` candidates have plans; the others keep their memory.
  struct alignas(128) Block {
    std::vector<Candidate> candidates;
    std::vector<std::uint32_t> reached;
    std::vector<Item> woken;
    std::size_t count = 0;
  };

  bool run_alone(const Item& item, auto&& apply) {
    ReachAll reach;
    if (!op_.plan(item, plan_, reach)) return false;
    woken_.clear();
    apply(item, plan_, woken_);
    return true;
  }

  void run_window(std::size_t begin, std::size_t end, const auto& steps, RoundsReport& report) {
    ++report.batches;
    report.planned += end - begin;
    begin_window();
    const std::size_t size =
        std::max(least_block_size, (end - begin + blocks_.size() - 1) / blocks_.size());
    parallel_for_blocks(executor_, end - begin, size,
                        [&](std::size_t block, std::size_t first, std::size_t last) {
                          plan_block(blocks_[block], begin, begin + first, begin + last);
                        });
    const std::size_t count = (end - begin + size - 1) / size;
    parallel_for(executor_, count,
                 [&](std::size_t block) { apply_winners(blocks_[block], begin, steps.apply); },
                 {.grain = 1});
    for (std::size_t block = 0; block < count; ++block) end_block(blocks_[block], steps, report);
  }

  /// Runs the losers, and reports all applied items.
  void end_block(const Block& block, const auto& steps, RoundsReport& report) {
    const std::span<const Item> woken(block.woken);
    std::size_t first = 0, told = 0;
    for (std::size_t c = 0; c < block.count; ++c) {
      const Candidate& candidate = block.candidates[c];
      const Item item = work_[candidate.place];
      if (!candidate.won) {
        ++report.lost;
        if (!run_alone(item, steps.apply)) continue;
        steps.wake(woken.subspan(told, first - told));
        steps.wake(std::span<const Item>(woken_));
        told = first;
      }
      first = candidate.woken_end;
      steps.applied(item);
      ++report.applied;
    }
    steps.wake(woken.subspan(told));
  }

  /// Keys fall from window to window, so that reservations of earlier windows do not count.
  void begin_window() {
    if (first_key_ < window) {
      std::fill(holder_of_.begin(), holder_of_.end(), nobody);
      first_key_ = nobody;
    }
    first_key_ -= static_cast<std::uint32_t>(window);
  }

  void plan_block(Block& block, std::size_t window_begin, std::size_t begin, std::size_t end) {
    block.reached.clear();
    block.count = 0;
    ReachToNote reach{block.reached};
    for (std::size_t place = begin; place < end; ++place) {
      if (block.count == block.candidates.size()) block.candidates.emplace_back();
      Candidate& candidate = block.candidates[block.count];
      const std::size_t first = block.reached.size();
      if (!op_.plan(work_[place], candidate.plan, reach)) {
        block.reached.resize(first);
        continue;
      }
      candidate.place = static_cast<std::uint32_t>(place);
      candidate.reached_end = static_cast<std::uint32_t>(block.reached.size());
      const std::uint32_t key = key_of(place - window_begin);
      for (std::size_t i = first; i < block.reached.size(); ++i)
        atomic_min(holder_of_[block.reached[i]], key);
      ++block.count;
    }
  }

  void apply_winners(Block& block, std::size_t window_begin, auto&& apply) {
    block.woken.clear();
    std::size_t first = 0;
    for (std::size_t c = 0; c < block.count; ++c) {
      Candidate& candidate = block.candidates[c];
      const std::uint32_t key = key_of(candidate.place - window_begin);
      candidate.won = true;
      for (; first < candidate.reached_end; ++first)
        candidate.won = candidate.won && holder_of_[block.reached[first]] == key;
      if (candidate.won) apply(work_[candidate.place], candidate.plan, block.woken);
      candidate.woken_end = static_cast<std::uint32_t>(block.woken.size());
    }
  }

  std::uint32_t key_of(std::size_t i) const { return first_key_ + static_cast<std::uint32_t>(i); }

  const Executor& executor_;
  Op& op_;
  const Work& work_;
  std::vector<Block> blocks_;             // [block of the window]
  std::vector<std::uint32_t> holder_of_;  // [resource], the key of the first item that has reached
                                          // it
  std::uint32_t first_key_ = nobody;
  Plan plan_{};  // for items that run one by one, with those they wake
  std::vector<Item> woken_;
};

}  // namespace ductile::runtime::detail
