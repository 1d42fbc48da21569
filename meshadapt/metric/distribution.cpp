/// @file
/// Distribution: numbers in short, in a few passes over them. A percentile is found among those of
/// a narrow range that must hold it, so that they need not be sorted.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

namespace {

using runtime::Executor;

struct Summary {
  double sum = 0;
  double min = std::numeric_limits<double>::infinity(), max = -min;
};

Summary summarise(const Executor& executor, std::span<const double> values) {
  return runtime::parallel_reduce(
      executor, values.size(), Summary{},
      [&](std::size_t i) {
        return Summary{values[i], values[i], values[i]};
      },
      [](const Summary& a, const Summary& b) {
        return Summary{a.sum + b.sum, std::min(a.min, b.min), std::max(a.max, b.max)};
      });
}

/// How many of the values place_of() puts at each place. Counts do not depend on who counts.
template <std::size_t places>
std::array<std::size_t, places> counts_of(const Executor& executor, std::span<const double> values,
                                          auto&& place_of) {
  runtime::PerThread<std::array<std::size_t, places>> counted(executor);
  runtime::parallel_for_ranges(executor, values.size(), [&](std::size_t begin, std::size_t end) {
    auto& mine = counted.mine();
    for (std::size_t i = begin; i < end; ++i) ++mine[place_of(values[i])];
  });
  std::array<std::size_t, places> counts{};
  for (std::size_t t = 0; t < counted.size(); ++t)
    for (std::size_t place = 0; place < places; ++place) counts[place] += counted[t][place];
  return counts;
}

/// A number for each double, in the order of their values.
std::uint64_t place_in_order(double value) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// Values by the part of their range that they lie in; parts have as many doubles each, so that few
/// values are in one, however they are spread.
class Parts {
 public:
  Parts(const Executor& executor, std::span<const double> values, const Summary& summary)
      : executor_(executor),
        values_(values),
        first_(place_in_order(summary.min)),
        shift_(shift_for(place_in_order(summary.max) - first_)),
        size_of_(
            counts_of<count>(executor, values, [this](double value) { return part_of(value); })) {}

  /// The value that so many come before, were they sorted.
  double value_after(std::size_t before) const {
    constexpr std::size_t few = 65536;  // for one thread
    std::size_t part = 0;
    for (; before >= size_of_[part]; ++part) before -= size_of_[part];
    auto found = runtime::parallel_collect<double>(executor_, values_.size(),
                                                   [&](std::size_t i, auto&& append) {
                                                     if (part_of(values_[i]) == part)
                                                       append(values_[i]);
                                                   });
    if (shift_ == 0) return found[before];  // all are the same
    if (found.size() > few && found.size() < values_.size())
      return Parts(executor_, found, summarise(executor_, found)).value_after(before);
    const auto at = found.begin() + static_cast<std::ptrdiff_t>(before);
    std::nth_element(found.begin(), at, found.end());
    return *at;
  }

 private:
  static constexpr std::size_t count = 1024;

  static unsigned shift_for(std::uint64_t range) {
    constexpr auto bits = static_cast<unsigned>(std::bit_width(count - 1));
    return std::max(bits, static_cast<unsigned>(std::bit_width(range))) - bits;
  }
  /// The part of a value; a NaN, which has no order, goes into the last part.
  std::size_t part_of(double value) const {
    return std::min<std::size_t>((place_in_order(value) - first_) >> shift_, count - 1);
  }

  const Executor& executor_;
  std::span<const double> values_;
  std::uint64_t first_;
  unsigned shift_;
  std::array<std::size_t, count> size_of_;  // [part]
};

/// The smallest of the values that at least this share of them do not exceed.
double percentile(const Parts& parts, std::size_t values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values));
  return parts.value_after(static_cast<std::size_t>(std::max(1.0, rank)) - 1);
}

}  // namespace

Distribution distribution(const Executor& executor, std::span<const double> values, double from,
                          double to) {
  Distribution result;
  result.histogram_from = from;
  result.histogram_to = to;
  result.count = values.size();
  if (values.empty()) return result;
  const Summary summary = summarise(executor, values);
  result.mean = summary.sum / static_cast<double>(values.size());
  result.min = summary.min;
  result.max = summary.max;
  const Parts parts(executor, values, summary);
  result.low = percentile(parts, values.size(), 0.01);
  result.median = percentile(parts, values.size(), 0.5);

  constexpr std::size_t bins = std::tuple_size_v<decltype(result.histogram)>;
  std::array<double, bins - 1> end_of;  // [bin] but the last, which has `to` as well
  const double width = (to - from) / static_cast<double>(bins);
  for (std::size_t bin = 0; bin < end_of.size(); ++bin)
    end_of[bin] = from + width * static_cast<double>(bin + 1);
  const auto counts = counts_of<bins + 2>(executor, values, [&](double value) -> std::size_t {
    if (value < from) return 0;
    if (value > to) return bins + 1;
    std::size_t bin = 0;
    for (const double end : end_of) bin += static_cast<std::size_t>(value >= end);
    return bin + 1;
  });
  result.below = counts.front();
  std::copy_n(counts.begin() + 1, bins, result.histogram.begin());
  result.above = counts.back();
  return result;
}

}  // namespace ductile::meshadapt
