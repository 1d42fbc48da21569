/// @file
/// ColouredRounds: cuts a round's work into classes of items that do not conflict, by colouring
/// their conflict graph, for operators of which most items act. Those that can run in tiles instead
/// do so.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/detail/batches.hpp"
#include "ductile/runtime/detail/surveyed_tiles.hpp"
#include "ductile/runtime/detail/tiles.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/rounds_report.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::detail {

/// What colour() does, without the methods and widths of words that conflicts have no use for: a
/// program compiles what is named here for each of its operators.
template <class G>
Colouring colour_conflicts(const Executor& executor, const G& graph) {
  Colouring colouring;
  colouring.colour_of.resize(graph.vertex_count(), Colouring::none);
  const VertexSet all{graph.vertex_count()};
  const Colours<FourBytes<>> colours(colouring.colour_of);
  if (all.count >= few_vertices) {
    using Width = Narrow<>;
    std::vector<std::uint8_t> bytes(all.count, Colours<Width>::none);
    if (colour_in<Blocked, Width>(executor, graph, bytes, all)) {
      colouring.count = widen(executor, bytes, colouring.colour_of);
      return colouring;
    }
    Blocked::run(executor, AnyGraph(graph), all, colours);
  } else {
    Serial::run(executor, graph, all, colours);
  }
  colouring.count = colour_count(executor, colouring.colour_of);
  return colouring;
}

/// Which items of a window conflict, as a graph of their places in its work.
template <class Op>
class ConflictGraph {
 public:
  static constexpr std::uint32_t absent = 0xffffffffU;
  static constexpr std::size_t prefetch_distance = 6;

  /// `place_of` is absent for items that are not in the work.
  ConflictGraph(const Op& op, std::span<const typename Op::Item> work,
                const std::uint32_t* place_of)
      : op_(op), work_(work), place_of_(place_of) {}

  std::size_t vertex_count() const { return work_.size(); }
  void for_each_neighbour(std::uint32_t place, auto&& visit) const {
    op_.conflicts(work_[place], [&](typename Op::Item other) {
      if (place_of_[other] != absent) visit(place_of_[other]);
    });
  }
  /// Places are mostly asked for one after the other: what the second stage needs has come then.
  [[gnu::always_inline]] void prefetch(std::uint32_t place) const requires PrefetchingOperator<Op> {
    constexpr std::uint32_t behind = 3;
    op_.prefetch(work_[place], 2);
    if (place >= behind) op_.prefetch(work_[place - behind], 1);
  }

 private:
  const Op& op_;
  std::span<const typename Op::Item> work_;
  const std::uint32_t* place_of_;  // [item]
};

template <class Op, class Check>
class ColouredRounds {
 public:
  using Item = typename Op::Item;

  explicit ColouredRounds(Batches<Op, Check>& batches) : batches_(batches) {}

  /// Returns the work of the next round.
  UnsetVector<Item> run(auto work) {
    provide_items();
    if constexpr (TiledOperator<Op> && !Check::on) {
      run_in_tiles(std::move(work));
    } else {
      run_by_classes(work);
    }
    const UnsetVector<Item> woken = batches_.take_woken();
    // Who was woken and planned after that has been considered again.
    const auto find = [&](std::size_t i, auto&& append) {
      if (woken_at_[woken[i]] != 0) append(woken[i]);
    };
    return parallel_collect<Item>(executor_, woken.size(), find, few_nanoseconds.serial_below);
  }

 private:
  static constexpr std::uint32_t absent = ConflictGraph<Op>::absent;
  static_assert(absent == Turns::absent);

  /// New items of a growing operator may be woken, and conflict, in the round that makes them.
  void provide_items() {
    grow_filled(executor_, woken_at_, op_.item_count(), 0);
    grow_filled(executor_, turn_of_, op_.item_count(), absent);
  }

  void run_in_tiles(auto work) {
    UnsetVector<Item> left = run_first_tiles(std::move(work));
    while (!left.empty()) left = run_surveyed(left);
  }

  /// Returns the items that are left.
  UnsetVector<Item> run_first_tiles(auto work) {
    if constexpr (SteadyTiledOperator<Op>)
      if (!Tiles<Op>::are_few(work.size(), op_.item_count())) return run_tiles(work);
    return run_surveyed(work);
  }

  /// Sorts the work. Returns the items that are left.
  UnsetVector<Item> run_tiles(std::span<Item> work) {
    RoundsReport& report = batches_.report;
    const PhaseTimer timer(report.plan_seconds);
    ++window_;
    parallel_sort(executor_, work);  // which mostly is in order
    Tiles<Op> tiles(executor_, op_, work);
    tiles.run([&] { return new_commit(); }, [&](Item item) { note_planned(item); });
    const UnsetVector<std::uint8_t>& is_left = tiles.left();
    const auto find = [&](std::size_t i, auto&& append) {
      if (is_left[i] != 0) append(work[i]);
    };
    auto left = parallel_collect<Item>(executor_, work.size(), find, few_nanoseconds.serial_below);
    ++report.batches;
    report.planned += work.size() - left.size();
    report.applied += tiles.applied();
    return left;
  }

  /// Returns the items that are to run in the same round yet. Where conflicts change, those that
  /// are late wait for the next round, as all that are woken do.
  UnsetVector<Item> run_surveyed(std::span<const Item> all) {
    constexpr bool stays = requires { Op::keeps_conflicts; };
    const std::span<const Item> work =
        all.first(std::min<std::size_t>(all.size(), Turns::most_items));
    RoundsReport& report = batches_.report;
    ++window_;
    std::optional<SurveyedTiles<Op>> tiles;
    {
      const PhaseTimer timer(report.conflict_seconds);
      tiles.emplace(executor_, op_, work, turn_of_.data());
    }
    const PhaseTimer timer(report.plan_seconds);
    tiles->run([&] { return new_commit(); }, [&](Item item) { return is_here(item); },
               [&](Item item) { note_planned(item); },
               [](Item item, Commit<Op>& commit) {
                 if (!stays) commit.wake(item);
               });
    const auto [planned, applied] = tiles->counts();
    ++report.batches;
    report.planned += planned;
    report.applied += applied;
    if (!stays) report.dropped += work.size() - planned;
    const auto find_left = [&](std::size_t i, auto&& append) {
      turn_of_[all[i]] = absent;
      if (i >= work.size() || (stays && tiles->is_late(i))) append(all[i]);
    };
    return parallel_collect<Item>(executor_, all.size(), find_left, few_nanoseconds.serial_below);
  }

  /// Goes over the work window by window, so that what one window's classes touch stays in cache.
  void run_by_classes(std::span<const Item> work) {
    const std::size_t largest = Check::on ? 0 : batches_.options.window;
    for_each_window(work, window_count(work.size(), largest),
                    [&](std::span<const Item> part) { run_window(part); });
  }

  void run_window(std::span<const Item> work) {
    ++window_;
    std::vector<std::size_t> class_begin;
    {
      const PhaseTimer timer(batches_.report.conflict_seconds);
      class_begin = sort_by_class(work);
    }
    const std::size_t classes = class_begin.size() - 1;
    for (turn_ = 0; turn_ < classes; ++turn_) {
      const std::size_t begin = class_begin[turn_], end = class_begin[turn_ + 1];
      batches_.run(
          std::span(by_class_).subspan(begin, end - begin),
          [&](Item item) { return is_here(item); }, [&](Item item) { note_planned(item); },
          [&] { return new_commit(); }, [&] { provide_items(); });
      if constexpr (Check::on) check_waiting(end);
    }
    parallel_for(
        executor_, work.size(), [&](std::size_t i) { turn_of_[work[i]] = absent; },
        few_nanoseconds);
  }

  /// Sets by_class_ to the work sorted into classes of items that do not conflict, and turn_of_ to
  /// the items' classes. Returns where each class begins, and the end.
  std::vector<std::size_t> sort_by_class(std::span<const Item> work) {
    parallel_for(
        executor_, work.size(),
        [&](std::size_t i) { turn_of_[work[i]] = static_cast<std::uint32_t>(i); }, few_nanoseconds);
    const ConflictGraph<Op> graph(op_, work, turn_of_.data());
    const Colouring colouring = colour_conflicts(executor_, graph);
    ColourClasses classes = colour_classes(executor_, colouring);
    by_class_.resize(work.size());
    const auto place = [&](std::size_t i) {
      by_class_[i] = work[classes.vertices[i]];
      turn_of_[work[i]] = colouring.colour_of[i];
    };
    parallel_for(executor_, work.size(), place, few_nanoseconds);
    return std::move(classes.begin);
  }

  /// Whether an item is still in the round. A colouring is stale where something changed: who was
  /// woken in this window comes back in the next round. Also asked ahead of an item that another
  /// thread plans meanwhile: what it reads is either of two that say the same.
  bool is_here(Item item) {
    if constexpr (requires { Op::keeps_conflicts; }) return true;
    return std::atomic_ref(woken_at_[item]).load(std::memory_order_relaxed) != window_;
  }
  void note_planned(Item item) {
    std::atomic_ref(woken_at_[item]).store(0, std::memory_order_relaxed);
  }

  Commit<Op> new_commit() {
    Commit<Op> commit = batches_.new_commit(window_);
    commit.woken_at_ = woken_at_.data();
    commit.turn_of_ = turn_of_.data();
    commit.item_count_ = static_cast<std::uint32_t>(woken_at_.size());
    commit.turn_ = static_cast<std::uint32_t>(turn_);
    return commit;
  }

  /// Those that wait for a later turn begin here.
  void check_waiting(std::size_t begin) {
    const auto is_waiting = [&](Item item) {
      return turn_of_[item] > turn_ && turn_of_[item] != absent && woken_at_[item] != window_;
    };
    for (std::size_t i = begin; i < by_class_.size(); ++i)
      if (is_waiting(by_class_[i])) batches_.check.expect_kept(op_, by_class_[i], is_waiting);
  }

  Batches<Op, Check>& batches_;
  const Executor& executor_ = batches_.executor;
  Op& op_ = batches_.op;
  UnsetVector<std::uint32_t> woken_at_;  // [item], the window, or 0 if planned since
  UnsetVector<std::uint32_t> turn_of_;   // [item], its place in the window's work, then its class;
                                         // or its turn in tiles (Turns); or absent
  UnsetVector<Item> by_class_;           // the window's work, class after class
  std::size_t turn_ = 0;                 // class being executed
  std::uint32_t window_ = 0;             // the window being run
};

}  // namespace ductile::runtime::detail
