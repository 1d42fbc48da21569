/// @file
/// Options and report of run_rounds, and the timer of its phases.
#pragma once

#include <chrono>
#include <cstddef>
#include <limits>

#include "ductile/runtime/cautious_operator.hpp"

namespace ductile::runtime {

struct RoundsOptions {
  Strategy strategy = Strategy::automatic;
  /// Stop there even if work is left, and report how much. By default a run goes on until nothing
  /// is left, which is never if the operator wakes items for ever. Within one round of the
  /// strategies regions and locks whoever is woken has its turn in the same round, too. In order
  /// there is one round.
  int most_rounds = std::numeric_limits<int>::max();
};

/// What a run did. Seconds are wall-clock; a phase's are those of all its loops and what is
/// between. Where an item is applied right after it was planned, both count as applying; in order
/// no seconds are told.
struct RoundsReport {
  std::size_t rounds = 0;
  std::size_t batches = 0;    ///< sets of items that ran together: windows, classes, or tiles
  std::size_t planned = 0;    ///< calls of plan
  std::size_t applied = 0;    ///< plans carried out
  std::size_t lost = 0;       ///< how often an item had to wait for another, or to plan again
  std::size_t committed = 0;  ///< deferred updates
  std::size_t left = 0;       ///< work that most_rounds cut off; 0 unless that is set

  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;
  double wake_seconds = 0;  ///< collecting the next round's work

  double seconds() const {
    return conflict_seconds + plan_seconds + apply_seconds + commit_seconds + wake_seconds;
  }

  RoundsReport& operator+=(const RoundsReport& other);
};

/// Adds the time from its construction to its destruction to a report. Thread safety: one thread,
/// outside of loops; the report outlives it.
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
