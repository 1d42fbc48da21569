/// @file
/// Loops of many shapes under every schedule. `shape` names how the cost depends on the index;
/// counter `over_ideal` is the time over (time of the same loop on one thread / threads), 1 at
/// best. The serial time is taken once per shape, so compare within one run and mind a noisy
/// machine.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace {

using namespace ductile::runtime;

/// Takes a time proportional to `units`, about a nanosecond each, and touches no memory.
void work(std::uint32_t units) {
  std::uint64_t x = units;
  for (std::uint32_t i = 0; i < units; ++i) benchmark::DoNotOptimize(x = x * 3 + 1);
}

struct Shape {
  const char* name;
  double (*cost)(double x, std::uint32_t i);  // x: index / n; the mean is set afterwards
};

double uniform(std::uint32_t i) { return (mix32(i) + 1.0) / 4294967296.0; }

constexpr Shape shapes[] = {
    {"constant", [](double, std::uint32_t) { return 1.0; }},
    {"rising", [](double x, std::uint32_t) { return x; }},
    {"falling", [](double x, std::uint32_t) { return 1.0 - x; }},
    {"exponential", [](double x, std::uint32_t) { return std::exp(10.0 * x); }},
    {"random", [](double, std::uint32_t i) { return uniform(i); }},
    {"random_exponential", [](double, std::uint32_t i) { return -std::log(uniform(i)); }},
    {"step", [](double x, std::uint32_t) { return x < 0.5 ? 1.0 : 10.0; }},
    {"spike", [](double x, std::uint32_t i) { return i == 7 ? 0.3 * 7 / x : 1.0; }},
};

std::vector<std::uint32_t> costs(const Shape& shape, std::size_t n, double mean_units) {
  std::vector<double> raw(n);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i)
    sum += raw[i] =
        shape.cost(static_cast<double>(i) / static_cast<double>(n), static_cast<std::uint32_t>(i));
  std::vector<std::uint32_t> units(n);
  for (std::size_t i = 0; i < n; ++i)
    units[i] =
        static_cast<std::uint32_t>(std::lround(raw[i] / sum * static_cast<double>(n) * mean_units));
  return units;
}

double seconds_serial(const std::vector<std::uint32_t>& units) {
  double best = 1e9;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    for (const std::uint32_t u : units) work(u);
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

constexpr std::pair<const char*, Schedule> schedules[] = {{"static", Schedule::omp_static},
                                                          {"dynamic", Schedule::omp_dynamic},
                                                          {"guided", Schedule::omp_guided},
                                                          {"signal", Schedule::steal_by_signal},
                                                          {"atomics", Schedule::steal_by_atomics}};

void shaped_loop(benchmark::State& state, const Shape& shape, Schedule schedule, std::size_t n,
                 double mean_units) {
  const auto threads = static_cast<int>(state.range(0));
  const Executor executor({.threads = threads, .schedule = schedule});
  const std::vector<std::uint32_t> units = costs(shape, n, mean_units);
  const double serial = seconds_serial(units);
  std::vector<double> seconds;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for(executor, n, [&](std::size_t i) { work(units[i]); }, {.grain = 64});
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(),
                   seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2),
                   seconds.end());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
  state.counters["over_ideal"] = seconds[seconds.size() / 2] * threads / serial;
}

void launch(benchmark::State& state, Schedule schedule) {
  const Executor executor({.threads = static_cast<int>(state.range(0)), .schedule = schedule});
  for (auto _ : state)
    parallel_for(executor, 128, [](std::size_t i) { benchmark::DoNotOptimize(i); }, {.grain = 64});
}

/// An empty body: what handing out an iteration costs.
void overhead(benchmark::State& state, Schedule schedule, std::size_t grain) {
  const Executor executor({.threads = static_cast<int>(state.range(0)), .schedule = schedule});
  constexpr std::size_t n = 1000000;
  for (auto _ : state)
    parallel_for(executor, n, [](std::size_t i) { benchmark::DoNotOptimize(i); }, {.grain = grain});
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}

void with_threads(benchmark::internal::Benchmark* b) {
  b->ArgName("threads")->Arg(2)->UseRealTime()->Unit(benchmark::kMicrosecond);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto& [label, s] : schedules) {
    const Schedule schedule = s;
    const std::string name = label;
    with_threads(benchmark::RegisterBenchmark(
        ("launch/" + name).c_str(), [=](benchmark::State& state) { launch(state, schedule); }));
    for (const std::size_t grain : {1, 64})
      with_threads(benchmark::RegisterBenchmark(
          ("overhead/grain:" + std::to_string(grain) + "/" + name).c_str(),
          [=](benchmark::State& state) { overhead(state, schedule, grain); }));
  }
  for (const auto& [n, mean_units] : {std::pair(100000U, 200.0), std::pair(1000000U, 20.0)})
    for (const Shape& shape : shapes)
      for (const auto& [label, s] : schedules) {
        const Schedule schedule = s;
        const std::size_t count = n;
        const double units = mean_units;
        with_threads(benchmark::RegisterBenchmark(
            (std::string(shape.name) + "/size:" + std::to_string(n) + "/" + label).c_str(),
            [=, &shape](benchmark::State& state) {
              shaped_loop(state, shape, schedule, count, units);
            }));
      }
  benchmark::RunSpecifiedBenchmarks();
}
