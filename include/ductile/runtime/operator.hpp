/// @file
/// Operator: what an algorithm tells run_rounds about its items, and nothing about threads.
/// It is cautious: it reaches for whatever it reads before it writes anything, and gives up where
/// it is told to. So every strategy can run it: only what reach() says differs. Options and report
/// of a run are here, too.
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

/// How an Operator is run. All but `locks` give the same result at any number of threads.
enum class Strategy : std::uint8_t {
  automatic,     ///< reservations if the operator has level(), locks if the executor need not be
                 ///< deterministic; otherwise regions if it has place_of(), in_order if it has
                 ///< conflicts(), or reservations
  regions,       ///< resources are cut into regions along a space-filling curve, and each region
                 ///< runs its items on one thread, the last woken first; what reaches into another
                 ///< region waits for the next phase, whose cuts lie elsewhere
  in_order,      ///< in the order of the work, with the result of a plain loop over it. Nobody is
                 ///< woken and nothing is made. What an item reaches depends on items before it
                 ///< alone, and one without a plan never gets one later
  reservations,  ///< items reserve what they reach, in windows of the work; those that hold all of
                 ///< it are applied. The lowest priority() wins, or whoever is first in a random
                 ///< order of the work. Level by level if the operator has level()
  tiles,    ///< stretches of the work, each run by one thread; of items with a conflict the one
            ///< whose tile has the lower rank comes first. Nothing is made
  colours,  ///< classes of items without conflicts, found by speculative colouring, one class
            ///< after the other; of an operator that makes things, a class is planned before any of
            ///< it is applied
  locks,    ///< whoever comes first: the result depends on timing. Not if the executor is to
            ///< be deterministic
};

/// A thing that is given another number.
struct Renumbered {
  std::uint32_t from, to;
};

namespace detail {

/// What plan() and apply() are handed, for the concepts.
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

/// What any operator provides:
///
///   Item                     what the work consists of; copied, so small; default-constructible
///   Plan                     a decision, complete enough to be carried out. One plan is filled in
///                            again and again, so that its vectors keep their memory
///   resource_count()         resources have numbers below it
///   plan(item, plan, reach)  fills in the plan and returns true, or returns false if there is
///                            nothing to do, now and later, unless the item is woken. Const: it
///                            only reads. It calls reach(resource) before it reads what an item
///                            may write, and for what it will write itself; where that returns
///                            false, it returns false at once. It has reached for something before
///                            it returns true, and for the same thing first each time
///   apply(item, plan, commit)  carries the plan out: writes what was reached, and what is its own
///                            by commit.fresh(kind). commit.wake(item) adds an item to the work,
///                            and so does commit.postpone(item), see ConflictingOperator
///
/// `reach` and `commit` are of types that depend on the strategy: take them by `auto&`. All members
/// are called by many threads.
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

/// Items are numbers, each that of the resource that it reaches for first; conflicts(item, visit)
/// visits all others that it may reach, of which each may reach it, too; repetition is allowed. An
/// item runs beside any with which it has no conflict. Two such may both write to a
/// common neighbour, as a mark (atomic.hpp) or a list under a lock, if that comes out the same in
/// any order; neither may read it then.
/// An item wakes only itself and those that it conflicts with; one that still waits for its turn in
/// the round has it there. Until its round is over, an item has the conflicts that it had at first:
/// if applying gives conflicts to others, one of each pair is postponed, that is, leaves the round
/// and comes back in the next. An operator that never changes conflicts may say so by a static
/// member `keeps_conflicts`, which saves time in tiles.
template <class Op>
concept ConflictingOperator = Operator<Op> && std::same_as<typename Op::Item, std::uint32_t> &&
    requires(const Op& op, std::uint32_t item) {
  op.conflicts(item, [](std::uint32_t) {});
};

/// In the strategy `colours` apply() may put off what it has to write to what several items of a
/// class share, by a DeferredUpdate of the operator's. commit() carries that out, and returns how
/// many updates there were; it is called after each class, on the calling thread. No other strategy
/// calls it.
template <class Op>
concept DeferringOperator = ConflictingOperator<Op> && requires(Op& op) {
  { op.commit() } -> std::convertible_to<std::size_t>;
};

/// Where reservations meet, the lower priority(item) wins. Items are then taken in the order of the
/// work, window by window, so the priority counts among those that are near in it.
template <class Op>
concept RankedOperator = Operator<Op> && requires(const Op& op, const typename Op::Item& item) {
  { op.priority(item) } -> std::same_as<std::uint32_t>;
};

/// prefetch(item, stage) starts to bring what plan(item) will read into the cache. It is called
/// with the stages 2, 1 and 0, with some other items looked at or planned between them, so that a
/// stage can follow what the one before has brought; now and then a stage is left out. Const, and
/// it only reads.
template <class Op>
concept PrefetchingOperator = Operator<Op> &&
    requires(const Op& op, const typename Op::Item& item) {
  op.prefetch(item, 2);
};

/// place_of(resource) is where a resource lies, in a plane or in space: what is reached together
/// lies together. It is asked for between phases, of the resources that are there.
template <class Op>
concept PlacedOperator = Operator<Op> &&(
    requires(const Op& op, std::uint32_t resource) {
      { op.place_of(resource) } -> std::same_as<std::array<double, 2>>;
    } ||
    requires(const Op& op, std::uint32_t resource) {
      { op.place_of(resource) } -> std::same_as<std::array<double, 3>>;
    });

/// level(item) says when an item runs; it follows from the item alone. All of the lowest level that
/// is there run first, in the order in which they have come; whom they wake at that level, or below
/// it, runs after them, but still in it; then the next level comes. The result is that of a plain
/// loop which does the same if, within a level, what an item reaches depends on items before it
/// alone, and one without a plan gets none later, unless it is woken. What an item writes besides
/// what it has reached may only be a minimum that several may lower (atomic.hpp): whoever waits
/// may lose its plan by that, and the end is the same whether it does in time or not.
template <class Op>
concept LevelledOperator = Operator<Op> && requires(const Op& op, const typename Op::Item& item) {
  { op.level(item) } -> std::same_as<std::uint32_t>;
};

/// An operator that makes numbered things of one or more kinds, of which the first are resources:
///
///   demand(plan)   how many of each kind apply() will take by commit.fresh(kind), at most
///   counts()       how many there are of each kind; numbers are below that
///   grow(room)     makes room, while nobody plans or applies: numbers below room[kind] may be
///                  taken. Never fewer than there are
///   renumber(kind, moved, count)  after the run, also if nothing has moved: each thing `from`
///                  becomes `to`, and numbers are below `count` again. Wherever a number is written
///                  down it must be changed
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

/// How many kinds of things an operator makes.
template <class Op>
inline constexpr std::size_t kinds_made = 0;
template <GrowingOperator Op>
inline constexpr std::size_t kinds_made<Op> =
    std::tuple_size_v<decltype(std::declval<const Op&>().counts())>;

}  // namespace detail

// ---- Options and report of a run ----

/// How run_rounds() runs an operator.
struct RoundsOptions {
  Strategy strategy = Strategy::automatic;
  /// Stop there even if work is left, and report how much. By default a run goes on until nothing
  /// is left, which is never if the operator wakes items for ever. Within one round of the
  /// strategies regions and locks whoever is woken has its turn in the same round, too. In order
  /// there is one round.
  int most_rounds = std::numeric_limits<int>::max();
};

/// What a run did. Seconds are wall-clock; a phase's are those of all its loops and what is
/// between. Where an item is applied right after it was planned, both count as applying; in order,
/// and by levels, no seconds are told.
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

  RoundsReport& operator+=(const RoundsReport& other);
};

/// Adds the time from its construction to its destruction to a report. Thread safety: one thread,
/// outside of loops; the report outlives it.
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
