/// @file
/// Loops of many shapes under every schedule of the runtime. Floor: the same loop on one thread,
/// its time divided by the number of threads, or the longest iteration if that is longer.
/// OpenMP and oneTBB run the same loops in programs of their own (openmp_bench, tbb_bench), as the
/// waiting threads of one runtime would disturb another's.

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "support/loop_cases.hpp"

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::bench {
namespace {

using runtime::Executor;
using runtime::Schedule;

/// Lower bound of a parallel loop's time, as a share of the time on one thread.
double least_share(std::span<const std::uint32_t> units, int threads) {
  const auto total = std::accumulate(units.begin(), units.end(), 0.0);
  const auto longest = static_cast<double>(*std::max_element(units.begin(), units.end()));
  return total > 0 ? std::max(1.0 / threads, longest / total) : 1.0 / threads;
}

void serial_loop(benchmark::State& state, const LoopCase& loop_case, int threads) {
  const std::span<const std::uint32_t> units = units_of(loop_case);
  const double share = least_share(units, threads);
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    for (const std::uint32_t u : units) work(u);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    state.SetIterationTime(taken.count() * share);
  }
}

/// Loops in a team, whose threads stay together from one loop to the next.
void add_loops_of_team() {
  for (const LoopCase& loop_case : loop_cases())
    add("loops/" + loop_case.name + "/ductile.team", team_sizes(),
        [&loop_case](benchmark::State& state, int threads) {
          const std::span<const std::uint32_t> units = units_of(loop_case);
          const Executor executor({.threads = threads});
          runtime::with_team(executor, [&] {
            for (auto _ : state)
              parallel_for(executor, units.size(), [units](std::size_t i) { work(units[i]); },
                           {.grain = loop_grain});
          });
        });
}

void add_all() {
  add_loops_of_team();
  for (const LoopCase& loop_case : loop_cases())
    add(
        "loops/" + loop_case.name + "/floor", team_sizes(),
        [&loop_case](benchmark::State& state, int threads) {
          serial_loop(state, loop_case, threads);
        },
        Clock::manual);
  const std::pair<const char*, Schedule> schedules[] = {
      {"automatic", Schedule::automatic},     {"omp_static", Schedule::omp_static},
      {"omp_dynamic", Schedule::omp_dynamic}, {"omp_guided", Schedule::omp_guided},
      {"signal", Schedule::steal_by_signal},  {"atomics", Schedule::steal_by_atomics}};
  for (const auto& [label, s] : schedules)
    add_loops("ductile." + std::string(label), [schedule = s](int threads) {
      return [executor = Executor({.threads = threads, .schedule = schedule})](std::size_t n,
                                                                               auto&& body) {
        parallel_for(executor, n, body, {.grain = loop_grain});
      };
    });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
