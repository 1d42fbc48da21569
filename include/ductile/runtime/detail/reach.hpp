/// @file
/// Shared by strategies: a reach() that denies nothing, a callback that does nothing, and calls of
/// optional members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Grants everything, because no other item runs.
struct ReachAll {
  static constexpr bool denied = false;
  bool operator()(std::uint32_t) const { return true; }
};

/// Records what is reached and grants all of it, so that the result does not depend on timing.
struct ReachToNote {
  std::vector<std::uint32_t>& reached;
  bool operator()(std::uint32_t resource) {
    reached.push_back(resource);
    return true;
  }
};

/// Ignores which items were applied.
struct TellNobody {
  void operator()(const auto&) const {}
};

/// Prefetches if the operator can.
template <class Op>
[[gnu::always_inline]] inline void prefetch_item(const Op& op, const typename Op::Item& item,
                                                 int stage) {
  if constexpr (PrefetchingOperator<Op>) op.prefetch(item, stage);
}

/// Returns the item if it is the number of a resource. Throws std::out_of_range.
inline std::uint32_t known(std::uint32_t item, std::size_t resource_count) {
  if (item >= resource_count) [[unlikely]]
    throw std::out_of_range("item " + std::to_string(item) +
                            " is in the work or was woken, but resource_count() is " +
                            std::to_string(resource_count));
  return item;
}

}  // namespace ductile::runtime::detail
