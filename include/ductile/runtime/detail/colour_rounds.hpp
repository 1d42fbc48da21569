/// @file
/// ColourRounds: the strategy `colours`. Each round colours the conflict graph of its work and runs
/// the items of one colour at once, class after class; deferred updates are committed after each
/// class. Items woken after their turn and postponed items are the next round's work.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/detail/woken_items.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// Places grouped by colour.
struct ConflictClasses {
  std::vector<std::uint32_t> places;
  std::vector<std::size_t> begin;  // [class], and one past the last
};

/// Colours a graph in compressed rows, [place + 1] and [begin[place]]: by blocks if the executor is
/// deterministic, otherwise by speculation (detect_again). Throws std::bad_alloc. Thread safety:
/// one caller; runs on the executor.
ConflictClasses classes_of_conflicts(const Executor& executor, std::span<const std::uint64_t> begin,
                                     std::span<const std::uint32_t> neighbours);

template <ConflictingOperator Op>
class ColourRounds {
 public:
  using Item = std::uint32_t;

  ColourRounds(const Executor& executor, Op& op)
      : executor_(executor),
        op_(op),
        made_(op),
        woken_(executor, op.resource_count()),
        turn_of_(woken_.turns()) {}

  /// Work has size() and operator[].
  RoundsReport run(const auto& work, std::size_t most_rounds) {
    UnsetVector<Item> next = known_items(executor_, work, turn_of_.size());
    while (!next.empty() && report_.rounds < most_rounds) next = run_round(next);
    report_.left = next.size();
    made_.close_holes();
    return report_;
  }

 private:
  static constexpr std::uint32_t absent = WokenItems::absent;
  static constexpr bool makes_things = kinds_made<Op> != 0;
  /// Items of a class that are planned before they are applied.
  static constexpr std::size_t most_planned = 8192;
  static constexpr LoopOptions grain{.grain = 16};
  using New = typename MadeThings<Op>::New;

  /// Data of a thread for a class.
  struct Lane {
    typename Op::Plan plan{};
    New nothing;
    std::size_t planned = 0, applied = 0;
  };
  /// An item of an operator that makes things.
  struct Slot {
    typename Op::Plan plan{};
    New fresh;
    bool is_planned = false, acts = false;
  };

  /// The argument of apply().
  struct Commit : WokenItems::Commit {
    New& numbers;
    std::uint32_t fresh(std::size_t kind = 0) const requires(makes_things) {
      return numbers.take(kind);
    }
  };

  UnsetVector<Item> run_round(std::span<const Item> work) {
    ++report_.rounds;
    woken_.begin_round();
    const ConflictClasses classes = classes_of(work);
    const auto places_of = [&](std::size_t c) {
      return std::span(classes.places)
          .subspan(classes.begin[c], classes.begin[c + 1] - classes.begin[c]);
    };
    const std::size_t count = classes.begin.size() - 1;
    for (std::size_t c = 0; c < count; ++c)
      set_turns(work, places_of(c), static_cast<std::uint32_t>(c));
    for (std::size_t c = 0; c < count; ++c)
      run_class(work, places_of(c), static_cast<std::uint32_t>(c));
    const PhaseTimer timer(report_.wake_seconds);
    set_turns(work, classes.places, absent);
    return woken_.take();
  }

  void set_turns(std::span<const Item> work, std::span<const std::uint32_t> places,
                 std::uint32_t turn) {
    parallel_for(
        executor_, places.size(), [&](std::size_t i) { turn_of_[work[places[i]]] = turn; },
        few_nanoseconds);
  }

  /// Colours the items; uses turn_of_ for their places.
  ConflictClasses classes_of(std::span<const Item> work) {
    const PhaseTimer timer(report_.conflict_seconds);
    parallel_for(executor_, work.size(), [&](std::size_t i) {
      std::atomic_ref(turn_of_[work[i]])
          .store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
    });
    std::vector<std::uint64_t> begin(work.size() + 1);
    parallel_for(executor_, work.size(), [&](std::size_t i) {
      if (turn_of_[work[i]] != i) throw_twice(work[i]);
      visit_places(work[i], [&](std::uint32_t) { ++begin[i + 1]; });
    });
    for (std::size_t i = 0; i < work.size(); ++i) begin[i + 1] += begin[i];
    auto neighbours = make_unset_vector<std::uint32_t>(executor_, begin.back());
    parallel_for(executor_, work.size(), [&](std::size_t i) {
      std::size_t at = begin[i];
      visit_places(work[i], [&](std::uint32_t place) { neighbours[at++] = place; });
    });
    return classes_of_conflicts(executor_, begin, neighbours);
  }

  /// Visits the conflicts that are in the work.
  void visit_places(Item item, auto&& visit) const {
    op_.conflicts(item, [&](Item other) {
      if (turn_of_[other] != absent) visit(turn_of_[other]);
    });
  }

  void run_class(std::span<const Item> work, std::span<const std::uint32_t> places,
                 std::uint32_t turn) {
    ++report_.batches;
    {
      const PhaseTimer timer(report_.apply_seconds);
      const std::size_t planned_before = report_.planned;
      if constexpr (makes_things) {
        for (std::size_t at = 0; at < places.size(); at += most_planned)
          run_makers(work, places.subspan(at, std::min(most_planned, places.size() - at)), turn);
      } else {
        run_items(work, places, turn);
      }
      report_.lost += places.size() - (report_.planned - planned_before);
    }
    if constexpr (DeferringOperator<Op>) {
      const PhaseTimer timer(report_.commit_seconds);
      report_.committed += op_.commit();
    }
  }

  void run_items(std::span<const Item> work, std::span<const std::uint32_t> places,
                 std::uint32_t turn) {
    PerThread<Lane> lanes(executor_);
    const auto run_item = [&](std::size_t i) {
      const Item item = work[places[i]];
      if (woken_.is_postponed(item)) return;
      Lane& lane = lanes.mine();
      ++lane.planned;
      if (!plan(item, lane.plan)) return;
      apply(item, lane.plan, turn, lane.nothing);
      ++lane.applied;
    };
    parallel_for(executor_, places.size(), run_item, grain);
    for (std::size_t t = 0; t < lanes.size(); ++t) {
      report_.planned += lanes[t].planned;
      report_.applied += lanes[t].applied;
    }
  }

  /// Plans all items, gives each the numbers it demands, and applies them.
  void run_makers(std::span<const Item> work, std::span<const std::uint32_t> places,
                  std::uint32_t turn) {
    if (slots_.size() < places.size()) slots_.resize(places.size());
    const auto slots = std::span(slots_).first(places.size());
    const auto plan_item = [&](std::size_t i) {
      const Item item = work[places[i]];
      slots[i].is_planned = !woken_.is_postponed(item);
      slots[i].acts = slots[i].is_planned && plan(item, slots[i].plan);
    };
    parallel_for(executor_, slots.size(), plan_item, grain);
    made_.number([&](auto&& number) {
      for (Slot& slot : slots)
        if (slot.acts) number(slot);
    });
    woken_.grow(op_.resource_count());
    const auto apply_item = [&](std::size_t i) {
      if (slots[i].acts) apply(work[places[i]], slots[i].plan, turn, slots[i].fresh);
    };
    parallel_for(executor_, slots.size(), apply_item, grain);
    for (const Slot& slot : slots) {
      report_.planned += slot.is_planned;
      report_.applied += slot.acts;
      if (slot.acts) made_.take_back(slot.fresh);
    }
  }

  bool plan(Item item, typename Op::Plan& plan) const {
    ReachAll reach;
    return std::as_const(op_).plan(item, plan, reach);
  }

  void apply(Item item, typename Op::Plan& plan, std::uint32_t turn, New& numbers) {
    Commit commit{{woken_, turn}, numbers};
    op_.apply(item, plan, commit);
  }

  const Executor& executor_;
  Op& op_;
  MadeThings<Op> made_;
  std::vector<Slot> slots_;  // [place among the items planned together], if things are made
  WokenItems woken_;
  UnsetVector<std::uint32_t>& turn_of_;  // [item], its class
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
