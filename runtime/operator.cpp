#include "ductile/runtime/operator.hpp"

namespace ductile::runtime {

RoundsReport& RoundsReport::operator+=(const RoundsReport& other) {
  rounds += other.rounds;
  batches += other.batches;
  planned += other.planned;
  applied += other.applied;
  lost += other.lost;
  committed += other.committed;
  left += other.left;
  conflict_seconds += other.conflict_seconds;
  plan_seconds += other.plan_seconds;
  apply_seconds += other.apply_seconds;
  commit_seconds += other.commit_seconds;
  wake_seconds += other.wake_seconds;
  return *this;
}

}  // namespace ductile::runtime
