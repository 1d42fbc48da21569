/// @file
/// hilbert_key: where a cell of a grid lies along a Hilbert curve. What is near along the curve is
/// near in space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ductile::runtime {

/// Position along the Hilbert curve of a cell given by `bits` bits an axis (Skilling, AIP Conf.
/// Proc. 707, 2004): coordinates are transposed in place, then interleaved.
template <std::size_t Dim>
constexpr std::uint64_t hilbert_key(std::array<std::uint32_t, Dim> x, int bits) {
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

}  // namespace ductile::runtime
