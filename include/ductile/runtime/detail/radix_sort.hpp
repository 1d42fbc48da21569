/// @file
/// A radix sort of unsigned integers on all threads of an executor, least significant digit first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::sort_detail {

constexpr std::size_t radix_block = 16384;
constexpr unsigned digit_bits = 11;
constexpr std::size_t digit_count = std::size_t{1} << digit_bits;
using DigitCounts = std::array<std::size_t, digit_count>;

template <class T>
void copy(const Executor& executor, std::span<const T> from, std::span<T> to) {
  parallel_for_ranges(executor, from.size(),
                      [&](std::size_t begin, std::size_t end) {
                        const std::span part = from.subspan(begin, end - begin);
                        std::copy(part.begin(), part.end(), to.data() + begin);
                      },
                      {.grain = 8192});
}

/// One pass over the digit at `shift`, in blocks of `block` values.
struct DigitPass {
  std::size_t block;
  std::vector<DigitCounts> counts;  // [block], of each digit; then where its values go
  unsigned shift = 0;
};

/// Stable: sorts `from` by the pass's digit into `to`.
template <std::unsigned_integral T>
void scatter_by_digit(const Executor& executor, std::span<const T> from, std::span<T> to,
                      DigitPass& pass) {
  const auto digit = [shift = pass.shift](T value) {
    return static_cast<std::size_t>(value >> shift) & (digit_count - 1);
  };
  const auto count = [&](std::size_t b, std::size_t begin, std::size_t end) {
    pass.counts[b].fill(0);
    for (std::size_t i = begin; i < end; ++i) ++pass.counts[b][digit(from[i])];
  };
  const auto scatter = [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[pass.counts[b][digit(from[i])]++] = from[i];
  };
  parallel_for_blocks(executor, from.size(), pass.block, count);
  std::size_t sum = 0;
  for (std::size_t d = 0; d < digit_count; ++d)
    for (DigitCounts& counts : pass.counts) sum += std::exchange(counts[d], sum);
  parallel_for_blocks(executor, from.size(), pass.block, scatter);
}

template <std::unsigned_integral T>
void radix_sort(const Executor& executor, std::span<T> values) {
  const T top = parallel_reduce(
      executor, values.size(), T{0}, [&](std::size_t i) { return values[i]; },
      [](T a, T b) { return std::max(a, b); });
  const auto bits = static_cast<unsigned>(std::bit_width(top));
  const std::size_t most_blocks = 4 * static_cast<std::size_t>(executor.threads());
  const std::size_t block = std::max(radix_block, (values.size() + most_blocks - 1) / most_blocks);
  DigitPass pass{block, std::vector<DigitCounts>((values.size() + block - 1) / block)};
  std::vector<T> scratch(values.size());
  std::span<T> from = values, to = scratch;
  for (; pass.shift < bits; pass.shift += digit_bits) {
    scatter_by_digit<T>(executor, from, to, pass);
    std::swap(from, to);
  }
  if (from.data() != values.data()) copy<T>(executor, from, values);
}

}  // namespace ductile::runtime::sort_detail
