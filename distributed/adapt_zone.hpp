/// @file
/// adapt_zone: adapts some elements of a part and keeps the others. From the second pass on, only
/// the surroundings of the previous interfaces need adapting.
#pragma once

#include <cstdint>
#include <vector>

#include "distributed/adapt_part.hpp"

namespace ductile::distributed {

/// adapt_part() for the elements that `is_held` marks; what they share with others is required too.
AdaptedPart adapt_zone(const runtime::Executor& executor, const Part& part,
                       const Interfaces& interfaces, const std::vector<std::uint8_t>& is_held,
                       const AdaptPartOptions& options);

}  // namespace ductile::distributed
