/// @file
/// run_rounds: applies an operator to a set of items, and to those it wakes, until none is left.
/// The operator reaches for what it reads and writes; one of several strategies runs it
/// (operator.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/strategies.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime {

/// Applies `op`, an Operator, to `work` and to whatever it wakes, until nothing is left, or for
/// most_rounds. The work is a vector of items, or any type with size() and operator[], see
/// AllNumbers; with conflicts(), each item occurs once. With a deterministic executor the result
/// does not depend on threads or timing, provided that the operator keeps its contract. Throws what
/// the operator throws, and std::invalid_argument if the operator lacks what options.strategy
/// needs; do not use the operator's data then. Thread safety: one caller; runs on the executor, in
/// a team.
template <class Op, class Work = std::vector<typename Op::Item>>
RoundsReport run_rounds(const Executor& executor, Op& op, Work work,
                        const RoundsOptions& options = {}) {
  detail::expect_whole_operator<Op>();
  return detail::run_by_options(executor, op, std::move(work), options);
}

/// The same with a strategy known at compile time; no other is compiled. Ignores options.strategy.
template <Strategy S, class Op, class Work = std::vector<typename Op::Item>>
requires(S != Strategy::automatic) RoundsReport
    run_rounds_by(const Executor& executor, Op& op, Work work, const RoundsOptions& options = {}) {
  detail::expect_whole_operator<Op>();
  detail::expect_possible<Op>(S);
  const auto most_rounds = static_cast<std::size_t>(options.most_rounds);
  return with_team(executor,
                   [&] { return detail::run_by<S>(executor, op, std::move(work), most_rounds); });
}

/// Runs an operator by Strategy::in_order and returns the applied items, in the order of the work,
/// see run_rounds(). Fills in a report if given. Throws and thread safety as run_rounds().
template <Operator Op, class Work>
std::vector<typename Op::Item> applied_in_order(const Executor& executor, Op& op, const Work& work,
                                                RoundsReport* report = nullptr) {
  static_assert(detail::kinds_made<Op> == 0,
                "strategy in_order: the operator makes things, whose numbers follow another order");
  using Item = typename Op::Item;
  std::vector<Item> applied;
  applied.reserve(std::size(work));
  const auto note = [&](const Item& item) { applied.push_back(item); };
  detail::strategy_of<Op>({.strategy = Strategy::in_order});
  const RoundsReport run =
      with_team(executor, [&] { return detail::run_in_order(executor, op, work, note); });
  if (report != nullptr) *report = run;
  return applied;
}

/// Work that takes no memory: 0, 1, ..., size() - 1.
class AllNumbers {
 public:
  explicit AllNumbers(std::size_t count) : count_(count) {}
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t i) const { return static_cast<std::uint32_t>(i); }

 private:
  std::size_t count_;
};

}  // namespace ductile::runtime
