#include "forecast.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/replay.hpp"

namespace ductile::bench {

namespace {

constexpr int recordings = 5;

/// Loops are cut for the threads of their executor. A row is of the first of these recordings that
/// was for as many.
constexpr std::array recorded_threads{8, 16, 64};

ForecastRow row_from(const runtime::Replay& replayed) {
  ForecastRow row{.threads = replayed.threads,
                  .serial_seconds = replayed.total.serial,
                  .critical_seconds = replayed.total.critical};
  for (std::size_t i = 0; i < part_names.size(); ++i) {
    runtime::ReplayTimes times;
    for (const runtime::ReplaySection& section : replayed.sections)
      if (section.name == part_names[i]) times = section.total;
    if (std::strcmp(part_names[i], "total") == 0) times = replayed.total;
    row.seconds[i] = times.elapsed;
    row.efficiency[i] = times.elapsed > 0 ? times.balance(replayed.threads) : 0;
  }
  return row;
}

std::uint64_t record(const Sampler& sampler, int threads, runtime::Recording& recording) {
  recording.pause();
  const runtime::Executor executor({.threads = threads, .recording = &recording});
  return fingerprint(sampler.adapt_on(executor));
}

/// Of several runs, the least of each cost. Throws if the result of one is not `expected`, which
/// the first one sets.
runtime::Recording record_least(const Sampler& sampler, const std::string& case_name, int threads,
                                std::optional<std::uint64_t>& expected) {
  runtime::Recording least;
  for (int run = 0; run < recordings; ++run) {
    runtime::Recording again;
    const std::uint64_t found = record(sampler, threads, run == 0 ? least : again);
    if (found != expected.value_or(found))
      throw std::runtime_error(case_name + ": two runs gave different meshes");
    expected = found;
    if (run > 0) least.take_least(again);
  }
  return least;
}

}  // namespace

Forecast forecast(const Sampler& sampler, const std::string& case_name) {
  Forecast result{.case_name = case_name};
  std::optional<std::uint64_t> found;
  int threads = 1;
  for (const int most_threads : recorded_threads) {
    const runtime::Recording recording = record_least(sampler, case_name, most_threads, found);
    for (; threads <= most_threads; threads *= 2)
      result.rows.push_back(
          row_from(replay(recording, {.threads = threads, .launch_ns = 1000 + 30.0 * threads})));
  }
  result.fingerprint = *found;
  return result;
}

}  // namespace ductile::bench
