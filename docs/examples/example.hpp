/// @file
/// Shared by the runtime's examples, not part of Ductile: arguments, and a table of runs at several
/// thread counts whose results must be identical.
///   PROGRAM [SIZE [THREADS...]]
#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace example {

namespace runtime = ductile::runtime;

/// Prints the time of another method, without Ductile or without threads, below the table of runs.
inline void print_yardstick(const char* what, double seconds) {
  std::printf("%-71s %6.3f\n", what, seconds);
}

/// Throws with this text unless the result is as expected.
inline void require(bool as_expected, const char* what) {
  if (!as_expected) throw std::runtime_error(what);
}

/// Time of f() in seconds.
template <class F>
double seconds_of(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Arguments {
  std::size_t size;
  std::vector<int> thread_counts{1, 2, 3, 4, 8};
};

/// Calls solve(executor, report) at each thread count and prints a line for each. Throws unless
/// all results are equal; returns the result.
template <class Solve>
auto solve_at_each_thread_count(const Arguments& arguments, Solve&& solve) {
  using Result = std::invoke_result_t<Solve, runtime::Executor&, runtime::RoundsReport&>;
  std::optional<Result> first;
  std::printf(
      "threads  rounds  planned  applied conflicts  seconds: find   plan  apply commit  all\n");
  for (const int threads : arguments.thread_counts) {
    runtime::Executor executor({.threads = threads});
    runtime::RoundsReport report;
    std::optional<Result> result;
    const double seconds = seconds_of([&] { result = solve(executor, report); });
    std::printf("%7d %7zu %8zu %8zu %9zu %14.3f %6.3f %6.3f %6.3f %6.3f\n", threads, report.rounds,
                report.planned, report.applied, report.lost, report.conflict_seconds,
                report.plan_seconds, report.apply_seconds, report.commit_seconds, seconds);
    require(report.left == 0, "work is left");
    require(!first || *first == *result, "the result depends on the number of threads");
    if (!first) first = std::move(result);
  }
  return *std::move(first);
}

/// Calls body(arguments) and returns the exit status of main(): 1, with a message, if it throws.
template <class Body>
int run(int argument_count, char** argument, std::size_t usual_size, Body&& body) {
  try {
    Arguments arguments{usual_size};
    if (argument_count > 1) arguments.size = std::strtoull(argument[1], nullptr, 10);
    require(arguments.size >= 10, "SIZE is a number, at least 10");
    if (argument_count > 2) arguments.thread_counts.clear();
    for (int i = 2; i < argument_count; ++i)
      arguments.thread_counts.push_back(std::atoi(argument[i]));
    body(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argument[0], error.what());
    return 1;
  }
  return 0;
}

}  // namespace example
