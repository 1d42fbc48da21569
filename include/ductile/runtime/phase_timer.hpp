/// @file
/// PhaseTimer: adds the time of a scope to a counter of a report.
#pragma once

#include <chrono>

namespace ductile::runtime {

/// From construction to destruction. Thread safety: one thread, outside of loops; the report
/// outlives it.
class PhaseTimer {
 public:
  explicit PhaseTimer(double& seconds) : seconds_(seconds) {}
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;
  ~PhaseTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace ductile::runtime
