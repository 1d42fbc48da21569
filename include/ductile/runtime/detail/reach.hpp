/// @file
/// What strategies share: what plan() is handed where nobody is denied, and how nobody is told.
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace ductile::runtime::detail
