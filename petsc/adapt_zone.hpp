/// @file
/// adapt_zone: adapts some of a part's elements and leaves the others. From the second pass on only
/// what is near the last interfaces has to be done.
#pragma once

#include <cstdint>
#include <vector>

#include "adapt_part.hpp"

namespace ductile::petsc {

/// As adapt_part() of the elements that `is_held` marks, with what they share with others required
/// too.
template <int Dim>
AdaptedPart adapt_zone(const runtime::Executor& executor, const Part& part,
                       const Interfaces& interfaces, const std::vector<std::uint8_t>& is_held,
                       const AdaptPartOptions& options);

extern template AdaptedPart adapt_zone<2>(const runtime::Executor&, const Part&, const Interfaces&,
                                          const std::vector<std::uint8_t>&,
                                          const AdaptPartOptions&);
extern template AdaptedPart adapt_zone<3>(const runtime::Executor&, const Part&, const Interfaces&,
                                          const std::vector<std::uint8_t>&,
                                          const AdaptPartOptions&);

}  // namespace ductile::petsc
