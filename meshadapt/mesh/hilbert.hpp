/// @file
/// hilbert_key: where a point lies along a Hilbert curve through a box. What is near along the
/// curve is near in space.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Box {
  Vector<Dim> low, high;

  /// Contains nothing.
  static Box empty() {
    Box box;
    box.low.x.fill(std::numeric_limits<double>::infinity());
    box.high.x.fill(-std::numeric_limits<double>::infinity());
    return box;
  }

  friend Box join(Box a, const Box& b) {
    for (int i = 0; i < Dim; ++i) {
      a.low[i] = std::min(a.low[i], b.low[i]);
      a.high[i] = std::max(a.high[i], b.high[i]);
    }
    return a;
  }
};

/// Position along the Hilbert curve of a cell given by `bits` bits an axis (Skilling, AIP Conf.
/// Proc. 707, 2004): coordinates are transposed in place, then interleaved.
template <int Dim>
std::uint64_t hilbert_key(std::array<std::uint32_t, Dim> x, int bits) {
  const std::uint32_t top = 1U << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    for (std::size_t i = 0; i < Dim; ++i) {
      if (x[i] & q) {
        x[0] ^= q - 1;
      } else {
        const std::uint32_t t = (x[0] ^ x[i]) & (q - 1);
        x[0] ^= t;
        x[i] ^= t;
      }
    }
  for (std::size_t i = 1; i < Dim; ++i) x[i] ^= x[i - 1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1U)
    if (x[Dim - 1] & q) t ^= q - 1;
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (std::size_t i = 0; i < Dim; ++i) key = key << 1U | (((x[i] ^ t) >> bit) & 1U);
  return key;
}

/// The same of a point in the box.
template <int Dim>
std::uint64_t hilbert_key(const Vector<Dim>& point, const Box<Dim>& box) {
  constexpr int bits = Dim == 2 ? 24 : 20;
  std::array<std::uint32_t, Dim> cell{};
  for (int i = 0; i < Dim; ++i) {
    const double width = std::max(box.high[i] - box.low[i], std::numeric_limits<double>::min());
    const double at = (point[i] - box.low[i]) / width;
    cell[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(at * ((1U << bits) - 1));
  }
  return hilbert_key<Dim>(cell, bits);
}

}  // namespace ductile::meshadapt
