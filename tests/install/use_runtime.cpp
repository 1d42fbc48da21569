/// @file
/// A user's program on Ductile::runtime alone: sums the numbers below a million in parallel,
/// and colours a path.

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

int main() {
  const ductile::runtime::Executor executor({.threads = 2});
  const auto sum = ductile::runtime::parallel_reduce(
      executor, 1000000, 0LL, [](std::size_t i) { return static_cast<long long>(i); },
      [](long long a, long long b) { return a + b; });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t v = 1; v < 1000; ++v) edges.emplace_back(v - 1, v);
  const auto path = ductile::runtime::csr_rows(1000, edges);
  const std::uint32_t colours = colour(executor, path.view()).count;
  std::printf("runtime: %lld, %u colours\n", sum, colours);
  return sum == 499999500000LL && (colours == 2 || colours == 3) ? 0 : 1;
}
