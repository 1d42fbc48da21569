/// @file
/// Rescue: checks a mesh that was adapted with curved boundaries. If they crossed each other or
/// grew together, it decides what is kept when the input is adapted again: at first facets near
/// those places, then all curved facets, in the end the whole boundary.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Rescue {
 public:
  /// Refers to the input.
  Rescue(const runtime::Executor& executor, const AnyMesh& input, const MakeMeshOptions& options);

  /// For the next attempt.
  const MakeMeshOptions& options() const { return options_; }

  /// Is the result right, or will nothing help? Otherwise the input should be adapted again. A
  /// result whose boundary cannot have met itself needs no check. Completes the report of one that
  /// is accepted. Thread safety: one caller; runs on the executor.
  bool accepts(AdaptedMesh& adapted, bool may_meet);

 private:
  bool keeps_more(const AdjacentMesh& adapted);
  void complete(AdaptReport& report, bool is_right) const;

  AdjacentMesh input_;
  MakeMeshOptions options_;
  double tolerance_;  // of the surface, as asked for
  double distance_;   // from places at which facets are kept
  int attempts_ = 0;
  std::string first_fault_;
};

extern template class Rescue<2>;
extern template class Rescue<3>;

}  // namespace ductile::meshadapt
