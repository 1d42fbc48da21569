#include "axis.hpp"

#include <algorithm>
#include <cmath>

namespace ductile::bench::report {
namespace {

/// The best of a case is a case's place on the axis; of these the median, of two the lower. Bests
/// that are faster than the floor are mistakes.
double usual_best(std::span<const Contest> contests) {
  std::vector<double> bests;
  for (const Contest& contest : contests) bests.push_back(ratio_of(contest.best()));
  const auto middle = bests.begin() + static_cast<std::ptrdiff_t>((bests.size() - 1) / 2);
  std::nth_element(bests.begin(), middle, bests.end());
  return std::max(1.0, *middle);
}

}  // namespace

double ratio_of(const Figure& figure) { return figure.over_floor.value_or(figure.over_best); }

Axis::Axis(std::span<const Contest> contests) {
  const double usual = usual_best(contests), least = usual / down, most = usual * up;
  double low = std::max(1.0, least), high = std::max(1.5, low);
  for (const Contest& contest : contests)
    for (const Figure& figure : contest.figures) {
      const double ratio = ratio_of(figure);
      if (ratio < least || ratio > most) continue;
      low = std::min(low, ratio);
      high = std::max(high, ratio);
    }
  for (int power = static_cast<int>(std::floor(std::log10(low)));
       ticks_.empty() || ticks_.back() < high; ++power)
    for (const double step : {1, 2, 5}) {
      const double tick = step * std::pow(10, power);
      if (tick <= low) ticks_.clear();  // a later one is the last below
      if (ticks_.empty() || ticks_.back() < high) ticks_.push_back(tick);
    }
}

}  // namespace ductile::bench::report
