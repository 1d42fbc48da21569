/// @file
/// A sample sort of unsigned integers for many threads: keys from a sample cut the values into
/// about equal buckets; all threads distribute the values and then sort bucket by bucket, each in a
/// cache. Values move between caches once, where a radix sort of all of them moves them once per
/// digit, to scattered places.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::sort_detail {

constexpr std::size_t most_buckets = 256;  // so that a byte holds a bucket's number

/// Keys that cut values into buckets, whose number is a power of two.
template <std::unsigned_integral T>
class Splitters {
 public:
  /// Samples the keys value >> low.
  Splitters(std::span<const T> values, unsigned low, std::size_t buckets)
      : low_(low), key_(buckets - 1) {
    constexpr std::size_t samples = 4;  // per bucket
    std::vector<T> sample(samples * buckets);
    for (std::size_t i = 0; i < sample.size(); ++i)
      sample[i] = static_cast<T>(values[values.size() * i / sample.size()] >> low);
    std::sort(sample.begin(), sample.end());
    for (std::size_t i = 0; i < key_.size(); ++i) {
      const T key = sample[samples * (i + 1)];
      const bool repeats =
          i > 0 && key == sample[samples * i] && key != std::numeric_limits<T>::max();
      // A frequent key gets its own bucket, which is already in order.
      key_[i] = static_cast<T>(key + static_cast<T>(repeats));
    }
  }

  std::size_t bucket_count() const { return key_.size() + 1; }

  /// Equal keys get the same bucket. Branch-free, because the comparisons are unpredictable.
  std::size_t bucket_of(T value) const {
    const T key = static_cast<T>(value >> low_);
    std::size_t bucket = 0;
    for (std::size_t step = bucket_count() / 2; step > 0; step /= 2)
      bucket += step * static_cast<std::size_t>(key_[bucket + step - 1] <= key);
    return bucket;
  }

 private:
  unsigned low_;
  std::vector<T> key_;
};

/// Stable: sorts `from` by value >> low into `to`, of the same size, digit by digit. Overwrites
/// both.
template <std::unsigned_integral T>
void sort_bucket(std::span<T> from, std::span<T> to, unsigned low) {
  constexpr unsigned digit_size = 8;
  T differing = 0;
  for (const T value : from) differing |= value ^ from.front();
  bool is_in_from = true;
  for (unsigned shift = low; shift < std::numeric_limits<T>::digits; shift += digit_size) {
    if (differing >> shift == 0) break;
    std::array<std::uint32_t, std::size_t{1} << digit_size> place{};
    const auto digit = [shift](T value) { return (value >> shift) & ((1U << digit_size) - 1); };
    for (const T value : from) ++place[digit(value)];
    std::exclusive_scan(place.begin(), place.end(), place.begin(), std::uint32_t{0});
    for (const T value : from) to[place[digit(value)]++] = value;
    std::swap(from, to);
    is_in_from = !is_in_from;
  }
  if (is_in_from) std::copy(from.begin(), from.end(), to.begin());
}

/// Stable: sorts by value >> low.
template <std::unsigned_integral T>
void sample_sort(const Executor& executor, std::span<T> values, unsigned low) {
  const auto threads = static_cast<std::size_t>(executor.threads());
  const Splitters<T> splitters(values, low, std::min(std::bit_ceil(4 * threads), most_buckets));
  const std::size_t buckets = splitters.bucket_count();
  const std::size_t block = std::max<std::size_t>(1024, values.size() / (2 * threads) + 1);
  const std::size_t blocks = (values.size() + block - 1) / block;
  // All memory is allocated before values move, because running out of it later would lose some.
  auto bucket_of = make_unset_vector<std::uint8_t>(executor, values.size());
  std::vector<std::uint32_t> place_of(blocks * buckets), begin_of(buckets + 1);  // [block][bucket]
  auto scratch = make_unset_vector<T>(executor, values.size());
  parallel_for_blocks(executor, values.size(), block,
                      [&](std::size_t b, std::size_t begin, std::size_t end) {
                        std::array<std::uint32_t, most_buckets> count{};
                        for (std::size_t i = begin; i < end; ++i) {
                          const std::size_t bucket = splitters.bucket_of(values[i]);
                          bucket_of[i] = static_cast<std::uint8_t>(bucket);
                          ++count[bucket];
                        }
                        std::copy_n(count.begin(), buckets, place_of.begin() + b * buckets);
                      });
  std::uint32_t all = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    begin_of[bucket] = all;
    for (std::size_t b = 0; b < blocks; ++b)
      all += std::exchange(place_of[b * buckets + bucket], all);
  }
  begin_of[buckets] = all;
  parallel_for_blocks(executor, values.size(), block,
                      [&](std::size_t b, std::size_t begin, std::size_t end) {
                        std::array<std::uint32_t, most_buckets> place;
                        std::copy_n(place_of.begin() + b * buckets, buckets, place.begin());
                        for (std::size_t i = begin; i < end; ++i)
                          scratch[place[bucket_of[i]]++] = values[i];
                      });
  parallel_for(executor, buckets,
               [&](std::size_t bucket) {
                 const std::size_t begin = begin_of[bucket], size = begin_of[bucket + 1] - begin;
                 sort_bucket(std::span<T>(scratch.data() + begin, size),
                             values.subspan(begin, size), low);
               },
               {.grain = 1});
}

}  // namespace ductile::runtime::sort_detail
