#include "forecast.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/replay.hpp"

namespace ductile::bench {

namespace {

constexpr int most_threads = 64, recordings = 5;

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

std::uint64_t record(const Sampler& sampler, runtime::Recording& recording) {
  recording.pause();
  const runtime::Executor executor({.threads = most_threads, .recording = &recording});
  return fingerprint(sampler.adapt_on(executor));
}

}  // namespace

Forecast forecast(const Sampler& sampler, const std::string& case_name) {
  runtime::Recording recording;
  Forecast result{.case_name = case_name};
  result.fingerprint = record(sampler, recording);
  for (int again = 1; again < recordings; ++again) {
    runtime::Recording another;
    if (record(sampler, another) != result.fingerprint)
      throw std::runtime_error(case_name + ": two runs gave different meshes");
    recording.take_least(another);
  }
  for (int threads = 1; threads <= most_threads; threads *= 2)
    result.rows.push_back(
        row_from(replay(recording, {.threads = threads, .launch_ns = 1000 + 30.0 * threads})));
  return result;
}

}  // namespace ductile::bench
