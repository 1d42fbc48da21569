/// @file
/// PhaseTimer: adds the time of a scope to a counter of a report, and tells a recording what the
/// loops in the scope are for.
#pragma once

#include <chrono>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/recording.hpp"

namespace ductile::runtime {

/// From construction to destruction. Thread safety: one thread, outside of loops; the report and
/// the executor outlive it.
class PhaseTimer {
 public:
  PhaseTimer(double& seconds, const Executor& executor, Phase phase)
      : seconds_(seconds), recording_(executor.recording()) {
    if (recording_ != nullptr) before_ = recording_->set_phase(phase);
  }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;
  ~PhaseTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (recording_ != nullptr) recording_->set_phase(before_);
  }

 private:
  double& seconds_;
  Recording* recording_;
  Phase before_ = Phase::other;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace ductile::runtime
