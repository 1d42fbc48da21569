/// @file
/// Operator: what an algorithm tells run_rounds about its items, and nothing about threads: how to
/// plan, what must not run beside it, how to apply a plan and how to commit a deferred write.
#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime {

template <class Op>
class Commit;

namespace detail {
template <class Op, class Check>
class Batches;
template <class Op, class Check>
class ColouredRounds;
template <class Op>
class SurveyedTiles;
template <class Op>
class OperatorCheck;
template <class Op>
class OppositeOrder;
}  // namespace detail

/// Items are ordered by operator<; those of which neither is less are one and the same.
template <class T>
concept RoundsItem = WorkItem<T> && std::default_initializable<T> && requires(const T& a) {
  { a < a } -> std::convertible_to<bool>;
};

template <class Op>
concept NamesTypes = requires {
  typename Op::Item;
  typename Op::Plan;
  typename Op::Update;
};
template <class Op>
concept Plans = requires(const Op& reader, const typename Op::Item item) {
  { reader.plan(item) } -> std::same_as<std::optional<typename Op::Plan>>;
};
template <class Op>
concept Applies = requires(Op& op, const typename Op::Plan plan, Commit<Op>& later) {
  op.apply(plan, later);
};
template <class Op>
concept Commits = requires(Op& op, std::uint32_t owner, typename Op::Update update) {
  op.commit(owner, std::move(update));
};

/// What any operator provides. `plan` and the conflict members only read; `apply` writes what the
/// item owns and defers every other write; `commit` carries one deferred write out, on behalf of
/// the owner of what it changes. All are called by many threads. Plans and updates are movable;
/// commit may take an update as Update&&.
template <class Op>
concept Operator =
    NamesTypes<Op> && RoundsItem<typename Op::Item> && Plans<Op> && Applies<Op> && Commits<Op>;

/// Items are numbers below item_count(); conflicts(item, visit) visits those it may not run beside
/// (symmetric; repetition is allowed). If applying never changes what conflicts, the operator says
/// so by a member `keeps_conflicts`; items that were woken then need not leave the round.
/// Else whoever gets a new conflict must be woken, or have it with one that is woken.
/// An item is planned when its turn comes. Who waits for it and gets another plan meanwhile is
/// woken or reconsidered, but with `keeps_conflicts`, or `forgoes_wakes` (checked_rounds.hpp).
template <class Op>
concept ColouredOperator = Operator<Op> && std::same_as<typename Op::Item, std::uint32_t> &&
    requires(const Op& op, std::uint32_t item) {
  op.conflicts(item, [](std::uint32_t) {});
  { op.item_count() } -> std::convertible_to<std::size_t>;
};

/// footprint(item, visit) visits the numbers, below resource_count(), of all that the item's plan
/// depends on and its application writes or invalidates; it visits nothing if the item is void.
template <class Op>
concept ReservingOperator = Operator<Op> && requires(const Op& op, const typename Op::Item item) {
  op.footprint(item, [](std::uint32_t) {});
  { op.resource_count() } -> std::convertible_to<std::size_t>;
};

/// An operator that makes numbered things (vertices, elements): demand(plan) says how many of each
/// kind, grow(totals) makes room for a round's and returns the first new number of each kind.
/// demand() only reads; it is asked while others plan, any number of times.
template <class Op>
concept GrowingOperator = requires(Op& op, const Op& reader, const typename Op::Plan plan) {
  op.grow(reader.demand(plan));
};

/// An operator whose items have a rank; where reservations meet, the lower priority(item) wins.
template <class Op>
concept RankedOperator = requires(const Op& op, const typename Op::Item item) {
  { op.priority(item) } -> std::convertible_to<std::uint8_t>;
};

/// An operator that can bring what an item's plan will read into the cache ahead of time, which is
/// also what its conflicts or footprint are found in. prefetch(item, stage) is called with the
/// stages 2, 1 and 0, with some other items looked at or planned between them, so that a stage can
/// follow what the one before has brought; for conflicts without stage 0, and now and then without
/// the stage before. It only reads.
template <class Op>
concept PrefetchingOperator = requires(const Op& op, const typename Op::Item item) {
  op.prefetch(item, 2);
};

/// A coloured operator of which an item may be planned while others that do not conflict with it
/// are applied: its plan reads nothing that they write, and applying wakes only the item and those
/// it conflicts with. It says so by a member `plans_on_its_own`, or `keeps_to_neighbours`, see
/// below, and asks for no new numbers. Each item is then applied right after it was planned, while
/// what it touches is in the cache.
template <class Op>
concept ImmediateOperator =
    ColouredOperator<Op> && !GrowingOperator<Op> &&
    (
        requires { Op::plans_on_its_own; } || requires { Op::keeps_to_neighbours; });

/// A coloured operator whose items need not run by classes, but may be planned and applied one by
/// one, those that do not conflict at the same time. It says so by a member `keeps_to_neighbours`:
/// a plan reads nothing that an item writes with which there is no conflict; applying defers
/// nothing and wakes only the item and those it conflicts with; what two items both write that do
/// not conflict, such as a list of a common neighbour, is guarded, and comes out the same in any
/// order. Items then run in tiles, on one thread as long as they lie together in the work. Those
/// that may not run so come back in the next round, or, with `keeps_conflicts`, run last.
template <class Op>
concept TiledOperator = ColouredOperator<Op> && PrefetchingOperator<Op> && requires {
  Op::keeps_to_neighbours;
};

/// A tiled operator whose conflicts stay, so that they need not be looked at before an item has its
/// turn. prefetch_neighbour(other) is then called instead of prefetch()'s stage 0, for each item
/// that an item conflicts with, where the work is no small part of all items.
template <class Op>
concept SteadyTiledOperator = TiledOperator<Op> && requires(const Op& op, std::uint32_t item) {
  Op::keeps_conflicts;
  op.prefetch_neighbour(item);
};

namespace detail {

template <class Op>
struct Kinds {
  static constexpr std::size_t count = 0;
};
template <GrowingOperator Op>
struct Kinds<Op> {
  static constexpr std::size_t count = std::tuple_size_v<decltype(std::declval<const Op&>().demand(
      std::declval<typename Op::Plan>()))>;
};

}  // namespace detail

/// What Commit throws for an item that is not below item_count().
class UnknownItem : public std::out_of_range {
 public:
  UnknownItem(std::uint32_t item, std::uint32_t item_count);
};

/// What an operator may do beside its own writes, handed to apply().
template <class Op>
class Commit {
 public:
  using Item = typename Op::Item;
  using Update = typename Op::Update;

  /// Commits `update` on behalf of `owner` when all of the round has been applied.
  void defer(std::uint32_t owner, Update&& update) {
    deferrer_.defer(owner, source_, std::move(update));
  }
  void defer(std::uint32_t owner, const Update& update) requires std::copy_constructible<Update> {
    deferrer_.defer(owner, source_, update);
  }

  /// Considers an item again: its plan or its conflicts may have changed. If it is in this window
  /// of the round and not yet applied, it leaves and comes back in the next round; in a later
  /// window it is planned there. Throws UnknownItem, of operators that are coloured.
  void wake(Item item) {
    if constexpr (ColouredOperator<Op>) {
      expect_known(item);
      // Relaxed: read after the barrier that ends the phase, or, in tiles, ordered by those.
      std::atomic_ref(woken_at_[item]).store(window_, std::memory_order_relaxed);
    }
    woken_->append(std::move(item));
  }

  /// Like wake() for an item whose plan may have changed, but of whose conflicts none is new save
  /// with items that are woken: if it is still to be planned in this window, it stays for its turn.
  void reconsider(Item item) requires ColouredOperator<Op> {
    expect_known(item);
    const bool waits = turn_of_[item] > turn_ && turn_of_[item] != 0xffffffffU;
    if (!waits) return wake(item);
    if (reconsidered_ != nullptr) reconsidered_->push_back(item);
  }

  /// The next of the numbers of this kind that demand() asked for.
  std::uint32_t fresh(std::size_t kind = 0) { return next_[kind]++; }

 private:
  template <class, class>
  friend class detail::Batches;
  template <class, class>
  friend class detail::ColouredRounds;
  friend class detail::SurveyedTiles<Op>;
  friend class detail::OperatorCheck<Op>;
  friend class detail::OppositeOrder<Op>;

  void expect_known(std::uint32_t item) const {
    if (item >= item_count_) [[unlikely]]
      throw UnknownItem(item, item_count_);
  }

  Deferrer<Update> deferrer_;
  Worklist<Item>* woken_ = nullptr;
  std::uint32_t* woken_at_ = nullptr;          // [item], the window it was last woken in
  const std::uint32_t* turn_of_ = nullptr;     // [item], its class in this window, or Turns
  std::uint32_t turn_ = 0;                     // that being applied
  std::vector<Item>* reconsidered_ = nullptr;  // if rounds are checked
  std::uint64_t source_ = 0;
  std::uint32_t window_ = 0;
  std::uint32_t item_count_ = 0;  // below which all items are, if they are coloured
  std::array<std::uint32_t, detail::Kinds<Op>::count> next_{};
};

}  // namespace ductile::runtime
