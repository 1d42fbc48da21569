/// @file
/// Loops to parallelise: shapes (how the cost of an iteration depends on its index), numbers of
/// iterations and mean costs. A new shape is one line in loop_cases.cpp; a new candidate is one
/// call of add_loops.
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "add.hpp"
#include "extent.hpp"

namespace ductile::bench {

/// Takes about a nanosecond per unit and touches no memory. Compiled once, in a file of its own, so
/// that the body is the same for every compiler and runtime.
void work(std::uint32_t units);

struct Shape {
  const char* name;
  double (*cost)(std::size_t i, std::size_t n);  ///< of iteration i of n; scaled to the mean later
};

struct LoopCase {
  std::string name;  ///< SHAPE_ITERATIONSxCOST
  const Shape* shape;
  std::size_t iterations;
  double mean_units;  ///< of work(), nominal nanoseconds
};

/// The cases of this run's extent; made once. Thread safety: one thread.
const std::vector<LoopCase>& loop_cases();

/// Cost of each iteration; made at the first call and kept. Thread safety: one thread.
std::span<const std::uint32_t> units_of(const LoopCase& loop_case);

/// Adds a candidate for all cases. `make(threads)` returns a function that runs a loop: it takes
/// the number of iterations and a body, which it calls for every index. If iterations are handed
/// out in chunks, a chunk has loop_grain of them.
constexpr std::size_t loop_grain = 64;
template <class Make>
void add_loops(const std::string& candidate, Make make) {
  for (const LoopCase& loop_case : loop_cases())
    add("loops/" + loop_case.name + '/' + candidate, team_sizes(),
        [&loop_case, make](benchmark::State& state, int threads) {
          const std::span<const std::uint32_t> units = units_of(loop_case);
          auto loop = make(threads);
          for (auto _ : state) loop(units.size(), [units](std::size_t i) { work(units[i]); });
        });
}

}  // namespace ductile::bench
