/// @file
/// Prefix sums and sorting by the runtime and by the standard library. Floor of a prefix sum:
/// reading and writing every value; of sorting: copying.

#include "support/scan_cases.hpp"

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::bench {
namespace {

using runtime::Executor;

using Values = std::span<std::uint32_t>;

void add_floors() {
  for (const ArrayCase& array : array_cases()) {
    add("prefix_sum/" + std::string(array.size) + "/floor", thread_counts(),
        [array](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          std::vector<std::uint32_t> values = random_values(array.count);
          for (auto _ : state) {
            parallel_for(executor, values.size(), [&](std::size_t i) { values[i] += 1; });
            benchmark::ClobberMemory();
          }
        });
    add("sorting/" + std::string(array.size) + "_random/floor", thread_counts(),
        [array](benchmark::State& state, int threads) {
          const Executor executor({.threads = threads});
          const std::vector<std::uint32_t> values = random_values(array.count);
          std::vector<std::uint32_t> copy(values.size());
          for (auto _ : state) {
            parallel_for(executor, values.size(), [&](std::size_t i) { copy[i] = values[i]; });
            benchmark::ClobberMemory();
          }
        });
  }
}

void add_all() {
  add_floors();
  add_scans("ductile.exclusive_scan", thread_counts(), [](int threads) {
    return [executor = Executor({.threads = threads})](Values values) {
      exclusive_scan(executor, values);
    };
  });
  add_scans("std.exclusive_scan", {1}, [](int) {
    return [](Values values) {
      std::exclusive_scan(values.begin(), values.end(), values.begin(), 0U);
    };
  });
  add_sorts("ductile.parallel_sort", thread_counts(), [](int threads) {
    return [executor = Executor({.threads = threads})](Values values) {
      parallel_sort(executor, values);
    };
  });
  add_sorts("std.sort", {1},
            [](int) { return [](Values values) { std::sort(values.begin(), values.end()); }; });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
