/// @file
/// parallel_sort, parallel_unique: sort by operator<, and drop repetitions, on all threads of an
/// executor. The result does not depend on threads or timing as long as items of which neither is
/// less are identical.
/// Unsigned integers by radix, least significant digit first; other types by sorted blocks merged
/// pairwise, each merge cut into pieces of equal length ("merge path").
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

namespace sort_detail {

/// Of blocks that are sorted, merged or copied at once: enough of them for many threads.
inline std::size_t block_size_of(std::size_t n) {
  return std::clamp<std::size_t>(std::bit_ceil(n / 256), 2048, 32768);
}
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

/// How many of the first `rank` elements of the merge of a and b come from a.
template <class T>
std::size_t merge_split(std::span<const T> a, std::span<const T> b, std::size_t rank) {
  std::size_t low = rank > b.size() ? rank - b.size() : 0;
  std::size_t high = std::min(rank, a.size());
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (b[rank - middle - 1] < a[middle]) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

/// Merges the sorted parts of length `width` of `from` pairwise into `to`.
template <class T>
void merge_round(const Executor& executor, std::span<const T> from, std::span<T> to,
                 std::size_t width, std::size_t block_size) {
  const auto merge_piece = [&](std::size_t, std::size_t begin, std::size_t end) {
    const std::size_t first = begin / (2 * width) * (2 * width);  // widths are whole blocks
    const std::size_t middle = std::min(first + width, from.size());
    const std::span a = from.subspan(first, middle - first);
    const std::span b = from.subspan(middle, std::min(middle + width, from.size()) - middle);
    const std::size_t a0 = merge_split(a, b, begin - first), a1 = merge_split(a, b, end - first);
    const std::span a_part = a.subspan(a0, a1 - a0);
    const std::span b_part = b.subspan(begin - first - a0, (end - begin) - (a1 - a0));
    std::merge(a_part.begin(), a_part.end(), b_part.begin(), b_part.end(),
               to.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  parallel_for_blocks(executor, from.size(), block_size, merge_piece);
}

template <class T>
void merge_sort(const Executor& executor, std::span<T> values) {
  const std::size_t block_size = block_size_of(values.size());
  parallel_for_blocks(executor, values.size(), block_size,
                      [&](std::size_t, std::size_t begin, std::size_t end) {
                        const std::span part = values.subspan(begin, end - begin);
                        std::sort(part.begin(), part.end());
                      });
  const auto scratch = std::make_unique_for_overwrite<T[]>(values.size());
  std::span<T> from = values, to(scratch.get(), values.size());
  for (std::size_t width = block_size; width < values.size(); width *= 2) {
    merge_round<T>(executor, from, to, width, block_size);
    std::swap(from, to);
  }
  if (from.data() != values.data()) copy<T>(executor, from, values);
}

/// Whether no item is less than the one before it.
template <class T>
bool is_sorted(const Executor& executor, std::span<const T> values) {
  std::atomic<bool> sorted = true;
  const auto look = [&](std::size_t, std::size_t begin, std::size_t end) {
    // Relaxed: read again after the loop's barrier; before, it only saves looking on.
    if (!sorted.load(std::memory_order_relaxed)) return;
    const std::span part = values.subspan(begin, std::min(end + 1, values.size()) - begin);
    if (!std::is_sorted(part.begin(), part.end())) sorted.store(false, std::memory_order_relaxed);
  };
  parallel_for_blocks(executor, values.size(), 8192, look);
  return sorted.load(std::memory_order_relaxed);
}

}  // namespace sort_detail

/// Sorts by operator<, a strict weak order. Throws std::bad_alloc. Thread safety: one thread.
template <class T>
void parallel_sort(const Executor& executor, std::span<T> values) {
  if (sort_detail::is_sorted<T>(executor, values)) return;
  if constexpr (std::unsigned_integral<T>) {
    if (values.size() >= 1024) return sort_detail::radix_sort(executor, values);
  } else {
    if (executor.threads() > 1 && values.size() > 4096)
      return sort_detail::merge_sort(executor, values);
  }
  std::sort(values.begin(), values.end());
}

/// Moves the first of each run of equal items (neither is less) of a sorted range to the front, in
/// order, and returns how many there are. Throws std::bad_alloc. Thread safety: one thread.
template <class T>
std::size_t parallel_unique(const Executor& executor, std::span<T> sorted) {
  const std::size_t block_size = 8192;
  const auto same = [](const T& a, const T& b) { return !(a < b) && !(b < a); };
  std::vector<T> before;  // [block], the item before it
  for (std::size_t i = 0; i < sorted.size(); i += block_size) before.push_back(sorted[i - (i > 0)]);
  std::vector<std::span<const T>> kept(before.size());
  parallel_for_blocks(executor, sorted.size(), block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        const std::span part = sorted.subspan(begin, end - begin);
                        const auto last = std::unique(part.begin(), part.end(), same);
                        const bool repeats = block > 0 && same(before[block], part.front());
                        kept[block] = {part.begin() + (repeats ? 1 : 0), last};
                      });
  T* end = sorted.data();
  for (const std::span<const T> part : kept) end = std::copy(part.begin(), part.end(), end);
  return static_cast<std::size_t>(end - sorted.data());
}

}  // namespace ductile::runtime
