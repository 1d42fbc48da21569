/// @file
/// LockRounds: the strategy `locks`. Threads take parts of the work and run each, the last woken
/// first. An item locks what it reaches until it has been applied; one that reaches for a locked
/// resource releases all of its own and waits for the next round. The result depends on timing.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

template <Operator Op>
class LockRounds {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  LockRounds(const Executor& executor, Op& op) : executor_(executor), op_(op), made_(op) {}

  RoundsReport run(std::vector<Item> work, std::size_t most_rounds) {
    while (!work.empty() && report_.rounds < most_rounds) {
      ++report_.rounds;
      const std::size_t before = report_.applied;
      work = run_round(work);
      if (report_.applied == before) spare_ *= 2;  // plans may want more numbers than they get
      report_.lost += work.size();
    }
    report_.left = work.size();
    made_.close_holes();
    return report_;
  }

 private:
  using Pools = typename MadeThings<Op>::Pools;
  using Owner = std::uint16_t;
  static constexpr Owner nobody = 0;

  struct alignas(128) Part {
    std::span<const Item> work;
    std::vector<Item> stack, later;
    Pools pools;
    std::size_t planned = 0, applied = 0;
  };

  /// Locks whatever is reached.
  class ReachToLock {
   public:
    ReachToLock(std::vector<Owner>& owner_of, Owner own) : owner_of_(owner_of), own_(own) {}
    bool operator()(std::uint32_t resource) {
      const std::atomic_ref owner(owner_of_[resource]);
      Owner seen = owner.load(std::memory_order_relaxed);
      if (seen == own_) return true;
      if (seen == nobody && owner.compare_exchange_strong(seen, own_, std::memory_order_acquire)) {
        held_.push_back(resource);
        return true;
      }
      denied = true;
      return false;
    }
    void let_go() {
      for (const std::uint32_t resource : held_)
        std::atomic_ref(owner_of_[resource]).store(nobody, std::memory_order_release);
      held_.clear();
      denied = false;
    }
    bool denied = false;

   private:
    std::vector<Owner>& owner_of_;
    Owner own_;
    std::vector<std::uint32_t> held_;
  };
  struct PartCommit {
    Part& part;
    void wake(const Item& item) { part.stack.push_back(item); }
    void postpone(const Item& item) { wake(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(MadeThings<Op>::kinds > 0) {
      return part.pools[kind].take();
    }
  };

  /// Cuts the work, in its order, into parts; fewer near the end, to avoid conflicts.
  std::vector<Item> run_round(const std::vector<Item>& work) {
    constexpr std::size_t least_items = 256, parts_a_thread = 8;
    const auto threads = static_cast<std::size_t>(executor_.threads());
    const std::size_t count =
        std::clamp<std::size_t>(work.size() / least_items, 1, parts_a_thread * threads);
    const std::size_t size = (work.size() + count - 1) / count;
    std::vector<Part> parts(count);
    for (std::size_t p = 0; p < count; ++p) {
      const std::size_t begin = std::min(p * size, work.size());
      parts[p].work = std::span(work).subspan(begin, std::min(size, work.size() - begin));
    }
    const auto pools_of = [&](std::size_t p) -> Pools& { return parts[p].pools; };
    made_.deal(count, pools_of, [&](std::size_t) { return 8 * size + spare_; });
    owner_of_.resize(std::max(made_.resources().top(), op_.resource_count()), nobody);
    const PhaseTimer timer(report_.apply_seconds);
    parallel_for(executor_, count, [&](std::size_t p) { run_part(parts[p]); }, {.grain = 1});
    made_.take_back(count, pools_of);
    std::vector<Item> left;
    for (const Part& part : parts) {
      left.insert(left.end(), part.later.begin(), part.later.end());
      report_.planned += part.planned;
      report_.applied += part.applied;
    }
    return left;
  }

  void run_part(Part& part) {
    part.stack.assign(part.work.begin(), part.work.end());
    Plan plan;
    PartCommit commit{part};
    ReachToLock reach(owner_of_, static_cast<Owner>(this_thread() + 1));
    while (!part.stack.empty()) {
      const Item item = part.stack.back();
      part.stack.pop_back();
      ++part.planned;
      const bool found = op_.plan(item, plan, reach);
      const bool has_numbers = !found || reach.denied || has_room(op_, part.pools, plan);
      if (reach.denied || !has_numbers) {
        part.later.push_back(item);
      } else if (found) {
        op_.apply(item, plan, commit);
        ++part.applied;
      }
      reach.let_go();
      if (!has_numbers) break;
    }
    part.later.insert(part.later.end(), part.stack.begin(), part.stack.end());
  }

  const Executor& executor_;
  Op& op_;
  MadeThings<Op> made_;
  std::vector<Owner> owner_of_;  // [resource]: the thread that holds it, counted from 1
  std::size_t spare_ = 4096;     // numbers dealt to each part, in addition to some per item
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
