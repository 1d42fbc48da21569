/// @file
/// What interfaces hold: how far edges around them are from what is wanted, and which elements the
/// next pass has to adapt.
#pragma once

#include <cstdint>
#include <vector>

#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// Far from what is wanted; what is just out of the usual range may be so on any mesh.
inline bool is_blocked(double length) { return length > 2 || length < 0.5; }

/// Whether any edge of an element is blocked.
template <int Dim>
bool has_blocked_edge(const Part& part, std::uint32_t element);

/// Edges around shared vertices, measured by what is wanted.
struct EdgesAtInterfaces {
  std::int64_t all = 0;      ///< with an end that is shared; those on interfaces count on each side
  std::int64_t blocked = 0;  ///< of these
};

template <int Dim>
EdgesAtInterfaces edges_at_interfaces(const Part& part, const Interfaces& interfaces);

/// [element] 1 of those around vertices that were shared in the last pass: `layers` layers,
/// and as many beyond elements with blocked edges. At least one. Empty of an empty part.
template <int Dim>
std::vector<std::uint8_t> held_elements(const Part& part, std::uint8_t layers);

extern template bool has_blocked_edge<2>(const Part&, std::uint32_t);
extern template bool has_blocked_edge<3>(const Part&, std::uint32_t);
extern template EdgesAtInterfaces edges_at_interfaces<2>(const Part&, const Interfaces&);
extern template EdgesAtInterfaces edges_at_interfaces<3>(const Part&, const Interfaces&);
extern template std::vector<std::uint8_t> held_elements<2>(const Part&, std::uint8_t);
extern template std::vector<std::uint8_t> held_elements<3>(const Part&, std::uint8_t);

}  // namespace ductile::petsc
