/// @file
/// Bisection: distributes elements by planes across the axes, each of which divides one side of a
/// previous plane. Planes move from pass to pass, so that what was held on an interface is inside a
/// part in the next.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"

namespace ductile::distributed {

/// A load as a whole number, because sums of these do not depend on their order.
inline std::int64_t in_thousandths(double load) { return std::llround(1000 * std::min(load, 1e9)); }

/// Direction in which planes are displaced from equal loads: by some layers of elements,
/// neighbouring planes in opposite directions.
enum class Displaced : std::int8_t { back = -1, not_at_all = 0, forth = 1 };

/// [element] The part, one per rank. Each plane is across the axis along which it cuts the fewest
/// target elements. Parts may be empty if there are few elements. The same loads and places give
/// the same parts, however they are distributed. Collective.
std::vector<int> bisected(const Communicator& comm, const Part& part,
                          const std::vector<double>& load_of, Displaced displaced);

}  // namespace ductile::distributed
