/// @file
/// ProgressLine: reports the progress of a long run: on a terminal by one line that changes in
/// place, elsewhere by an occasional line, so that logs stay short.
#pragma once

#include <chrono>
#include <string>

namespace ductile::paper {

/// Thread safety: one thread.
class ProgressLine {
 public:
  ProgressLine();
  /// Clears the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// `done` is a share from 0 to 1, from which the remaining time is estimated.
  void show(double done, const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  Clock::time_point start_;
  Clock::time_point shown_;
};

}  // namespace ductile::paper
