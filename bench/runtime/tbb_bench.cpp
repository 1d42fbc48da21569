/// @file
/// Loops, prefix sums and sorting by oneTBB, on its own threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_scan.h>
#include <tbb/parallel_sort.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <memory>

#include "support/loop_cases.hpp"
#include "support/scan_cases.hpp"

namespace ductile::bench {
namespace {

using Values = std::span<std::uint32_t>;
using Range = tbb::blocked_range<std::size_t>;

std::shared_ptr<tbb::task_arena> team(int threads) {
  return std::make_shared<tbb::task_arena>(threads);
}

template <class Partitioner>
void add_partitioner(const std::string& name) {
  add_loops("tbb." + name, [](int threads) {
    return [arena = team(threads)](std::size_t n, auto&& body) {
      arena->execute([&] {
        tbb::parallel_for(
            Range(0, n, loop_grain),
            [&](const Range& range) {
              for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
            },
            Partitioner());
      });
    };
  });
}

void scan(Values values) {
  tbb::parallel_scan(
      Range(0, values.size(), 4096), 0U,
      [values](const Range& range, std::uint32_t sum, bool is_final) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const std::uint32_t value = values[i];
          if (is_final) values[i] = sum;
          sum += value;
        }
        return sum;
      },
      [](std::uint32_t left, std::uint32_t right) { return left + right; });
}

void add_all() {
  add_partitioner<tbb::auto_partitioner>("auto");
  add_partitioner<tbb::simple_partitioner>("simple");
  add_partitioner<tbb::static_partitioner>("static");
  add_scans("tbb.parallel_scan", thread_counts(), [](int threads) {
    return [arena = team(threads)](Values values) { arena->execute([&] { scan(values); }); };
  });
  add_sorts("tbb.parallel_sort", thread_counts(), [](int threads) {
    return [arena = team(threads)](Values values) {
      arena->execute([&] { tbb::parallel_sort(values.begin(), values.end()); });
    };
  });
}

}  // namespace
}  // namespace ductile::bench

int main(int argc, char** argv) { return ductile::bench::run(argc, argv, ductile::bench::add_all); }
