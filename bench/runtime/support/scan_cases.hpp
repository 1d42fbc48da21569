/// @file
/// add_scans, add_sorts: add candidates that compute prefix sums or sort, at all sizes; each
/// sample's result is checked once.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "add.hpp"
#include "extent.hpp"

#include "ductile/runtime/hash.hpp"

namespace ductile::bench {

struct ArrayCase {
  const char* size;
  std::size_t count;
};

inline std::vector<ArrayCase> array_cases() {
  return by_extent<std::vector<ArrayCase>>(
      {{"1e4", 10000}}, {{"1e4", 10000}, {"1e6", 1000000}},
      {{"1e3", 1000}, {"1e4", 10000}, {"1e5", 100000}, {"1e6", 1000000}, {"1e7", 10000000}});
}

inline std::vector<std::uint32_t> random_values(std::size_t count) {
  std::vector<std::uint32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = runtime::mix32(static_cast<std::uint32_t>(i));
  return values;
}

/// `make(threads)` returns a function that scans a span of values in place; sums wrap.
template <class Make>
void add_scans(const std::string& candidate, const std::vector<int>& threads_of, Make make) {
  for (const ArrayCase& array : array_cases())
    add("prefix_sum/" + std::string(array.size) + '/' + candidate, threads_of,
        [array, make](benchmark::State& state, int threads) {
          std::vector<std::uint32_t> values = random_values(array.count), expected = values;
          std::exclusive_scan(expected.begin(), expected.end(), expected.begin(), 0U);
          auto scan = make(threads);
          scan(std::span(values));
          if (values != expected) state.SkipWithError("not the sums of the values before");
          for (auto _ : state) {
            scan(std::span(values));
            benchmark::ClobberMemory();
          }
        });
}

/// `make(threads)` returns a function that sorts a span of values. Time includes copying them
/// there.
template <class Make>
void add_sorts(const std::string& candidate, const std::vector<int>& threads_of, Make make) {
  for (const ArrayCase& array : array_cases())
    add("sorting/" + std::string(array.size) + "_random/" + candidate, threads_of,
        [array, make](benchmark::State& state, int threads) {
          const std::vector<std::uint32_t> values = random_values(array.count);
          std::vector<std::uint32_t> sorted;
          auto sort = make(threads);
          for (auto _ : state) {
            sorted = values;
            sort(std::span(sorted));
            benchmark::ClobberMemory();
          }
          if (!std::is_sorted(sorted.begin(), sorted.end())) state.SkipWithError("not sorted");
        });
}

}  // namespace ductile::bench
