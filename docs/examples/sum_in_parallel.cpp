/// @file
/// The runtime without meshes: sums 1 / n^2, bit-identical at any number of threads.

#include <cstdio>

#include "ductile/runtime/parallel_for.hpp"

namespace runtime = ductile::runtime;

int main() {
  const auto sum_on = [](int threads) {
    const runtime::Executor executor({.threads = threads});
    return runtime::parallel_reduce(
        executor, 1000000, 0.0,
        [](std::size_t i) {
          const double n = static_cast<double>(i) + 1;
          return 1 / (n * n);
        },
        [](double a, double b) { return a + b; });
  };
  std::printf("%.17g\n", sum_on(4));
  return sum_on(1) == sum_on(4) ? 0 : 1;
}
