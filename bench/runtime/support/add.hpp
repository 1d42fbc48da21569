/// @file
/// add: registers a benchmark under the name that the report understands,
/// SUBJECT/CASE/CANDIDATE/threads:N, and measures the distance between threads around it.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "ping_pong.hpp"

namespace ductile::bench {

enum class Clock {
  real,    ///< seconds of the loop over the state
  manual,  ///< seconds that the body reports by SetIterationTime
};

/// `name` is SUBJECT/CASE/CANDIDATE; CANDIDATE is LIBRARY.METHOD, or `floor` for a lower bound of
/// all candidates. body(state, threads) is called for each number of threads; it loops over the
/// state. On more than one thread, counters ping_before_ns and ping_after_ns come with each sample.
/// Thread safety: one thread.
template <class Body>
void add(const std::string& name, const std::vector<int>& thread_counts, Body body,
         Clock clock = Clock::real) {
  const auto between_ping_pongs = [body = std::move(body)](benchmark::State& state) {
    const auto threads = static_cast<int>(state.range(0));
    const double before = threads > 1 ? ping_pong_ns() : 0;
    body(state, threads);
    if (threads == 1) return;
    state.counters["ping_before_ns"] = before;
    state.counters["ping_after_ns"] = ping_pong_ns();
  };
  benchmark::internal::Benchmark* const added =
      benchmark::RegisterBenchmark(name.c_str(), between_ping_pongs);
  added->ArgName("threads")->Unit(benchmark::kMicrosecond);
  for (const int threads : thread_counts) added->Arg(threads);
  if (clock == Clock::real) {
    added->UseRealTime();
  } else {
    added->UseManualTime();
  }
}

}  // namespace ductile::bench
