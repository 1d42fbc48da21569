#include "ductile/runtime/sort.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "radix_sort.hpp"
#include "sample_sort.hpp"

namespace ductile::runtime::sort_detail {

namespace {

/// One thread is fastest for few values; for many values, two or three threads share the passes of
/// a radix sort as well as the buckets of a sample sort.
template <class T>
void sort_by_digits(const Executor& executor, std::span<T> values, unsigned low) {
  const auto threads = static_cast<std::size_t>(executor.threads());
  const std::size_t few = std::max<std::size_t>(4096, 16384 / threads);
  const std::size_t most_sampled =
      threads < 4 ? 300'000 : std::numeric_limits<std::uint32_t>::max();
  if (threads == 1 || values.size() < few) {
    radix_sort(Executor({.threads = 1}), values, low);
  } else if (values.size() <= most_sampled) {
    with_team(executor, [&] { sample_sort(executor, values, low); });
  } else {
    with_team(executor, [&] { radix_sort(executor, values, low); });
  }
}

}  // namespace

void sort_integers(const Executor& executor, std::span<std::uint32_t> values, unsigned low) {
  sort_by_digits(executor, values, low);
}
void sort_integers(const Executor& executor, std::span<std::uint64_t> values, unsigned low) {
  sort_by_digits(executor, values, low);
}

}  // namespace ductile::runtime::sort_detail
