#include "extent.hpp"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

namespace ductile::bench {
namespace {

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

Extent extent() {
  const std::string name = environment("DUCTILE_BENCH");
  if (name == "quick") return Extent::quick;
  if (name == "full") return Extent::full;
  if (name.empty() || name == "standard") return Extent::standard;
  throw std::runtime_error("DUCTILE_BENCH: expected quick, standard or full, found " + name);
}

std::vector<int> thread_counts() {
  const std::string list = environment("DUCTILE_BENCH_THREADS");
  std::vector<int> counts;
  std::istringstream words(list);
  for (int count = 0; words >> count;) {
    if (count < 1) throw std::runtime_error("DUCTILE_BENCH_THREADS: expected at least 1 thread");
    counts.push_back(count);
  }
  if (!words.eof())
    throw std::runtime_error("DUCTILE_BENCH_THREADS: expected numbers, found " + list);
  if (!counts.empty()) return counts;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int count = 1; count < cores; count *= 2) counts.push_back(count);
  counts.push_back(cores);
  return counts;
}

std::vector<int> team_sizes() {
  std::vector<int> sizes = thread_counts();
  std::erase(sizes, 1);
  if (sizes.empty()) sizes.push_back(1);
  return sizes;
}

int run(int argc, char** argv, void (*add_all)()) try {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("extent", by_extent("quick", "standard", "full"));
  const std::string waiting = environment("OMP_WAIT_POLICY");  // decides what a launch costs
  benchmark::AddCustomContext("OMP_WAIT_POLICY", waiting.empty() ? "not set" : waiting);
  benchmark::AddCustomContext("compiler", __VERSION__);
  add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const std::exception& error) {
  std::cerr << argv[0] << ": " << error.what() << '\n';
  return 1;
}

}  // namespace ductile::bench
