/// @file
/// A user's program on Ductile::runtime alone: sums the numbers below a million in parallel.

#include <cstdio>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

int main() {
  const ductile::runtime::Executor executor({.threads = 2});
  const auto sum = ductile::runtime::parallel_reduce(
      executor, 1000000, 0LL, [](std::size_t i) { return static_cast<long long>(i); },
      [](long long a, long long b) { return a + b; });
  std::printf("runtime: %lld\n", sum);
  return sum == 499999500000LL ? 0 : 1;
}
