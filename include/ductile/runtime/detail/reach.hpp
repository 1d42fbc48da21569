/// @file
/// What strategies share: what plan() is handed where nobody is denied, how nobody is told, and how
/// optional members are asked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Nobody else is there.
struct ReachAll {
  static constexpr bool denied = false;
  bool operator()(std::uint32_t) const { return true; }
};

/// Notes what is reached, all of it, so that it does not depend on timing.
struct ReachToNote {
  std::vector<std::uint32_t>& reached;
  bool operator()(std::uint32_t resource) {
    reached.push_back(resource);
    return true;
  }
};

/// Where nobody wants to know which items were applied.
struct TellNobody {
  void operator()(const auto&) const {}
};

/// If the operator can.
template <class Op>
[[gnu::always_inline]] inline void prefetch_item(const Op& op, const typename Op::Item& item,
                                                 int stage) {
  if constexpr (PrefetchingOperator<Op>) op.prefetch(item, stage);
}

/// The item, if it is the number of a resource. Throws std::out_of_range.
inline std::uint32_t known(std::uint32_t item, std::size_t resource_count) {
  if (item >= resource_count) [[unlikely]]
    throw std::out_of_range("item " + std::to_string(item) +
                            " is in the work or was woken, but resource_count() is " +
                            std::to_string(resource_count));
  return item;
}

}  // namespace ductile::runtime::detail
