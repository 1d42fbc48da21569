/// @file
/// Operator: what an algorithm tells run_rounds about its items, and nothing about threads. It is
/// cautious: it reaches for everything it reads before it writes anything, and gives up if reach()
/// says so. So every strategy can run it; only the answer of reach() differs. The options and the
/// report of a run are here too.
#pragma once

#include <array>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace ductile::runtime {

/// How an Operator is run. Each strategy gives the same result at any number of threads.
enum class Strategy : std::uint8_t {
  automatic,     ///< reservations if the operator has level(), in_order if it has conflicts(), no
                 ///< place_of() and makes nothing; otherwise regions
  regions,       ///< resources are cut into regions along a space-filling curve, or by their
                 ///< numbers if there is no place_of(). One thread runs the items of a region, the
                 ///< last woken first; items that reach into another region wait for the next
                 ///< phase, whose cuts lie elsewhere. If most have to wait, one thread runs all
  in_order,      ///< in the order of the work, with the result of a plain loop over it. Items
                 ///< neither wake others nor make things. The resources that an item
                 ///< reaches may depend only on earlier items, and an item without a plan never
                 ///< gets one later
  reservations,  ///< items reserve what they reach, in windows of the work; those that hold all of
                 ///< it are applied. The lowest priority() wins, or the first in a random order of
                 ///< the work. Level by level if the operator has level()
  tiles,    ///< parts of the work, each run by one thread; of two conflicting items, the one whose
            ///< tile has the lower rank comes first. Items make nothing
  colours,  ///< classes of items without conflicts, found by speculative colouring, one class after
            ///< the other; if the operator makes things, a whole class is planned before any of it
            ///< is applied
};

/// A thing that changes its number.
struct Renumbered {
  std::uint32_t from, to;
};

namespace detail {

/// Stand-ins for what plan() and apply() receive, for the concepts.
struct AnyReach {
  bool operator()(std::uint32_t resource);
};
template <class Item>
struct AnyCommit {
  void wake(const Item& item);
  void postpone(const Item& item);
  std::uint32_t fresh(std::size_t kind = 0);
};

}  // namespace detail

/// Every operator provides:
///
///   Item                     an element of the work; small, copyable, default-constructible
///   Plan                     a decision, complete enough to be carried out. One plan is filled in
///                            again and again, so that its vectors keep their memory
///   resource_count()         resources have numbers below it
///   plan(item, plan, reach)  fills in the plan and returns true, or returns false if there is
///                            nothing to do, now and later, unless the item is woken. Const: it
///                            only reads. It calls reach(resource) before it reads what an item
///                            may write, and for what it will write itself; if that returns
///                            false, it returns false at once. It has reached for something before
///                            it returns true, and for the same thing first each time
///   apply(item, plan, commit)  carries the plan out: writes what was reached, and the new things
///                            from commit.fresh(kind). commit.wake(item) adds an item to the work,
///                            and so does commit.postpone(item), see ConflictingOperator
///
/// The types of `reach` and `commit` depend on the strategy: take them by `auto&`. Many threads
/// call all members.
template <class Op>
concept Operator = requires(const Op& reader, Op& op, const typename Op::Item& item,
                            typename Op::Plan& plan, detail::AnyReach& reach,
                            detail::AnyCommit<typename Op::Item>& commit) {
  requires std::copyable<typename Op::Item> && std::default_initializable<typename Op::Item>;
  requires std::default_initializable<typename Op::Plan>;
  { reader.plan(item, plan, reach) } -> std::same_as<bool>;
  op.apply(item, plan, commit);
  { reader.resource_count() } -> std::convertible_to<std::size_t>;
};

/// Items are numbers, equal to the resource that they reach for first; conflicts(item, visit)
/// visits all other items that it may reach or that may reach it (symmetric; repetition is
/// allowed). An item runs beside any with which it has no conflict. Two such items may both write
/// to a common neighbour, a mark (atomic.hpp) or a list under a lock, if the result is the same in
/// any order; neither may read it then.
/// An item wakes only itself and those it conflicts with; one that still waits in the round runs in
/// that round. Conflicts hold until the end of the round: if applying creates new ones, one item of
/// each pair is postponed to the next round. An operator that never changes conflicts may say so by
/// a static member `keeps_conflicts`, which saves time in tiles.
template <class Op>
concept ConflictingOperator = Operator<Op> && std::same_as<typename Op::Item, std::uint32_t> &&
    requires(const Op& op, std::uint32_t item) {
  op.conflicts(item, [](std::uint32_t) {});
};

/// In the strategy `colours`, apply() may defer writes to data shared by items of a class, using a
/// DeferredUpdate of the operator. commit() carries them out and returns their number; it is called
/// after each class, on the calling thread. No other strategy calls it.
template <class Op>
concept DeferringOperator = ConflictingOperator<Op> && requires(Op& op) {
  { op.commit() } -> std::convertible_to<std::size_t>;
};

/// Where reservations collide, the lower priority(item) wins. Items are then taken in the order of
/// the work, window by window, so priorities matter only between items that are close in it.
template <class Op>
concept RankedOperator = Operator<Op> && requires(const Op& op, const typename Op::Item& item) {
  { op.priority(item) } -> std::same_as<std::uint32_t>;
};

/// prefetch(item, stage) starts to bring the data that plan(item) will read into the cache. It is
/// called with stages 2, 1 and 0, with other items handled in between, so that a stage can follow
/// pointers that the previous one fetched; a stage may be skipped. Const; it only reads.
template <class Op>
concept PrefetchingOperator = Operator<Op> &&
    requires(const Op& op, const typename Op::Item& item) {
  op.prefetch(item, 2);
};

/// place_of(resource) is the position of a resource in 2D or 3D; resources reached together should
/// be close. It is called between phases, for existing resources. Without it, resources reached
/// together should have close numbers.
template <class Op>
concept PlacedOperator = Operator<Op> &&(
    requires(const Op& op, std::uint32_t resource) {
      { op.place_of(resource) } -> std::same_as<std::array<double, 2>>;
    } ||
    requires(const Op& op, std::uint32_t resource) {
      { op.place_of(resource) } -> std::same_as<std::array<double, 3>>;
    });

/// level(item) says when an item runs; it depends on the item alone. All items of the lowest level
/// run first, in order of arrival; items woken at the current or a lower level run at the end of
/// the current level; then the next level begins. The result is that of the equivalent plain loop
/// if, within a level, what an item reaches depends on earlier items alone, and an item without a
/// plan gets none later unless woken. Apart from what it has reached, an item may write only minima
/// that several may lower (atomic.hpp): a waiting item may lose its plan by that, and the result
/// must be the same whether it loses it in time or not.
template <class Op>
concept LevelledOperator = Operator<Op> && requires(const Op& op, const typename Op::Item& item) {
  { op.level(item) } -> std::same_as<std::uint32_t>;
};

/// An operator that makes numbered things of one or more kinds, of which the first are resources:
///
///   demand(plan)   the most of each kind that apply() will take by commit.fresh(kind)
///   counts()       the number of things of each kind; their numbers are below it
///   grow(room)     makes room, while nobody plans or applies: numbers below room[kind] may be
///                  taken. room is never below counts()
///   renumber(kind, moved, count)  after the run, even if nothing moves: each thing `from`
///                  becomes `to`, and numbers are below `count` again. Every stored number
///                  must be changed
template <class Op>
concept GrowingOperator = Operator<Op> &&
    requires(const Op& reader, Op& op, const typename Op::Plan& plan, std::size_t count,
             std::span<const Renumbered> moved) {
  reader.demand(plan)[0] + 0U;
  { reader.counts()[0] } -> std::convertible_to<std::size_t>;
  op.grow(reader.counts());
  op.renumber(count, moved, count);
};

namespace detail {

/// Number of kinds of things an operator makes.
template <class Op>
inline constexpr std::size_t kinds_made = 0;
template <GrowingOperator Op>
inline constexpr std::size_t kinds_made<Op> =
    std::tuple_size_v<decltype(std::declval<const Op&>().counts())>;

}  // namespace detail

// ---- Options and report of a run ----

/// Options of run_rounds().
struct RoundsOptions {
  Strategy strategy = Strategy::automatic;
  /// Stops after this many rounds even if work is left, and reports how much. By default a run goes
  /// on until nothing is left, which is never if the operator always wakes items. In the strategy
  /// regions woken items run in the same round. In order there is one round.
  int most_rounds = std::numeric_limits<int>::max();
};

/// Statistics of a run. Times are wall-clock; a phase's time covers all its loops and what is
/// between. If an item is applied right after it was planned, both count as applying; in_order and
/// levels time only what several threads run.
struct RoundsReport {
  std::size_t rounds = 0;
  std::size_t batches = 0;    ///< sets of items that ran together: windows, classes, or tiles
  std::size_t planned = 0;    ///< calls of plan
  std::size_t applied = 0;    ///< plans carried out
  std::size_t lost = 0;       ///< how often an item had to wait for another, or to plan again
  std::size_t committed = 0;  ///< deferred updates
  std::size_t left = 0;       ///< work that most_rounds cut off; 0 unless that is set

  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;
  double wake_seconds = 0;  ///< collecting the next round's work

  double seconds() const {
    return conflict_seconds + plan_seconds + apply_seconds + commit_seconds + wake_seconds;
  }

  RoundsReport& operator+=(const RoundsReport& other) {
    rounds += other.rounds;
    batches += other.batches;
    planned += other.planned;
    applied += other.applied;
    lost += other.lost;
    committed += other.committed;
    left += other.left;
    conflict_seconds += other.conflict_seconds;
    plan_seconds += other.plan_seconds;
    apply_seconds += other.apply_seconds;
    commit_seconds += other.commit_seconds;
    wake_seconds += other.wake_seconds;
    return *this;
  }
};

/// Adds its lifetime, in seconds, to a report. Thread safety: one thread, outside of loops; the
/// report outlives it.
class PhaseTimer {
 public:
  explicit PhaseTimer(double& seconds) : seconds_(seconds) {}
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;
  ~PhaseTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace ductile::runtime
