/// @file
/// Loops and prefix sums by OpenMP's own directives. Built twice, once by the project's compiler
/// and once by Clang if that is another one, so that GCC's runtime (gomp) and LLVM's (libomp) are
/// both measured. It does not use Ductile's library, which brings an OpenMP runtime of its own.

#include <span>

#include "support/loop_cases.hpp"
#include "support/scan_cases.hpp"

namespace ductile::bench {
namespace {

#ifdef __clang__
const std::string library = "libomp.";
#else
const std::string library = "gomp.";
#endif

struct Static {
  int threads;
  void operator()(std::size_t n, auto&& body) const {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::size_t i = 0; i < n; ++i) body(i);
  }
};

struct Dynamic {
  int threads;
  void operator()(std::size_t n, auto&& body) const {
#pragma omp parallel for num_threads(threads) schedule(dynamic, loop_grain)
    for (std::size_t i = 0; i < n; ++i) body(i);
  }
};

struct Guided {
  int threads;
  void operator()(std::size_t n, auto&& body) const {
#pragma omp parallel for num_threads(threads) schedule(guided, loop_grain)
    for (std::size_t i = 0; i < n; ++i) body(i);
  }
};

struct Scan {
  int threads;
  void operator()(std::span<std::uint32_t> span) const {
    std::uint32_t* const values = span.data();
    const std::size_t n = span.size();
    std::uint32_t sum = 0;
#pragma omp parallel for num_threads(threads) reduction(inscan, + : sum)
    for (std::size_t i = 0; i < n; ++i) {
      values[i] = sum;  // the scan directive runs this after the part below, for all i
#pragma omp scan exclusive(sum)
      sum += values[i];
    }
  }
};

void add_all() {
  add_loops(library + "static", [](int threads) { return Static{threads}; });
  add_loops(library + "dynamic", [](int threads) { return Dynamic{threads}; });
  add_loops(library + "guided", [](int threads) { return Guided{threads}; });
  add_scans(library + "inscan", thread_counts(), [](int threads) { return Scan{threads}; });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
