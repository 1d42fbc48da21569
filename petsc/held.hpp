/// @file
/// What interfaces hold: how far edges around them are from what is wanted, and which elements the
/// next pass has to adapt.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Far from what is wanted; what is just out of the usual range may be so on any mesh.
inline bool is_blocked(double length) { return length > 2 || length < 0.5; }

/// Edges around shared vertices, measured by what is wanted.
struct EdgesAtInterfaces {
  std::int64_t all = 0;      ///< with an end that is shared; those on interfaces count on each side
  std::int64_t blocked = 0;  ///< of these
  std::vector<std::uint8_t> is_at_blocked;  ///< [vertex], 1 of shared ones at an end of these
};

template <int Dim>
EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces);

/// [element] 1 of those in `layers` layers around vertices that were held, and around elements with
/// blocked edges that are connected with these by others. Blocked edges elsewhere, which any mesh
/// may have, do not count. Empty of an empty part.
template <int Dim>
std::vector<std::uint8_t> held_elements(const runtime::Executor& executor, const Part& part,
                                        int layers);

extern template EdgesAtInterfaces edges_at_interfaces<2>(const Part&, const Interfaces&);
extern template EdgesAtInterfaces edges_at_interfaces<3>(const Part&, const Interfaces&);
extern template std::vector<std::uint8_t> held_elements<2>(const runtime::Executor&, const Part&,
                                                           int);
extern template std::vector<std::uint8_t> held_elements<3>(const runtime::Executor&, const Part&,
                                                           int);

}  // namespace ductile::petsc
