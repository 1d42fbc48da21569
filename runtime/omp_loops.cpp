/// @file
/// Schedules of OpenMP, over chunks of the loop's grain.

#include "loop.hpp"

namespace ductile::runtime {

namespace {

/// Runs chunk c; after an exception the remaining chunks do nothing.
void run_chunk(Loop& loop, long long c) {
  const std::size_t begin = static_cast<std::size_t>(c) * loop.grain;
  loop.run(begin, loop.n - begin < loop.grain ? loop.n : begin + loop.grain);
}

}  // namespace

void run_omp_static(const Executor& executor, Loop& loop) {
  const auto chunks = static_cast<long long>(loop.chunk_count());
  run_team(executor, Turnout::everyone, everyone_of(executor), [&](int) {
#pragma omp for schedule(static) nowait
    for (long long c = 0; c < chunks; ++c) run_chunk(loop, c);
  });
}

void run_omp_dynamic(const Executor& executor, Loop& loop) {
  const auto chunks = static_cast<long long>(loop.chunk_count());
  run_team(executor, Turnout::everyone, everyone_of(executor), [&](int) {
#pragma omp for schedule(dynamic, 1) nowait
    for (long long c = 0; c < chunks; ++c) run_chunk(loop, c);
  });
}

void run_omp_guided(const Executor& executor, Loop& loop) {
  const auto chunks = static_cast<long long>(loop.chunk_count());
  run_team(executor, Turnout::everyone, everyone_of(executor), [&](int) {
#pragma omp for schedule(guided, 1) nowait
    for (long long c = 0; c < chunks; ++c) run_chunk(loop, c);
  });
}

}  // namespace ductile::runtime
