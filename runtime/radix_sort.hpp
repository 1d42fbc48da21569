/// @file
/// A radix sort of unsigned integers on all threads of an executor, least significant digit first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::sort_detail {

constexpr unsigned digit_bits = 11;
constexpr std::size_t digit_count = std::size_t{1} << digit_bits;
using DigitCounts = std::array<std::size_t, digit_count>;

/// One pass over the digit at `shift`, in blocks of `block` values.
struct DigitPass {
  std::size_t block, blocks;
  std::unique_ptr<DigitCounts[]> counts;  // [block], counts of each digit; later, where its values
                                          // go
  unsigned shift = 0;

  std::size_t digit(std::unsigned_integral auto value) const {
    return static_cast<std::size_t>(value >> shift) & (digit_count - 1);
  }
};

/// Puts each value where `place_of` says for its digit, and advances that.
template <std::unsigned_integral T>
void scatter_singly(std::span<const T> values, T* to, const DigitPass& pass,
                    DigitCounts& place_of) {
  for (const T value : values) to[place_of[pass.digit(value)]++] = value;
}

template <std::unsigned_integral T>
using Line = std::array<T, 64 / sizeof(T)>;

/// The same, but collects a cache line per digit and writes whole lines.
template <std::unsigned_integral T>
void scatter_lines(std::span<const T> values, T* to, const DigitPass& pass, DigitCounts& place_of,
                   Line<T>* gathered) {
  constexpr std::size_t line = Line<T>().size();
  const DigitCounts first = place_of;
  const auto flush = [&](std::size_t digit, std::size_t end) {
    const std::size_t line_begin = (end - 1) / line * line;
    for (std::size_t i = std::max(line_begin, first[digit]); i < end; ++i)
      to[i] = gathered[digit][i - line_begin];
  };
  for (const T value : values) {
    const std::size_t digit = pass.digit(value), place = place_of[digit]++;
    gathered[digit][place % line] = value;
    if (place % line == line - 1) flush(digit, place + 1);
  }
  for (std::size_t digit = 0; digit < digit_count; ++digit)
    if (place_of[digit] % line != 0 && place_of[digit] != first[digit])
      flush(digit, place_of[digit]);
}

/// Do the places of many digits fall into the same set of a cache, which cannot hold them all? This
/// happens for dense numbers, whose digits begin powers of two apart. `bytes` is the size of a
/// value.
inline bool crowd_a_cache_set(const DigitCounts& place_of, std::size_t bytes) {
  constexpr std::size_t sets = 64, line = 64;
  std::array<std::size_t, sets> digits_in{};
  std::size_t used = 0;
  for (std::size_t digit = 0; digit + 1 < digit_count; ++digit) {
    if (place_of[digit] == place_of[digit + 1]) continue;
    ++digits_in[place_of[digit] * bytes / line % sets];
    ++used;
  }
  return *std::max_element(digits_in.begin(), digits_in.end()) > 4 * (used / sets + 4);
}

/// Turns each block's counts into the positions of its values: those of a digit are consecutive,
/// block by block. Each thread takes a slice of the digits and goes through the blocks in the
/// order in which the counts are stored. Returns the beginnings of the digits.
inline DigitCounts counts_to_places(const Executor& executor, std::span<DigitCounts> counts_of) {
  constexpr std::size_t slice = 128, slices = digit_count / slice, few_blocks = 16;
  DigitCounts begin_of{};
  const auto add_up = [&](std::size_t, std::size_t begin, std::size_t end) {
    for (DigitCounts& counts : counts_of)
      for (std::size_t d = begin; d < end; ++d)
        counts[d] = std::exchange(begin_of[d], begin_of[d] + counts[d]);
  };
  parallel_for_blocks(executor, digit_count, slice, add_up,
                      {.grain = 1, .serial_below = counts_of.size() < few_blocks ? slices + 1 : 0});
  std::exclusive_scan(begin_of.begin(), begin_of.end(), begin_of.begin(), std::size_t{0});
  return begin_of;
}

/// Stable: sorts `from` by the pass's digit into `to`. `lines` has room for a line per digit and
/// block, or is null if there are too few values to benefit.
template <std::unsigned_integral T>
void scatter_by_digit(const Executor& executor, std::span<const T> from, std::span<T> to,
                      DigitPass& pass, Line<T>* lines) {
  DigitCounts begin_of{};
  const auto count = [&](std::size_t b, std::size_t begin, std::size_t end) {
    pass.counts[b].fill(0);
    for (std::size_t i = begin; i < end; ++i) ++pass.counts[b][pass.digit(from[i])];
  };
  const auto scatter = [&](std::size_t b, std::size_t begin, std::size_t end) {
    const std::span values = from.subspan(begin, end - begin);
    for (std::size_t d = 0; d < digit_count; ++d) pass.counts[b][d] += begin_of[d];
    if (lines != nullptr && crowd_a_cache_set(pass.counts[b], sizeof(T))) {
      scatter_lines(values, to.data(), pass, pass.counts[b], lines + b * digit_count);
    } else {
      scatter_singly(values, to.data(), pass, pass.counts[b]);
    }
  };
  parallel_for_blocks(executor, from.size(), pass.block, count);
  begin_of = counts_to_places(executor, {pass.counts.get(), pass.blocks});
  parallel_for_blocks(executor, from.size(), pass.block, scatter);
}

/// One block per thread while adding up the counts takes one thread less than another thread saves;
/// or a few more, if blocks are long.
inline std::size_t radix_blocks(std::size_t size, std::size_t threads) {
  const auto worth_it = static_cast<std::size_t>(std::sqrt(static_cast<double>(size) / 512));
  return std::max(
      {std::size_t{1}, std::min(threads, worth_it), std::min(size / 16384, 4 * threads)});
}

/// Stable: sorts by value >> low.
template <std::unsigned_integral T>
void radix_sort(const Executor& executor, std::span<T> values, unsigned low) {
  const auto threads = static_cast<std::size_t>(executor.threads());
  const T top = parallel_reduce(
      executor, values.size(), T{0}, [&](std::size_t i) { return values[i]; },
      [](T a, T b) { return std::max(a, b); });
  const auto bits = static_cast<unsigned>(std::bit_width(top));
  const std::size_t block = values.size() / radix_blocks(values.size(), threads) + 1;
  const std::size_t blocks = (values.size() + block - 1) / block;
  DigitPass pass{block, blocks, std::make_unique_for_overwrite<DigitCounts[]>(blocks), low};
  auto scratch = make_unset_vector<T>(executor, values.size());
  // All memory is allocated before the first pass, because running out of it later would lose
  // values.
  std::unique_ptr<Line<T>[]> lines;
  if (values.size_bytes() > 262144)
    lines = std::make_unique_for_overwrite<Line<T>[]>(blocks * digit_count);
  std::span<T> from = values, to = scratch;
  for (; pass.shift < bits; pass.shift += digit_bits) {
    scatter_by_digit<T>(executor, from, to, pass, lines.get());
    std::swap(from, to);
  }
  if (from.data() != values.data()) copy<T>(executor, from, values);
}

}  // namespace ductile::runtime::sort_detail
