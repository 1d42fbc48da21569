/// @file
/// Integer mixers and a space-filling curve. Mixers are bijections that scatter neighbouring
/// integers over the whole range: they turn an id into a priority without ties, the same in every
/// run. A Hilbert key does the opposite: nearby cells get nearby keys.
/// Thread safety: pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ductile::runtime {

/// A bijection of the 32-bit integers: "lowbias32", C. Wellons' hash prospector (2018).
constexpr std::uint32_t mix32(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  x ^= x >> 16U;
  return x;
}

/// A bijection of the 64-bit integers: variant 13 of D. Stafford's finaliser of MurmurHash3
/// (2011), as used by SplitMix64.
constexpr std::uint64_t mix64(std::uint64_t x) {
  x ^= x >> 30U;
  x *= 0xbf58476d1ce4e5b9U;
  x ^= x >> 27U;
  x *= 0x94d049bb133111ebU;
  x ^= x >> 31U;
  return x;
}

/// Position along a Hilbert curve of a grid cell, given with `bits` bits per axis: cells close
/// along the curve are close in space (Skilling, AIP Conf. Proc. 707, 2004). Coordinates are
/// transposed in place, then interleaved.
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
