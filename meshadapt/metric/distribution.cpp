/// @file
/// Distribution: numbers in short, from their sorted order.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::meshadapt {

namespace {

constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63U;

/// A number for each double, in the order of their values: whole numbers are sorted by their
/// digits.
std::uint64_t key_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
  return (bits & sign_bit) != 0 ? ~bits : bits | sign_bit;
}

double value_of(std::uint64_t key) {
  return std::bit_cast<double>((key & sign_bit) != 0 ? key ^ sign_bit : ~key);
}

}  // namespace

Distribution distribution(const runtime::Executor& executor, std::span<const double> values,
                          double from, double to) {
  Distribution result;
  result.histogram_from = from;
  result.histogram_to = to;
  result.count = values.size();
  if (values.empty()) return result;
  const double sum = runtime::parallel_reduce(
      executor, values.size(), 0.0, [&](std::size_t i) { return values[i]; }, std::plus<>());
  result.mean = sum / static_cast<double>(values.size());
  auto keys = runtime::make_unset_vector<std::uint64_t>(executor, values.size());
  runtime::parallel_for(executor, keys.size(), [&](std::size_t i) { keys[i] = key_of(values[i]); });
  runtime::parallel_sort(executor, std::span(keys));
  // The smallest of the values that at least this share of them do not exceed.
  const auto percentile = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(keys.size()));
    return value_of(keys[static_cast<std::size_t>(std::max(1.0, rank)) - 1]);
  };
  result.min = value_of(keys.front());
  result.low = percentile(0.01);
  result.median = percentile(0.5);
  result.max = value_of(keys.back());
  const auto count_below = [&](double bound) {
    return static_cast<std::size_t>(std::ranges::lower_bound(keys, key_of(bound)) - keys.begin());
  };
  const std::size_t bins = result.histogram.size();
  const double width = (to - from) / static_cast<double>(bins);
  result.below = count_below(from);
  result.above = keys.size() - count_below(std::nextafter(to, HUGE_VAL));
  std::size_t before = result.below;
  for (std::size_t bin = 0; bin < bins; ++bin) {  // the last one has `to` as well
    const std::size_t end = bin + 1 < bins
                                ? count_below(from + width * static_cast<double>(bin + 1))
                                : keys.size() - result.above;
    result.histogram[bin] = end - before;
    before = end;
  }
  return result;
}

}  // namespace ductile::meshadapt
