/// @file
/// Options and report of run_rounds.
#pragma once

#include <cstddef>

#include "ductile/runtime/deferred_update.hpp"

namespace ductile::runtime {

struct RoundsOptions {
  int most_rounds = 1000;                ///< stop there even if work is left
  CommitOrder order = CommitOrder::any;  ///< by_source if an owner's updates do not commute
  /// Reservations: if a smaller share than this of those that asked held all, fewer ask in the next
  /// round and the others wait their turn, which saves them planning in vain. 0: all ask always.
  double least_won = 0;
};

/// What a run did. `planned` counts calls of plan, `applied` those that gave a plan, `lost` the
/// reservations that met a higher priority. Seconds are wall-clock.
struct RoundsReport {
  std::size_t rounds = 0, planned = 0, applied = 0, lost = 0, left = 0;
  double conflict_seconds = 0, plan_seconds = 0, apply_seconds = 0, commit_seconds = 0;

  RoundsReport& operator+=(const RoundsReport& other);
};

}  // namespace ductile::runtime
