/// @file
/// Distribution: numbers in short, in a few passes over them. A percentile is found among those of
/// a narrow range that must hold it, so nothing is sorted.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/parallel_for.hpp"

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

/// Values by the part of their range that they lie in. A greater value is in no lower part.
class Parts {
 public:
  Parts(const Executor& executor, std::span<const double> values, const Summary& summary)
      : executor_(executor), values_(values), least_(summary.min) {
    const double scale = static_cast<double>(count) / (summary.max - summary.min);
    if (std::isfinite(scale)) scale_ = scale;  // else one part is all
    size_of_ = counts_of<count>(executor, values, [this](double value) { return part_of(value); });
  }

  /// The smallest of the values that at least this share of them do not exceed.
  double percentile(double share) const {
    const double rank = std::ceil(share * static_cast<double>(values_.size()));
    auto below = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
    std::size_t part = 0;
    for (; below >= size_of_[part]; ++part) below -= size_of_[part];
    auto found = runtime::parallel_collect<double>(executor_, values_.size(),
                                                   [&](std::size_t i, auto&& append) {
                                                     if (part_of(values_[i]) == part)
                                                       append(values_[i]);
                                                   });
    const auto at = found.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(found.begin(), at, found.end());
    return *at;
  }

 private:
  static constexpr std::size_t count = 1024;

  std::size_t part_of(double value) const {
    const double part = (value - least_) * scale_;
    return part < static_cast<double>(count) ? static_cast<std::size_t>(part) : count - 1;
  }

  const Executor& executor_;
  std::span<const double> values_;
  double least_, scale_ = 0;
  std::array<std::size_t, count> size_of_;  // [part]
};

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
  result.low = parts.percentile(0.01);
  result.median = parts.percentile(0.5);

  constexpr std::size_t bins = std::tuple_size_v<decltype(result.histogram)>;
  std::array<double, bins> end_of;  // [bin]; the last has its end, too
  const double width = (to - from) / static_cast<double>(bins);
  for (std::size_t bin = 0; bin < bins; ++bin)
    end_of[bin] = from + width * static_cast<double>(bin + 1);
  const auto counts = counts_of<bins + 2>(executor, values, [&](double value) -> std::size_t {
    if (value < from) return 0;
    if (value > to) return bins + 1;
    std::size_t bin = 0;
    for (std::size_t i = 0; i + 1 < bins; ++i) bin += static_cast<std::size_t>(value >= end_of[i]);
    return bin + 1;
  });
  result.below = counts.front();
  std::copy_n(counts.begin() + 1, bins, result.histogram.begin());
  result.above = counts.back();
  return result;
}

}  // namespace ductile::meshadapt
