#include "ductile/runtime/replay.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>
#include <stdexcept>

namespace ductile::runtime {

namespace {

using Kind = Recording::Stretch::Kind;

std::vector<double> chunks_of(std::span<const float> costs, std::size_t block) {
  std::vector<double> chunks((costs.size() + block - 1) / block);
  for (std::size_t i = 0; i < costs.size(); ++i) chunks[i / block] += double{costs[i]};
  return chunks;
}

/// When the last chunk ends if the thread that is free first takes the next. Waits are in order
/// of chunks; a thread that took one is not free while that waits.
double makespan(const std::vector<double>& chunks, std::span<const Recording::Wait> waits,
                std::size_t threads) {
  std::vector<double> ends(chunks.size());
  std::vector<double> free_at(std::min(chunks.size(), threads));
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    std::pop_heap(free_at.begin(), free_at.end(), std::greater<>());
    double begin = free_at.back();
    for (; !waits.empty() && waits.front().part == i; waits = waits.subspan(1))
      begin = std::max(begin, ends[waits.front().on]);
    free_at.back() = ends[i] = begin + chunks[i];
    std::push_heap(free_at.begin(), free_at.end(), std::greater<>());
  }
  return chunks.empty() ? 0 : *std::max_element(ends.begin(), ends.end());
}

ReplayTimes times_of(const Recording& recording, const Recording::Stretch& stretch,
                     const ReplayOptions& options) {
  const auto costs = std::span(recording.costs()).subspan(stretch.first, stretch.count);
  const auto waits = std::span(recording.waits()).subspan(stretch.first_wait, stretch.waits);
  ReplayTimes times;
  const Kind kind = stretch.kind;
  const bool recut = kind == Kind::items && options.block > 0;
  const std::vector<double> chunks = chunks_of(costs, recut ? options.block : stretch.block);
  const double sum = std::accumulate(chunks.begin(), chunks.end(), 0.0);
  if (kind == Kind::serial) {
    times.serial = times.elapsed = times.critical = sum;
  } else {
    times.launches = options.threads > 1 && chunks.size() > 1 ? 1 : 0;
    const double one = chunks.size() > 1 ? options.launch_ns : 0;
    times.work = sum;
    times.elapsed = static_cast<double>(times.launches) * one +
                    makespan(chunks, waits, static_cast<std::size_t>(options.threads));
    times.critical = one + makespan(chunks, waits, chunks.size());
  }
  for (double* const time : {&times.serial, &times.work, &times.elapsed, &times.critical})
    *time *= 1e-9;
  return times;
}

}  // namespace

ReplayTimes& ReplayTimes::operator+=(const ReplayTimes& other) {
  serial += other.serial;
  work += other.work;
  elapsed += other.elapsed;
  critical += other.critical;
  launches += other.launches;
  return *this;
}

Replay replay(const Recording& recording, const ReplayOptions& options) {
  if (options.threads < 1) throw std::invalid_argument("replay: expected at least one thread");
  Replay result;
  result.threads = options.threads;
  for (const std::string& name : recording.sections()) result.sections.push_back({name, {}, {}});
  result.rounds.resize(recording.rounds());
  for (const Recording::Stretch& stretch : recording.stretches()) {
    const ReplayTimes times = times_of(recording, stretch, options);
    ReplaySection& section = result.sections[stretch.section];
    result.total += times;
    section.total += times;
    section.times_of[static_cast<std::size_t>(stretch.phase)] += times;
    if (stretch.round > 0) result.rounds[stretch.round - 1] += times;
  }
  return result;
}

}  // namespace ductile::runtime
