#include "ductile/runtime/recording.hpp"

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <utility>

namespace ductile::runtime {

namespace {

double nanoseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

/// Nanoseconds. The system takes a core away for longer than that. It is asked no more often how
/// long the thread has run: after each time the next code begins with a cold cache.
constexpr double suspicious = 2e5;

/// Nanoseconds this thread has run so far; those in which others had its core, or in which it was
/// stopped, are not among them, if the system can tell.
double ran() {
  std::timespec time{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) != 0)
    return nanoseconds(std::chrono::steady_clock::now().time_since_epoch());
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

}  // namespace

Recording::Recording() {
  begin_lap();
  double least = 1e9;
  for (int i = 0; i < 100; ++i) least = std::min(least, lap());
  clock_ns_ = least;
}

double Recording::lap() {
  const Clock::time_point now = Clock::now();
  double ns = nanoseconds(now - std::exchange(last_, now)) - clock_ns_;
  if (ns > suspicious) {
    asked_ = now;
    const double gone = nanoseconds(now - start_) - ran();
    ns -= std::max(0.0, gone - std::exchange(gone_, gone));
  }
  return std::max(0.0, ns) + std::exchange(held_, 0.0);
}

/// Leaves out what was between the last lap and this one. Where the core is taken away between the
/// two readings, that lies before the lap, as in lap() it lies behind.
void Recording::begin_lap() {
  if (nanoseconds(Clock::now() - asked_) > suspicious) {
    const double before = ran();
    asked_ = Clock::now();
    gone_ = nanoseconds(asked_ - start_) - before;
  }
  last_ = Clock::now();
  held_ = 0;
}

void Recording::add(Stretch::Kind kind, std::size_t first, std::size_t block) {
  stretches_.push_back({section_, round_, phase_, kind, first, costs_.size() - first, block});
}

/// Keeps a cost. The time that it takes to make room for it is nobody's.
void Recording::note(double cost_ns) {
  const bool full = costs_.size() == costs_.capacity();
  costs_.push_back(static_cast<float>(cost_ns));
  if (full) begin_lap();
}

/// Books the time since the last loop as serial, were it none: all recordings of a run have the
/// same stretches.
void Recording::flush() {
  const double ns = lap();
  if (paused_) return;
  note(ns);
  add(Stretch::Kind::serial, costs_.size() - 1);
  begin_lap();
}

void Recording::take_least(const Recording& again) {
  if (sections_ != again.sections_ || stretches_ != again.stretches_ || waits_ != again.waits_ ||
      costs_.size() != again.costs_.size())
    throw std::invalid_argument("Recording::take_least: these are not recordings of the same run");
  for (std::size_t i = 0; i < costs_.size(); ++i) costs_[i] = std::min(costs_[i], again.costs_[i]);
}

void Recording::begin_section(std::string name) {
  flush();
  paused_ = false;
  const auto known = std::find(sections_.begin(), sections_.end(), name);
  section_ = static_cast<std::uint32_t>(known - sections_.begin());
  if (known == sections_.end()) sections_.push_back(std::move(name));
  begin_lap();
}

void Recording::pause() {
  flush();
  paused_ = true;
}

Phase Recording::set_phase(Phase phase) {
  flush();
  return std::exchange(phase_, phase);
}

void Recording::begin_loop() {
  flush();
  loop_first_ = chunk_first_ = costs_.size();
  items_ = given_ = false;
  block_ = 0;
  cost_of_.clear();
  first_wait_ = waits_.size();
  in_loop_ = true;
  begin_lap();
}

void Recording::end_item() {
  if (in_loop_ && !paused_) note(lap());
}

void Recording::end_item(double cost_ns) {
  if (paused_) return;
  note(cost_ns);
  given_ = true;
  if (in_loop_) return;
  add(Stretch::Kind::serial, costs_.size() - 1);  // of a loop too short to share
  begin_lap();
}

void Recording::end_chunk() {
  if (!cost_of_.empty()) return end_part();
  const double ns = lap();
  if (costs_.size() == chunk_first_) {
    note(ns);
  } else {
    items_ = true;
    if (block_ == 0) block_ = costs_.size() - chunk_first_;
    if (!given_) costs_.back() += static_cast<float>(ns);  // what followed the last item
  }
  chunk_first_ = costs_.size();
  begin_lap();
}

void Recording::begin_part(std::size_t part) {
  if (!in_loop_) return;  // of a loop that is not shared
  end_part();
  if (part >= cost_of_.size()) cost_of_.resize(part + 1);
  part_ = part;
  begin_lap();
}

void Recording::end_part() {
  const double ns = lap();
  if (!cost_of_.empty()) cost_of_[part_] += static_cast<float>(ns);
}

void Recording::part_waits(std::size_t part, std::size_t on) {
  if (on >= part)
    throw std::invalid_argument("Recording::part_waits: a part can wait for earlier ones only");
  if (!in_loop_) return;
  waits_.push_back({static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(on)});
}

void Recording::end_loop() {
  in_loop_ = false;
  if (!cost_of_.empty()) {
    costs_.resize(loop_first_);
    costs_.insert(costs_.end(), cost_of_.begin(), cost_of_.end());
    const auto first_wait = waits_.begin() + static_cast<std::ptrdiff_t>(first_wait_);
    std::sort(first_wait, waits_.end());
  }
  if (paused_) {
    costs_.resize(loop_first_);
    waits_.resize(first_wait_);
  } else {
    add(items_ ? Stretch::Kind::items : Stretch::Kind::chunks, loop_first_, items_ ? block_ : 1);
    stretches_.back().first_wait = first_wait_;
    stretches_.back().waits = waits_.size() - first_wait_;
  }
  begin_lap();
}

}  // namespace ductile::runtime
