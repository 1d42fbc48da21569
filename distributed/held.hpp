/// @file
/// The effect of interfaces: how far edges around them are from the target length, and which
/// elements the next pass has to adapt.
#pragma once

#include <cstdint>
#include <vector>

#include "distributed/interfaces.hpp"
#include "distributed/part.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// Is an edge far from the target length? Edges just out of the usual range occur in any mesh.
inline bool is_blocked(double length) { return length > 2 || length < 0.5; }

/// Edges around shared vertices, measured in the target metric.
struct EdgesAtInterfaces {
  std::int64_t all = 0;      ///< with a shared end; edges on interfaces count on each side
  std::int64_t blocked = 0;  ///< of these
  std::vector<std::uint8_t> is_at_blocked;  ///< [vertex], 1 for shared vertices of blocked edges
};

EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces);

/// [element] 1 within `layers` layers around held vertices, and around elements with blocked edges
/// that are connected to these by such elements. Blocked edges elsewhere, as any mesh has, do not
/// count. Empty for an empty part.
std::vector<std::uint8_t> held_elements(const runtime::Executor& executor, const Part& part,
                                        int layers);

}  // namespace ductile::distributed
