/// @file
/// Grouping: groups items by their keys (elements by their corners), each group in order, on many
/// threads without atomics. Items and keys are cut into the same number of chunks. Keys of an item
/// that belong to the chunk of the same number are read from the item when needed; the others are
/// recorded first, chunk by chunk, and so in order. It works for any items; if they are in the
/// order of their keys, little is recorded.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

/// Chunk c has the items and the keys from bound c to bound c + 1. There is at least one.
struct GroupingBounds {
  std::vector<std::uint32_t> items, keys;

  std::size_t chunk_count() const { return items.size() - 1; }

  /// Equal chunks, as many as threads can use. Throws std::bad_alloc, and std::length_error if
  /// there are more items or keys than 32-bit numbers can count.
  static GroupingBounds even(const runtime::Executor& executor, std::size_t items,
                             std::size_t keys) {
    if (std::max(items, keys) > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("more items or keys than 32-bit numbers can count");
    constexpr std::size_t least = 2048;  // items in a chunk
    const std::size_t most =
        std::min<std::size_t>(512, 2 * static_cast<std::size_t>(executor.threads()));
    const std::size_t count =
        executor.threads() == 1 ? 1 : std::clamp<std::size_t>(items / least, 1, most);
    GroupingBounds bounds;
    for (std::size_t c = 0; c <= count; ++c) {
      bounds.items.push_back(static_cast<std::uint32_t>(items * c / count));
      bounds.keys.push_back(static_cast<std::uint32_t>(keys * c / count));
    }
    return bounds;
  }
};

/// KeysOf: keys_of(item, visit) calls visit(key) for each key that an item has.
template <class KeysOf>
class Grouping {
 public:
  /// Counts the items of each key into `count_of`, which need not be initialised. Throws
  /// std::bad_alloc, and std::length_error if the items have more keys than 32-bit numbers can
  /// count. Thread safety: one caller; runs on the executor.
  Grouping(const runtime::Executor& executor, GroupingBounds bounds,
           std::span<std::uint32_t> count_of, KeysOf keys_of)
      : executor_(executor),
        bounds_(std::move(bounds)),
        chunks_(bounds_.chunk_count()),
        count_of_(count_of),
        keys_of_(std::move(keys_of)),
        own_(chunks_),
        spread_(chunks_),
        noted_begin_(chunks_ * chunks_ + 1) {
    for_each_chunk([&](std::size_t c) { count(c); });
    std::uint64_t total = 0, own = std::accumulate(own_.begin(), own_.end(), std::uint64_t{0});
    for (std::uint32_t& begin : noted_begin_)
      begin = static_cast<std::uint32_t>(std::exchange(total, total + begin));
    if (total + own > std::numeric_limits<std::uint32_t>::max())
      throw std::length_error("a mesh of more elements than lists of 32-bit numbers can have");
    noted_ = runtime::make_unset_vector<Pair>(executor_, total);
    if (total != 0) for_each_chunk([&](std::size_t c) { note(c); });
    spread_.clear();
  }

  /// May be called once: calls put(place, item) for each key of each item, in order; places are
  /// numbered key by key, and count_of becomes the end of each key's places.
  void list(auto&& put) {
    const auto begin_lists = [count_of = count_of_](std::uint32_t begin, std::uint32_t end,
                                                    std::uint32_t before) {
      for (std::uint32_t key = begin; key < end; ++key)
        count_of[key] = std::exchange(before, before + count_of[key]);
    };
    visit(begin_lists, [&put, count_of = count_of_](std::uint32_t key, std::uint32_t item) {
      put(count_of[key]++, item);
    });
  }

  /// Total number of keys of all items.
  std::uint32_t size() const {
    std::uint32_t sum = noted_begin_.back();
    for (const std::uint32_t own : own_) sum += own;
    return sum;
  }

  /// May be called once. For each chunk of keys: calls prepare(begin, end, before), where count_of
  /// of the keys [begin, end) is the number of items of each and `before` that of all lower keys;
  /// then put(key, item) for each of them, the items of a key in order.
  void visit(auto&& prepare, auto&& put) {
    std::vector<std::uint32_t> before(chunks_);
    for (std::size_t c = 0; c + 1 < chunks_; ++c)
      before[c + 1] = before[c] + own_[c] + noted_begin(c + 1, 0) - noted_begin(c, 0);
    for_each_chunk([&](std::size_t c) {
      const std::span<const Pair> all = noted_;
      const auto noted = [&](std::size_t begin, std::size_t end, auto&& use) {
        for (const Pair& pair : all.subspan(begin, end - begin)) use(pair.key, pair.item);
      };
      const std::size_t begin = noted_begin(c, 0), end = noted_begin(c + 1, 0);
      const std::size_t middle = noted_begin(c, c);
      noted(begin, end, [&](std::uint32_t key, std::uint32_t) { ++count_of_[key]; });
      prepare(bounds_.keys[c], bounds_.keys[c + 1], before[c]);
      noted(begin, middle, put);
      each_key(c, [&put, own = range(c)](std::uint32_t key, std::uint32_t item) {
        if (own.contains(key)) put(key, item);
      });
      noted(middle, end, put);
    });
  }

 private:
  struct Pair {
    std::uint32_t key, item;
  };

  void for_each_chunk(auto&& body) {
    runtime::parallel_for(executor_, chunks_, body, {.grain = 1});
  }

  /// A chunk of keys. Passed by value, so that compilers know that it does not change.
  struct Range {
    std::uint32_t begin, size;
    bool contains(std::uint32_t key) const { return key - begin < size; }
  };
  Range range(std::size_t chunk) const {
    return {bounds_.keys[chunk], bounds_.keys[chunk + 1] - bounds_.keys[chunk]};
  }
  /// The chunk of a key, usually the same as the previous key's.
  std::size_t chunk_of(std::uint32_t key, std::size_t likely) const {
    if (range(likely).contains(key)) return likely;
    const auto after = std::upper_bound(bounds_.keys.begin(), bounds_.keys.end(), key);
    return static_cast<std::size_t>(after - bounds_.keys.begin()) - 1;
  }
  /// Calls visit(item) for each of a chunk's items that has keys in other chunks.
  void each_spread(std::size_t c, auto&& visit) const {
    for (std::size_t word = 0; word < spread_[c].size(); ++word)
      for (std::uint64_t bits = spread_[c][word]; bits != 0; bits &= bits - 1)
        visit(static_cast<std::uint32_t>(bounds_.items[c] + 64 * word + std::countr_zero(bits)));
  }
  /// Calls visit(key, item) for all keys of a chunk's items.
  void each_key(std::size_t c, auto&& visit) const {
    const std::uint32_t end = bounds_.items[c + 1];
    for (std::uint32_t item = bounds_.items[c]; item < end; ++item)
      keys_of_(item, [&](std::uint32_t key) { visit(key, item); });
  }

  /// Start of the records of one chunk's keys from the items of another; before that, their number.
  std::uint32_t& noted_begin(std::size_t keys, std::size_t items) {
    return noted_begin_[keys * chunks_ + items];
  }

  void count(std::size_t c) {
    const auto begin = count_of_.begin();
    std::fill(begin + bounds_.keys[c], begin + bounds_.keys[c + 1], 0U);
    std::vector<std::uint32_t> noted(chunks_);
    std::size_t other = c;
    const std::uint32_t first = bounds_.items[c];
    spread_[c].assign((bounds_.items[c + 1] - first + 63) / 64, 0);
    each_key(c, [&, own = range(c), count_of = count_of_](std::uint32_t key, std::uint32_t item) {
      if (own.contains(key)) {
        ++count_of[key];
      } else {
        other = chunk_of(key, other);
        ++noted[other];
        spread_[c][(item - first) / 64] |= std::uint64_t{1} << (item - first) % 64;
      }
    });
    own_[c] = std::accumulate(begin + bounds_.keys[c], begin + bounds_.keys[c + 1], 0U);
    for (std::size_t keys = 0; keys < chunks_; ++keys) noted_begin(keys, c) = noted[keys];
  }

  void note(std::size_t c) {
    std::vector<std::uint32_t> at(chunks_);
    for (std::size_t keys = 0; keys < chunks_; ++keys) at[keys] = noted_begin(keys, c);
    std::size_t other = c;
    each_spread(c, [&, own = range(c)](std::uint32_t item) {
      keys_of_(item, [&](std::uint32_t key) {
        if (own.contains(key)) return;
        other = chunk_of(key, other);
        noted_[at[other]++] = {key, item};
      });
    });
  }

  const runtime::Executor& executor_;
  GroupingBounds bounds_;
  std::size_t chunks_;
  std::span<std::uint32_t> count_of_;
  KeysOf keys_of_;
  std::vector<std::uint32_t> own_;                  // [chunk], number of keys of its own items in
                                                    // it
  std::vector<std::vector<std::uint64_t>> spread_;  // [chunk], bits of items, for each_spread()
  std::vector<std::uint32_t> noted_begin_;          // [chunk of keys][chunk of items]
  runtime::UnsetVector<Pair> noted_;
};

}  // namespace ductile::meshadapt
