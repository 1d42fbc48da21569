/// @file
/// KernelTimer: measures a kernel's time in a run.
#pragma once

#include <chrono>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/recording.hpp"

namespace ductile::meshadapt {

/// Adds the time of a scope to a kernel's, and makes it a section of the executor's recording.
class KernelTimer {
 public:
  KernelTimer(const runtime::Executor& executor, const char* kernel, double& seconds)
      : recording_(executor.recording()), seconds_(seconds) {
    if (recording_ != nullptr) recording_->begin_section(kernel);
  }
  KernelTimer(const KernelTimer&) = delete;
  KernelTimer& operator=(const KernelTimer&) = delete;
  ~KernelTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (recording_ != nullptr) recording_->begin_section("other");
  }

 private:
  runtime::Recording* recording_;
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace ductile::meshadapt
