/// @file
/// parallel_sort, parallel_unique: sort by operator< and drop repetitions, on all threads of an
/// executor. The result does not depend on threads or timing if equivalent items (neither is less)
/// are identical.
/// Unsigned integers of 32 and 64 bits are sorted by radix or, on many threads, by samples; other
/// types by sorted blocks merged pairwise, each merge cut into pieces of equal length ("merge
/// path"). Large or move-only items stay in place until their order is known.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

namespace sort_detail {

/// Integers that are sorted by radix.
template <class T>
concept SortedByDigits = std::same_as<T, std::uint32_t> || std::same_as<T, std::uint64_t>;

/// Stable; sorts by value >> low. If it throws std::bad_alloc, no value is lost.
void sort_integers(const Executor& executor, std::span<std::uint32_t> values, unsigned low);
void sort_integers(const Executor& executor, std::span<std::uint64_t> values, unsigned low);

template <class T>
void copy(const Executor& executor, std::span<const T> from, std::span<T> to) {
  parallel_for_ranges(executor, from.size(),
                      [&](std::size_t begin, std::size_t end) {
                        const std::span part = from.subspan(begin, end - begin);
                        std::copy(part.begin(), part.end(), to.data() + begin);
                      },
                      {.grain = 8192});
}

/// Length of the blocks that are sorted, merged or copied at once: enough blocks for many threads.
inline std::size_t block_size_of(std::size_t n) {
  return std::clamp<std::size_t>(std::bit_ceil(n / 256), 2048, 32768);
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
  auto scratch = make_unset_vector<T>(executor, values.size());
  std::span<T> from = values, to = scratch;
  for (std::size_t width = block_size; width < values.size(); width *= 2) {
    merge_round<T>(executor, from, to, width, block_size);
    std::swap(from, to);
  }
  if (from.data() != values.data()) copy<T>(executor, from, values);
}

/// Is no item less than the one before it?
template <class T>
bool is_sorted(const Executor& executor, std::span<const T> values) {
  std::atomic<bool> sorted = true;
  const auto look = [&](std::size_t, std::size_t begin, std::size_t end) {
    // Relaxed: it is read again after the loop's barrier; before, it only saves work.
    if (!sorted.load(std::memory_order_relaxed)) return;
    const std::span part = values.subspan(begin, std::min(end + 1, values.size()) - begin);
    if (!std::is_sorted(part.begin(), part.end())) sorted.store(false, std::memory_order_relaxed);
  };
  parallel_for_blocks(executor, values.size(), 8192, look);
  return sorted.load(std::memory_order_relaxed);
}

/// Stands for a value while its order is computed.
template <class T>
struct Reference {
  T* value;
  bool operator<(const Reference& other) const { return *value < *other.value; }
};

template <class T>
constexpr bool cheap_to_move =
    std::copyable<T>&& std::default_initializable<T>&& std::is_trivially_destructible_v<T> &&
    sizeof(T) <= 64;

template <class T>
void sort_in_place(const Executor& executor, std::span<T> values) {
  if (executor.threads() > 1 && values.size() > 4096)
    return with_team(executor, [&] { merge_sort(executor, values); });
  std::sort(values.begin(), values.end());
}

/// Sorts references, then moves every value twice.
template <class T>
void sort_by_reference(const Executor& executor, std::span<T> values) {
  auto references = make_unset_vector<Reference<T>>(executor, values.size());
  const std::span order(references);
  const LoopOptions copying{.serial_below = 1024};
  parallel_for(
      executor, order.size(), [&](std::size_t i) { order[i] = {&values[i]}; }, copying);
  sort_in_place(executor, order);
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const Reference<T>& reference : order) sorted.push_back(std::move(*reference.value));
  parallel_for(
      executor, order.size(), [&](std::size_t i) { values[i] = std::move(sorted[i]); }, copying);
}

}  // namespace sort_detail

/// Sorts by operator<, a strict weak order. T is movable. If it throws std::bad_alloc, no value is
/// lost. Thread safety: one thread.
template <std::movable T>
void parallel_sort(const Executor& executor, std::span<T> values) {
  if (sort_detail::is_sorted<T>(executor, values)) return;
  if constexpr (sort_detail::SortedByDigits<T>) {
    if (values.size() >= 1024) return sort_detail::sort_integers(executor, values, 0);
    std::sort(values.begin(), values.end());
  } else if constexpr (sort_detail::cheap_to_move<T>) {
    sort_detail::sort_in_place(executor, values);
  } else {
    sort_detail::sort_by_reference(executor, values);
  }
}

/// Sorts integers by value >> low, stably. If it throws std::bad_alloc, no value is lost. Thread
/// safety: one thread.
template <sort_detail::SortedByDigits T>
void parallel_sort_above(const Executor& executor, std::span<T> values, unsigned low) {
  if (!sort_detail::is_sorted<T>(executor, values))
    sort_detail::sort_integers(executor, values, low);
}

/// Moves the first of each run of equal items (neither is less) of a sorted range to the front, in
/// order, and returns their number. T is movable; items behind them may be moved from. Throws
/// std::bad_alloc. Thread safety: one thread.
template <std::movable T>
std::size_t parallel_unique(const Executor& executor, std::span<T> sorted) {
  const std::size_t block_size = 8192;
  const auto same = [](const T& a, const T& b) { return !(a < b) && !(b < a); };
  std::vector<std::span<T>> kept((sorted.size() + block_size - 1) / block_size);
  // Does a block begin with the last item of the previous one? Checked before anything is moved.
  std::vector<std::uint8_t> repeats(kept.size());
  for (std::size_t b = 1; b < kept.size(); ++b)
    repeats[b] = same(sorted[b * block_size - 1], sorted[b * block_size]);
  parallel_for_blocks(executor, sorted.size(), block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        const std::span part = sorted.subspan(begin, end - begin);
                        const auto last = std::unique(part.begin(), part.end(), same);
                        kept[block] = {part.begin() + repeats[block], last};
                      });
  T* end = sorted.data();
  for (const std::span<T> part : kept)
    end = part.data() == end ? end + part.size() : std::move(part.begin(), part.end(), end);
  return static_cast<std::size_t>(end - sorted.data());
}

}  // namespace ductile::runtime
