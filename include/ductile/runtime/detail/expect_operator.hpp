/// @file
/// expect_operator: says at compile time what an operator lacks for run_rounds, in words, as the
/// compiler's own message for `ColouredOperator<Op> || ReservingOperator<Op>` stops at the `||`.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Without item_count(), and for items of any type.
template <class Op>
concept TellsConflicts = requires(const Op& op, const typename Op::Item item) {
  op.conflicts(item, [](std::uint32_t) {});
};

/// Without resource_count().
template <class Op>
concept TellsFootprint = requires(const Op& op, const typename Op::Item item) {
  op.footprint(item, [](std::uint32_t) {});
};

/// False, after a message, if the operator lacks what every operator has.
template <class Op>
constexpr bool expect_members() {
  static_assert(NamesTypes<Op>,
                "an operator has types Item, Plan and Update; Update is an empty struct if nothing "
                "is deferred");
  if constexpr (NamesTypes<Op>) {
    static_assert(RoundsItem<typename Op::Item>,
                  "an Item has operator< and a default constructor, and moves without throwing");
    static_assert(Plans<Op>, "an operator has std::optional<Plan> plan(Item) const");
    static_assert(Applies<Op>,
                  "an operator has apply(const Plan&, Commit<Op>&): not Plan&&, as the plan stays");
    static_assert(Commits<Op>,
                  "an operator has commit(std::uint32_t owner, Update), also if it defers nothing; "
                  "it may take const Update& or Update&&");
  }
  return Operator<Op>;
}

/// The same of what says which items may not run together.
template <class Op>
constexpr bool expect_strategy() {
  constexpr bool known = ColouredOperator<Op> || ReservingOperator<Op>;
  if constexpr (!known && TellsConflicts<Op>) {
    static_assert(ColouredOperator<Op>,
                  "an operator with conflicts() has item_count() const, and its Item is "
                  "std::uint32_t");
  } else if constexpr (!known && TellsFootprint<Op>) {
    static_assert(ReservingOperator<Op>, "an operator with footprint() has resource_count() const");
  } else {
    static_assert(known,
                  "an operator has conflicts(Item, visit) const or footprint(Item, visit) "
                  "const, which visit std::uint32_t");
  }
  return known;
}

/// Whether run_rounds can run this operator on this work; if not, after a message.
template <class Op, class Work>
constexpr bool expect_operator() {
  bool complete = false;
  if constexpr (expect_members<Op>()) {
    if constexpr (expect_strategy<Op>()) {
      // Those that are to run are moved out of it.
      complete = std::constructible_from<std::span<typename Op::Item>, Work&>;
      static_assert(std::constructible_from<std::span<typename Op::Item>, Work&>,
                    "the work is a vector of the operator's Item");
    }
  }
  return complete;
}

}  // namespace ductile::runtime::detail
