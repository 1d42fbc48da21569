/// @file
/// Weld: gives points that have the same coordinates, bit for bit, one number, in the order in
/// which they first come.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace ductile::meshadapt {

class Weld {
 public:
  using Point = std::array<double, 3>;

  std::uint32_t number_of(Point point) {
    for (double& x : point) x += 0.0;  // -0 is 0
    const auto [at, is_new] =
        number_of_.try_emplace(point, static_cast<std::uint32_t>(number_of_.size()));
    if (is_new) coordinates_.insert(coordinates_.end(), point.begin(), point.end());
    return at->second;
  }

  std::vector<double> take_coordinates() { return std::move(coordinates_); }

 private:
  struct Hash {
    std::size_t operator()(const Point& point) const {
      std::uint64_t hash = 0;
      for (const double x : point) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
      return hash;
    }
  };
  std::unordered_map<Point, std::uint32_t, Hash> number_of_;
  std::vector<double> coordinates_;
};

}  // namespace ductile::meshadapt
