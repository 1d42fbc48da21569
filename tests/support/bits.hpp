/// @file
/// The bits of doubles, to distinguish values that are equal but not identical: -0 and 0.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace ductile::meshadapt::test {

inline std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> result;
  result.reserve(values.size());
  for (const double value : values) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

}  // namespace ductile::meshadapt::test
