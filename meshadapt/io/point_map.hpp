/// @file
/// PointMap: finds points that have the same coordinates, bit for bit except that -0 is 0.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace ductile::meshadapt {

struct PointHash {
  std::size_t operator()(const std::array<double, 3>& point) const {
    std::uint64_t hash = 0;
    for (const double x : point) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32U;
    }
    return hash;
  }
};

template <class Value>
using PointMap = std::unordered_map<std::array<double, 3>, Value, PointHash>;

}  // namespace ductile::meshadapt
