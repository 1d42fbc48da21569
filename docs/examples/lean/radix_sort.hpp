/// @file
/// A sort of words by half of their bits, for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lean {

/// Sorts words by their upper halves, least digit first. Equal ones stay in their order.
inline void sort_by_upper_half(std::vector<std::uint64_t>& keys) {
  constexpr unsigned digit_bits = 11;
  constexpr std::uint64_t digit = (1U << digit_bits) - 1;
  std::vector<std::uint64_t> sorted(keys.size());
  std::vector<std::uint32_t> next(digit + 2);
  for (unsigned shift = 32; shift < 64; shift += digit_bits) {
    next.assign(next.size(), 0);
    for (const std::uint64_t key : keys) ++next[(key >> shift & digit) + 1];
    for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
    for (const std::uint64_t key : keys) sorted[next[key >> shift & digit]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace lean
