/// @file
/// Rounds: the machinery behind run_rounds. A batch is a list of items that may run together; both
/// strategies only differ in how they cut a round's work into batches. Plans are kept by position
/// in the batch, and numbers of new things are handed out by a prefix sum over those positions,
/// so nothing depends on which thread did what.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic_count.hpp"
#include "ductile/runtime/atomic_min.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/colouring.hpp"
#include "ductile/runtime/detail/filled_array.hpp"
#include "ductile/runtime/detail/slots.hpp"
#include "ductile/runtime/detail/tiles.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/phase_timer.hpp"
#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/rounds_report.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime {

/// Instead of detail::OperatorCheck: nothing is checked.
struct NoCheck {
  static constexpr bool on = false;
};

template <class Op, class Check = NoCheck>
class Rounds {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;
  using Update = typename Op::Update;

  Rounds(const Executor& executor, Op& op, const RoundsOptions& options)
      : executor_(executor),
        op_(op),
        options_(options),
        recording_(executor.recording()),
        deferred_(executor, {.order = executor.deterministic() ? options.order : CommitOrder::any}),
        woken_(executor, {.order = WorkOrder::by_item, .unique = true}) {}

  RoundsReport run(std::vector<Item> work) {
    for (int round = 1; !work.empty() && round <= options_.most_rounds; ++round) {
      ++report_.rounds;
      if (recording_ != nullptr) recording_->begin_round();
      if constexpr (Check::on) check_.begin_round(op_, static_cast<std::uint32_t>(round), work);
      if constexpr (ColouredOperator<Op>) {
        work = coloured_round(std::move(work));
      } else {
        work = reserved_round(std::move(work));
      }
    }
    if (recording_ != nullptr) recording_->end_rounds();
    report_.left = work.size();
    return report_;
  }

 private:
  static constexpr std::size_t kinds = detail::Kinds<Op>::count;
  static constexpr std::size_t block = 32;  // of what takes well under a microsecond an item
  static constexpr LoopOptions by_block{.grain = 1, .serial_below = 3};
  static constexpr LoopOptions copying{.grain = 512, .serial_below = 2048};

  /// Items handed out at once to be planned or applied: few of a small batch, so that each of many
  /// threads gets some.
  static std::size_t block_of(std::size_t items) {
    return std::clamp<std::size_t>(items / 1024, 4, block);
  }

  /// Cuts a round's work into parts of at most so many items, which run one after the other; 0: it
  /// is one part.
  void for_each_window(std::span<Item> work, std::size_t largest, auto&& run) {
    const std::size_t n = work.size();
    const std::size_t windows = Check::on || largest == 0 ? 1 : (n + largest - 1) / largest;
    for (std::size_t w = 0; w < windows; ++w) {
      // Where the numbers of windows in keys begin anew, what was reserved is forgotten.
      if ((++window_ & last_window) == 0) reserved_ = {};
      const std::size_t begin = n * w / windows, end = n * (w + 1) / windows;
      run(work.subspan(begin, end - begin));
    }
  }

  // ---- Colouring: cut the round into classes of items that do not conflict ----

  /// Goes over the work window by window, so that what one window's classes touch stays in cache.
  std::vector<Item> coloured_round(std::vector<Item> work) requires ColouredOperator<Op> {
    woken_at_.resize(executor_, op_.item_count(), 0);
    turn_of_.resize(executor_, op_.item_count(), absent);
    if constexpr (TiledOperator<Op> && !Check::on) work = run_tiles(std::move(work));
    for_each_window(work, options_.window, [&](std::span<const Item> part) { run_window(part); });
    const std::vector<Item> woken = take_woken();
    // Who was woken by one window and planned in a later one has been considered again.
    return parallel_collect<Item>(executor_, woken.size(), [&](std::size_t i, auto&& append) {
      if (woken_at_[woken[i]] != 0) append(woken[i]);
    });
  }

  /// Returns what has to wait for the classes.
  std::vector<Item> run_tiles(std::vector<Item> work) requires TiledOperator<Op> {
    using Tiles = detail::Tiles<Op>;
    if (Tiles::are_few(work.size(), op_.item_count())) return work;
    const PhaseTimer timer(report_.plan_seconds, executor_, Phase::plan);
    ++window_;
    if (!std::is_sorted(work.begin(), work.end())) parallel_sort(executor_, std::span(work));
    Tiles tiles(executor_, op_, work);
    tiles.run([&] { return new_commit(); }, [&](Item item) { woken_at_[item] = 0; });
    std::vector<Item> left = select(work, tiles.waits(), waits);
    report_.batches += tiles.steps();
    report_.planned += work.size() - left.size();
    report_.applied += tiles.applied();
    return left;
  }

  void run_window(std::span<const Item> work) {
    std::vector<std::size_t> class_begin;
    {
      const PhaseTimer timer(report_.conflict_seconds, executor_, Phase::conflict);
      class_begin = sort_by_class(work);
    }
    const std::size_t classes = class_begin.size() - 1;
    for (turn_ = 0; turn_ < classes; ++turn_) {
      execute(std::span(by_class_).subspan(class_begin[turn_],
                                           class_begin[turn_ + 1] - class_begin[turn_]));
      if constexpr (Check::on) check_waiting(class_begin[turn_ + 1]);
    }
    parallel_for(
        executor_, work.size(), [&](std::size_t i) { turn_of_[work[i]] = absent; }, copying);
  }

  /// Sets by_class_ to the work sorted into classes of items that do not conflict, and turn_of_ to
  /// the items' classes. Returns where each class begins, and the end.
  std::vector<std::size_t> sort_by_class(std::span<const Item> work) {
    parallel_for(
        executor_, work.size(),
        [&](std::size_t i) { turn_of_[work[i]] = static_cast<std::uint32_t>(i); }, copying);
    const CallbackGraph graph(work.size(), [&](std::uint32_t i, auto&& visit) {
      op_.conflicts(work[i], [&](Item other) {
        if (turn_of_[other] != absent) visit(turn_of_[other]);
      });
    });
    const Colouring colouring = colour_conflicts(graph);
    ColourClasses classes = colour_classes(executor_, colouring);
    by_class_.resize(work.size());
    const auto place = [&](std::size_t i) {
      by_class_[i] = work[classes.vertices[i]];
      turn_of_[work[i]] = colouring.colour_of[i];
    };
    parallel_for(executor_, work.size(), place, copying);
    return std::move(classes.begin);
  }

  /// What colour() does, without the methods and widths of words that conflicts have no use for: a
  /// program compiles what is named here for each of its operators.
  template <class G>
  Colouring colour_conflicts(const G& graph) const {
    Colouring colouring;
    colouring.colour_of.resize(graph.vertex_count(), Colouring::none);
    const detail::VertexSet all{graph.vertex_count()};
    const detail::Colours<detail::FourBytes<>> colours(colouring.colour_of);
    if (all.count >= detail::few_vertices) {
      using Width = detail::Narrow<>;
      std::vector<std::uint8_t> bytes(all.count, detail::Colours<Width>::none);
      if (detail::colour_in<detail::Blocked, Width>(executor_, graph, bytes, all)) {
        colouring.count = detail::widen(executor_, bytes, colouring.colour_of);
        return colouring;
      }
      detail::Blocked::run(executor_, AnyGraph(graph), all, colours);
    } else {
      detail::Serial::run(executor_, graph, all, colours);
    }
    colouring.count = detail::colour_count(executor_, colouring.colour_of);
    return colouring;
  }

  /// A colouring is stale where something changed: who was woken in this window comes back in the
  /// next round.
  bool stays(const Item& item) const {
    if constexpr (ColouredOperator<Op> && !requires { Op::keeps_conflicts; })
      return woken_at_[item] != window_;
    return true;
  }

  /// Those that wait for a later turn begin here.
  void check_waiting(std::size_t begin) {
    const auto is_waiting = [&](const Item& item) {
      return turn_of_[item] > turn_ && turn_of_[item] != absent && woken_at_[item] != window_;
    };
    for (std::size_t i = begin; i < by_class_.size(); ++i)
      if (is_waiting(by_class_[i])) check_.expect_kept(op_, by_class_[i], is_waiting);
  }

  // ---- Reservation: the highest priority on all of its footprint runs, the others wait ----

  /// Goes over the work window by window, so that what is reserved, planned and applied one after
  /// the other stays in cache.
  std::vector<Item> reserved_round(std::vector<Item> work) requires ReservingOperator<Op> {
    std::vector<Item> rest;
    for_each_window(work, options_.reserving_window,
                    [&](std::span<Item> part) { reserve_and_run(part, rest); });
    std::vector<Item> woken = take_woken();
    append(rest, woken);
    return rest;
  }

  static void append(std::vector<Item>& to, std::vector<Item>& items) {
    to.insert(to.end(), std::make_move_iterator(items.begin()),
              std::make_move_iterator(items.end()));
  }

  /// Runs the items of a window that win, and appends those that have to wait to `rest`.
  void reserve_and_run(std::span<Item> work, std::vector<Item>& rest) {
    std::vector<std::uint8_t> outcome(work.size());
    {
      const PhaseTimer timer(report_.conflict_seconds, executor_, Phase::conflict);
      reserved_.resize(executor_, op_.resource_count(), ~std::uint64_t{0});
      if (!executor_.deterministic()) ticket_of_.resize(work.size());
      parallel_for_blocks(
          executor_, work.size(), block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              outcome[i] = asks(i) ? reserve(work[i], i) : passes;
          },
          by_block);
      parallel_for_blocks(
          executor_, work.size(), block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              if (outcome[i] == waits && holds_all(work[i], i)) outcome[i] = runs;
          },
          by_block);
    }
    std::vector<Item> winners = select(work, outcome, runs);
    std::vector<Item> losers = select(work, outcome, waits | passes);
    const std::size_t lost = losers.size() - (share_ < everyone ? count(outcome, passes) : 0);
    report_.lost += lost;
    adapt_share(winners.size(), lost);
    execute(winners);
    append(rest, losers);
  }

  /// Whether the item at this position asks for its footprint in this window.
  bool asks(std::size_t position) const {
    if (share_ == everyone) return true;
    return mix32(static_cast<std::uint32_t>(position) ^ (window_ * 0x85ebca6bU)) <= share_;
  }

  /// Fewer ask in the next window if too few of those that asked won, and more if most did.
  void adapt_share(std::size_t won, std::size_t lost) {
    const double asked = static_cast<double>(won + lost), wanted = options_.least_won * asked;
    if (won + lost < block || static_cast<double>(won) > (asked + wanted) / 2) {
      share_ = share_ > everyone / 2 ? everyone : 2 * share_ + 1;
    } else if (static_cast<double>(won) < wanted) {
      share_ /= 2;
    }
  }

  std::size_t count(const std::vector<std::uint8_t>& outcome, std::uint8_t wanted) const {
    const auto one_if_wanted = [&](std::size_t i) -> std::size_t { return outcome[i] == wanted; };
    const auto sum = [](std::size_t a, std::size_t b) { return a + b; };
    return parallel_reduce(executor_, outcome.size(), std::size_t{0}, one_if_wanted, sum);
  }

  /// A later window always has the lower key, so reservations never have to be cleared.
  std::uint64_t key_of(const Item& item, std::size_t position) {
    std::uint64_t rank = 0;
    if constexpr (RankedOperator<Op>) rank = op_.priority(item);
    const auto place = static_cast<std::uint32_t>(position);
    const std::uint32_t tie =
        executor_.deterministic() ? mix32(place ^ (window_ * 0x9e3779b9U)) : ticket_of_[position];
    return (std::uint64_t{~window_ & last_window} << 40U) | (rank << 32U) | tie;
  }

  std::uint8_t reserve(const Item& item, std::size_t position) {
    if (!executor_.deterministic()) ticket_of_[position] = atomic_count(ticket_);
    const std::uint64_t key = key_of(item, position);
    bool any = false;
    op_.footprint(item, [&](std::uint32_t resource) {
      atomic_min(reserved_[resource], key);
      any = true;
    });
    return any ? waits : gone;
  }

  bool holds_all(const Item& item, std::size_t position) {
    const std::uint64_t key = key_of(item, position);
    bool all = true;
    op_.footprint(item, [&](std::uint32_t resource) { all = all && reserved_[resource] == key; });
    return all;
  }

  /// Moves the items with one of these outcomes out of the work, in order.
  std::vector<Item> select(std::span<Item> work, const std::vector<std::uint8_t>& outcome,
                           std::uint8_t wanted) {
    std::vector<std::uint32_t> offset((work.size() + block - 1) / block);
    parallel_for_blocks(
        executor_, work.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) offset[b] += (outcome[i] & wanted) != 0;
        },
        by_block);
    std::vector<Item> selected(exclusive_scan<std::uint32_t>(executor_, offset));
    parallel_for_blocks(
        executor_, work.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          std::uint32_t at = offset[b];
          for (std::size_t i = begin; i < end; ++i)
            if ((outcome[i] & wanted) != 0) selected[at++] = std::move(work[i]);
        },
        by_block);
    return selected;
  }

  // ---- One batch: plan, apply, commit ----

  void execute(std::span<const Item> batch) {
    if (batch.empty()) return;
    ++report_.batches;
    size_ = batch.size();
    block_size_ = block_of(size_);
    const std::size_t blocks = (size_ + block_size_ - 1) / block_size_;
    plans_.provide(executor_, size_);
    planned_of_.assign(blocks, 0);
    {
      const PhaseTimer timer(report_.plan_seconds, executor_, Phase::plan);
      parallel_for_blocks(
          executor_, size_, block_size_,
          [&](std::size_t b, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
              if constexpr (PrefetchingOperator<Op>) prefetch_after(batch, i);
              planned_of_[b] += plan(batch[i], plans_[i]);
            }
          },
          by_block);
    }
    const std::size_t planned = std::accumulate(planned_of_.begin(), planned_of_.end(), 0U);
    report_.planned += planned;
    report_.dropped += size_ - planned;
    if constexpr (Check::on) return apply_checked(batch);
    {
      const PhaseTimer timer(report_.apply_seconds, executor_, Phase::apply);
      apply_plans(blocks);
    }
    const PhaseTimer timer(report_.commit_seconds, executor_, Phase::commit);
    report_.committed += deferred_.commit(
        [&](std::uint32_t owner, Update& update) { op_.commit(owner, std::move(update)); });
  }

  /// What memory takes to answer is about as long as planning two items.
  void prefetch_after(std::span<const Item> batch, std::size_t i) const {
    for (const int stage : {2, 1, 0}) {
      const std::size_t ahead = i + 2 * (static_cast<std::size_t>(stage) + 1);
      if (ahead < batch.size()) op_.prefetch(batch[ahead], stage);
    }
  }

  /// Plans an item, unless it left the round; false then.
  bool plan(const Item& item, std::optional<Plan>& plan) {
    const bool here = stays(item);
    if constexpr (ColouredOperator<Op>)
      if (here) woken_at_[item] = 0;
    if (here) {
      plan = op_.plan(item);
    } else {
      plan.reset();
    }
    if (recording_ != nullptr) [[unlikely]]
      record_plan(item);
    return here;
  }

  void apply_plans(std::size_t blocks) {
    first_of_.assign(blocks, {});
    applied_of_.assign(blocks, 0);
    if constexpr (kinds > 0) number_new_things();
    parallel_for_blocks(
        executor_, size_, block_size_,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          Commit<Op> commit = new_commit();
          commit.next_ = first_of_[b];
          for (std::size_t i = begin; i < end; ++i) {
            if (plans_[i]) {
              commit.source_ = i;
              op_.apply(*plans_[i], commit);
              ++applied_of_[b];
            }
            if (recording_ != nullptr) [[unlikely]]
              record_apply(plans_[i]);
          }
        },
        by_block);
    for (const std::uint32_t applied : applied_of_) report_.applied += applied;
  }

  void apply_checked(std::span<const Item> all) {
    std::vector<Item> batch;
    std::vector<std::optional<Plan>> plans;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (stays(all[i])) batch.push_back(all[i]), plans.push_back(std::move(plans_[i]));
    std::vector<Commit<Op>> commits(batch.size(), new_commit());
    for (std::size_t i = 0; i < batch.size(); ++i) commits[i].source_ = i;
    report_.applied += batch.size() - std::count(plans.begin(), plans.end(), std::nullopt);
    if constexpr (kinds > 0) number_one_by_one(plans, commits);
    check_.run_batch(op_, {batch, plans, commits}, deferred_, options_.order);
  }

  /// Sets first_of_ to the first new number of each kind for each block of the batch.
  void number_new_things() {
    parallel_for_blocks(
        executor_, size_, block_size_,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            if (!plans_[i]) continue;
            const auto demand = op_.demand(*plans_[i]);
            for (std::size_t k = 0; k < kinds; ++k) first_of_[b][k] += demand[k];
          }
        },
        by_block);
    std::array<std::uint32_t, kinds> total{};
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) total[k] += std::exchange(first[k], total[k]);
    const std::array<std::uint32_t, kinds> base = op_.grow(total);
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) first[k] += base[k];
  }

  /// The same for the commits of single items.
  void number_one_by_one(const std::vector<std::optional<Plan>>& plans,
                         std::vector<Commit<Op>>& commits) {
    std::array<std::uint32_t, kinds> total{};
    for (std::size_t i = 0; i < plans.size(); ++i) {
      commits[i].next_ = total;
      if (!plans[i]) continue;
      const auto demand = op_.demand(*plans[i]);
      for (std::size_t k = 0; k < kinds; ++k) total[k] += demand[k];
    }
    const std::array<std::uint32_t, kinds> base = op_.grow(total);
    for (Commit<Op>& commit : commits)
      for (std::size_t k = 0; k < kinds; ++k) commit.next_[k] += base[k];
  }

  Commit<Op> new_commit() {
    Commit<Op> commit;
    commit.deferrer_ = deferred_.deferrer();
    commit.woken_ = &woken_;
    if constexpr (ColouredOperator<Op>) {
      commit.woken_at_ = woken_at_.data();
      commit.turn_of_ = turn_of_.data();
      commit.turn_ = static_cast<std::uint32_t>(turn_);
    }
    commit.window_ = window_;
    if constexpr (Check::on) commit.reconsidered_ = &check_.reconsidered;
    return commit;
  }

  void record_plan(const Item& item) {
    if constexpr (requires { op_.plan_cost(item); }) {
      recording_->end_item(op_.plan_cost(item));
    } else {
      recording_->end_item();
    }
  }

  void record_apply(const std::optional<Plan>& plan) {
    if constexpr (requires { op_.apply_cost(*plan); }) {
      recording_->end_item(plan ? op_.apply_cost(*plan) : 0.0);
    } else {
      recording_->end_item();
    }
  }

  std::vector<Item> take_woken() {
    const PhaseTimer timer(report_.wake_seconds, executor_, Phase::wake);
    woken_.collect();
    report_.woken += woken_.size();
    if constexpr (Check::on) {
      const auto items = woken_.items();
      check_.end_round(op_, {items.begin(), items.end()});
    }
    return woken_.take();
  }

  static constexpr std::uint32_t absent = 0xffffffffU;
  static constexpr std::uint8_t gone = 0, waits = 1, runs = 2, passes = 4;
  static constexpr std::uint32_t everyone = 0xffffffffU, last_window = 0xffffffU;

  const Executor& executor_;
  Op& op_;
  RoundsOptions options_;
  [[no_unique_address]] Check check_;
  RoundsReport report_;
  Recording* recording_;  // null but for replays
  DeferredUpdate<Update> deferred_;
  Worklist<Item> woken_;
  std::uint32_t window_ = 0;  // the window being run

  // ---- Colouring ----
  detail::FilledArray<std::uint32_t> woken_at_;  // [item], the window, or 0 if planned since
  detail::FilledArray<std::uint32_t> turn_of_;   // [item], its place in the window's work, then its
                                                 // class, or absent
  std::vector<Item> by_class_;                   // the window's work, class after class
  std::size_t turn_ = 0;                         // class being executed

  // ---- Reservation ----
  detail::FilledArray<std::uint64_t> reserved_;  // [resource], the lowest key that asked
  std::vector<std::uint32_t> ticket_of_;         // [position], racing mode: order of arrival
  std::uint32_t ticket_ = 0;
  std::uint32_t share_ = everyone;  // who has a hash up to this asks

  // ---- The batch ----
  std::size_t size_ = 0, block_size_ = 1;  // its items, and those of a block
  detail::Slots<Plan> plans_;              // [position]; there may be old ones beyond its size
  std::vector<std::uint32_t> planned_of_;  // [block]
  std::vector<std::array<std::uint32_t, kinds>> first_of_;  // [block][kind]
  std::vector<std::uint32_t> applied_of_;                   // [block]
};

}  // namespace ductile::runtime
