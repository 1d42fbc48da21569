#include "loop_cases.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "ductile/runtime/hash.hpp"

namespace ductile::bench {
namespace {

/// A pseudo-random number in (0, 1], the same in every run.
double random(std::size_t i) {
  return (runtime::mix32(static_cast<std::uint32_t>(i)) + 1.0) / 4294967296.0;
}

double place(std::size_t i, std::size_t n) {
  return static_cast<double>(i) / static_cast<double>(n);
}

constexpr Shape shapes[] = {
    {"constant", [](std::size_t, std::size_t) { return 1.0; }},
    {"rising", [](std::size_t i, std::size_t n) { return place(i, n); }},
    {"falling", [](std::size_t i, std::size_t n) { return 1.0 - place(i, n); }},
    {"random", [](std::size_t i, std::size_t) { return random(i); }},
    {"random_exponential", [](std::size_t i, std::size_t) { return -std::log(random(i)); }},
    {"exponential", [](std::size_t i, std::size_t n) { return std::exp(10.0 * place(i, n)); }},
    {"step", [](std::size_t i, std::size_t n) { return place(i, n) < 0.5 ? 1.0 : 10.0; }},
    // The last iteration takes 0.3 of the time of all the others.
    {"spike_at_end",
     [](std::size_t i, std::size_t n) { return i + 1 < n ? 1.0 : 0.3 * static_cast<double>(n); }},
};

struct Size {
  std::size_t iterations;
  double mean_units;
};

std::vector<Size> sizes() {
  if (extent() == Extent::quick) return {{1000, 200}};
  if (extent() == Extent::standard) return {{1000, 20000}, {100000, 200}, {1000000, 20}};
  std::vector<Size> grid;
  for (const std::size_t iterations : {1000U, 10000U, 100000U, 1000000U, 10000000U})
    for (const double mean_units : {20.0, 200.0, 2000.0, 20000.0})
      if (static_cast<double>(iterations) * mean_units < 2.5e9)  // seconds, not minutes
        grid.push_back({iterations, mean_units});
  return grid;
}

/// 1e5x200ns
std::string name_of(Size size) {
  const auto power = std::to_string(std::lround(std::log10(size.iterations)));
  const long units = std::lround(size.mean_units);
  return "1e" + power + "x" +
         (units < 1000 ? std::to_string(units) + "ns" : std::to_string(units / 1000) + "us");
}

}  // namespace

const std::vector<LoopCase>& loop_cases() {
  static const std::vector<LoopCase> cases = [] {
    // Loops with trivial bodies measure the cost of a launch and of handing out iterations.
    std::vector<LoopCase> made = {{"launch", shapes, 128, 0}, {"empty_1e6", shapes, 1000000, 0}};
    for (const Size size : sizes())
      for (const Shape& shape : shapes)
        made.push_back({std::string(shape.name) + '_' + name_of(size), &shape, size.iterations,
                        size.mean_units});
    return made;
  }();
  return cases;
}

std::span<const std::uint32_t> units_of(const LoopCase& loop_case) {
  static std::map<std::string, std::vector<std::uint32_t>> made;
  std::vector<std::uint32_t>& units = made[loop_case.name];
  if (!units.empty()) return units;
  const std::size_t n = loop_case.iterations;
  const auto raw = [&](std::size_t i) { return loop_case.shape->cost(i, n); };
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += raw(i);
  const double scale = loop_case.mean_units * static_cast<double>(n) / sum;
  units.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    units[i] = static_cast<std::uint32_t>(std::lround(raw(i) * scale));
  return units;
}

}  // namespace ductile::bench
