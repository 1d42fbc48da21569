/// @file
/// ProgressLine: how far a long run is. On a terminal one line that changes in place; elsewhere a
/// line now and then, so that a log stays short.
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

  /// `done` is a share from 0 to 1; the time still needed is guessed from it.
  void show(double done, const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  Clock::time_point start_;
  Clock::time_point shown_;
};

}  // namespace ductile::paper
