#include "ticks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ductile::cli {

namespace {

/// A power of ten times 1, 2 or 5.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  return 10 * power;
}

/// A number with the digits that distinguish it from its neighbours, a step away, on a scale up to
/// `largest`.
std::string label_of(double value, double step, double largest) {
  char text[64];
  const auto digits = [](double of) { return static_cast<int>(std::floor(std::log10(of) + 1e-9)); };
  if (largest >= 1e6 || largest < 1e-3)
    std::snprintf(text, sizeof text, "%.*e", std::clamp(digits(largest) - digits(step), 0, 17),
                  value);
  else
    std::snprintf(text, sizeof text, "%.*f", std::max(0, -digits(step)), value);
  return text;
}

}  // namespace

std::vector<Tick> round_ticks(double from, double to, int most) {
  const double largest = std::max(std::abs(from), std::abs(to));
  const double range = to / 2 - from / 2;  // half of it, which is a number whatever the ends are
  if (!(range > largest * 1e-13)) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", from);
    return {{0.5, text}};
  }
  const double step = round_step(2 * (range / most));
  std::vector<Tick> ticks;
  const double first = std::ceil(from / step - 1e-9);
  for (int i = 0; i <= most + 1; ++i) {
    const double value = (first + i) * step + 0.0;
    const double at = (value / 2 - from / 2) / range;
    if (!(at <= 1 + 1e-9)) break;
    ticks.push_back({std::clamp(at, 0.0, 1.0), label_of(value, step, largest)});
  }
  return ticks.empty() ? round_ticks(from, to, most + 1) : ticks;
}

}  // namespace ductile::cli
