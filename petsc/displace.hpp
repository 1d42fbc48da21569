/// @file
/// Displacing interfaces: what was held on an interface in one pass is inside of a part in the
/// next. The rank that has priority takes what lies on the other side: two layers of elements, and
/// two beyond those whose edges are far from the lengths that are wanted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interfaces.hpp"
#include "part.hpp"

namespace ductile::petsc {

struct Turn {
  int rank;
  int pass;  ///< from 0
};

/// Which of two ranks has priority in a pass: it alternates from pass to pass for each pair.
bool has_priority(const Turn& a, int over);

/// The rank to which each element goes in this pass, most of them to this one: at least a
/// quarter of them stays.
template <int Dim>
std::vector<int> displaced(const Part& part, const Interfaces& interfaces, const Turn& turn);

extern template std::vector<int> displaced<2>(const Part&, const Interfaces&, const Turn&);
extern template std::vector<int> displaced<3>(const Part&, const Interfaces&, const Turn&);

}  // namespace ductile::petsc
