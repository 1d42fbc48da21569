/// @file
/// ProgressBar: one line on standard error, rewritten in place, for people who watch `adapt`.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "ductile/meshadapt/adapt_options.hpp"
#include "files.hpp"

namespace ductile::cli {

/// How far a run has come, from 0 to 1, if an iteration made `most` changes and the last one
/// `changes`. Iterations make fewer and fewer, by a factor, so it goes by the logarithm.
inline double share_done(std::size_t changes, std::size_t most) {
  const auto log = [](std::size_t count) { return std::log1p(static_cast<double>(count)); };
  return most == 0 ? 0 : 1 - log(changes) / log(most);
}

class ProgressBar {
 public:
  explicit ProgressBar(bool shown) : shown_(shown) {}
  ~ProgressBar() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows the bar, the elapsed time and the step, at most twenty times a second.
  void show(const meshadapt::AdaptProgress& progress) {
    if (progress.iteration != iteration_) {
      iteration_ = progress.iteration;
      most_ = std::max(most_, changes_);
      share_ = std::max(share_, share_done(changes_, most_));
      changes_ = 0;
    }
    changes_ += progress.changes;
    const Clock::time_point now = Clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    constexpr int width = 20;
    const int full = static_cast<int>(width * share_);
    std::fprintf(stderr, "\r\033[K[%.*s%*s] %.1f s, iteration %d, %s: %s changes", full,
                 "####################", width - full, "",
                 std::chrono::duration<double>(now - begin_).count(), progress.iteration,
                 progress.step, with_commas(progress.changes).c_str());
    std::fflush(stderr);
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_;
  Clock::time_point begin_ = Clock::now(), last_{};
  int iteration_ = 0;
  std::size_t changes_ = 0, most_ = 0;  ///< in this iteration, in any before
  double share_ = 0;                    ///< the bar never goes back
};

}  // namespace ductile::cli
