/// @file
/// What OperatorCheck asks about operators: names of items, whether plans are the same, and whether
/// a batch gives the same when it is applied in the opposite order.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

template <class Item>
std::string item_name(const Item& item, std::size_t place) {
  if constexpr (std::integral<Item>) {
    return std::to_string(item);
  } else if constexpr (requires {
                         { to_string(item) } -> std::convertible_to<std::string>;
                       }) {
    return to_string(item);
  } else {
    return "number " + std::to_string(place);
  }
}

template <class Op>
bool same_plan(const std::optional<typename Op::Plan>& a,
               const std::optional<typename Op::Plan>& b) {
  if constexpr (std::equality_comparable<typename Op::Plan>) return a == b;
  return a.has_value() == b.has_value();
}

/// A reserving operator need not be able to plan an item without a footprint.
template <class Op>
bool is_void(const Op& op, const typename Op::Item& item) {
  if constexpr (ReservingOperator<Op> && !ColouredOperator<Op>) {
    bool any = false;
    op.footprint(item, [&](std::uint32_t) { any = true; });
    return !any;
  }
  return false;
}

template <class Op>
void commit_all(Op& op, DeferredUpdate<typename Op::Update>& deferred) {
  deferred.commit([&](std::uint32_t owner, typename Op::Update& update) {
    op.commit(owner, std::move(update));
  });
}

/// A copy of the operator that has applied a batch in the opposite order, if it can be compared.
template <class Op>
class OppositeOrder {
 public:
  OppositeOrder(const Op& op, const std::vector<std::optional<typename Op::Plan>>& plans,
                const std::vector<Commit<Op>>& commits, CommitOrder order) {
    if constexpr (comparable) {
      const Executor alone({.threads = 1});
      DeferredUpdate<typename Op::Update> deferred(alone, {.order = order});
      Worklist<typename Op::Item> woken(alone);
      std::vector<std::uint32_t> woken_at;
      if constexpr (ColouredOperator<Op>) woken_at.resize(op.item_count());
      twin_.emplace(op);
      for (std::size_t i = plans.size(); i-- > 0;) {
        Commit<Op> commit = commits[i];
        commit.deferrer_ = deferred.deferrer();
        commit.woken_ = &woken;
        commit.woken_at_ = woken_at.data();
        commit.reconsidered_ = nullptr;
        try {
          if (plans[i]) twin_->apply(*plans[i], commit);
        } catch (const UnknownItem&) {
          twin_.reset();  // in the right order it is thrown, too, and told
          return;
        }
      }
      commit_all(*twin_, deferred);
    }
  }

  bool agrees(const Op& op) const { return !twin_ || same(op); }

 private:
  bool same([[maybe_unused]] const Op& op) const {
    if constexpr (comparable) return *twin_ == op;
    return true;
  }

  static constexpr bool comparable = std::equality_comparable<Op> && std::copyable<Op>;
  std::optional<Op> twin_;
};

}  // namespace ductile::runtime::detail
