/// @file
/// Integer mixers: bijections that scatter neighbouring integers over the whole range. They turn
/// an id into a priority that is the same in every run, without ties.
/// Thread safety: pure functions.
#pragma once

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

/// A bijection of the integers below 2^bits; higher bits of x do not count. bits is at most 32.
constexpr std::uint32_t mix_bits(std::uint32_t x, unsigned bits) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1);
  const unsigned half = (bits + 1) / 2;
  x &= mask;
  x ^= x >> half;
  x = (x * 0x7feb352dU) & mask;
  x ^= x >> half;
  x = (x * 0x846ca68bU) & mask;
  return x ^ x >> half;
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

}  // namespace ductile::runtime
