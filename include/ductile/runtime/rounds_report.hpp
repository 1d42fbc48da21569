/// @file
/// Options and report of run_rounds.
#pragma once

#include <cstddef>
#include <limits>

#include "ductile/runtime/cautious_operator.hpp"
#include "ductile/runtime/deferred_update.hpp"

namespace ductile::runtime {

/// Of a CautiousOperator `strategy` counts, and `most_rounds`, but not in order.
struct RoundsOptions {
  Strategy strategy = Strategy::automatic;
  /// Stop there even if work is left, and report how much. By default a run goes on until nothing
  /// is left, which is never if the operator wakes items for ever. Within one round of the
  /// strategies regions and locks whoever is woken has its turn in the same round, too.
  int most_rounds = std::numeric_limits<int>::max();
  CommitOrder order = CommitOrder::any;  ///< by_source if an owner's updates do not commute
  /// Colouring: a round goes over its work in windows of at most so many items, one after the
  /// other; 0: all at once. Small windows stay in cache while their classes run; large ones keep
  /// many threads busy. Tiles have no windows.
  std::size_t window = 32768;
  /// Reservations: the same, but an item of a window then runs before one of a later window, of
  /// whatever priority. 0: the highest priority of all goes first, or of 2^24 items if there are
  /// more.
  std::size_t reserving_window = 0;
  /// Reservations: if a smaller share than this of those that asked held all, fewer ask in the next
  /// window and the others wait their turn, which saves them planning in vain. 0: all ask always.
  double least_won = 0;
};

/// What a run did. Seconds are wall-clock; a phase's are those of all its loops and what is
/// between. In tiles, planning and applying are one phase, and count as planning; in regions and
/// with locks they count as applying; in order, and by levels, none are told. Of cautious operators
/// `lost` counts how often an item had to wait or to plan again, and `woken` is not counted.
struct RoundsReport {
  std::size_t rounds = 0;
  std::size_t batches = 0;    ///< sets of items that ran together: classes, a window's winners,
                              ///< or all that ran in tiles at once
  std::size_t planned = 0;    ///< calls of plan
  std::size_t applied = 0;    ///< plans carried out
  std::size_t lost = 0;       ///< conflicts: reservations that met a higher priority
  std::size_t dropped = 0;    ///< conflicts: items that left a round because they were woken in it,
                              ///< or as a tile of the same rank has a neighbour
  std::size_t committed = 0;  ///< deferred updates
  std::size_t woken = 0;      ///< items woken, each once a round
  std::size_t left = 0;       ///< work that most_rounds cut off; 0 unless that is set

  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;
  double wake_seconds = 0;  ///< collecting the next round's work

  double seconds() const {
    return conflict_seconds + plan_seconds + apply_seconds + commit_seconds + wake_seconds;
  }

  RoundsReport& operator+=(const RoundsReport& other);
};

}  // namespace ductile::runtime
