/// @file
/// ProgressBar: one line on standard error, rewritten in place, for people who watch `adapt`.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string_view>
#include <utility>

#include "ductile/meshadapt/adapt_options.hpp"
#include "files.hpp"

namespace ductile::cli {

/// The bar goes by how far the number of changes between two steps of smoothing has fallen below
/// the most so far, and never back.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown) : shown_(shown) {}
  ~ProgressBar() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows the bar, the elapsed time and the step, at most twenty times a second.
  void show(const AdaptProgress& progress) {
    share_ = share_after(progress);
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

  /// How much of the bar is full after this step, from 0 to 1.
  double share_after(const AdaptProgress& progress) {
    if (progress.step != std::string_view("smooth")) {
      changes_ += progress.changes;
      return share_;
    }
    most_ = std::max(most_, changes_);
    const std::size_t changes = std::exchange(changes_, 0);
    if (most_ == 0) return share_;
    return std::max(share_, 1 - static_cast<double>(changes) / static_cast<double>(most_));
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_;
  Clock::time_point begin_ = Clock::now(), last_{};
  std::size_t changes_ = 0, most_ = 0;
  double share_ = 0;
};

}  // namespace ductile::cli
