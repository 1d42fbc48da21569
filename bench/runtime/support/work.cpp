#include <benchmark/benchmark.h>

#include "loop_cases.hpp"

namespace ductile::bench {

void work(std::uint32_t units) {
  std::uint64_t x = units;
  // A dependent product and sum: about four cycles.
  for (std::uint32_t i = 0; i < units; ++i) {
    x = x * 0x9e3779b97f4a7c15U + 1;
    benchmark::DoNotOptimize(x);
  }
}

}  // namespace ductile::bench
