/// @file
/// Rescue: looks at a mesh that was adapted with curved boundaries, and if they crossed each other
/// or grew together says what to keep when its input is adapted again: first the facets near the
/// places of that, then all facets, in the end all that is on the boundary.
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

  /// How to adapt.
  const MakeMeshOptions& options() const { return options_; }
  int attempts() const { return attempts_; }

  /// Is what came out right, or will nothing help? Else it is to be adapted again. Two checks of
  /// the mesh, and of its input.
  /// Thread safety: one caller; runs on the executor.
  bool accepts(const AnyMesh& adapted);
  /// Was the last one right?
  bool is_right() const { return is_right_; }
  /// What a user should know.
  void warn(std::vector<std::string>& warnings) const;

 private:
  bool keeps_more(const AdjacentMesh& adapted);

  AdjacentMesh input_;
  MakeMeshOptions options_;
  double tolerance_;  // of the surface, as asked for
  double distance_;   // from places at which facets are kept
  int attempts_ = 0;
  bool is_right_ = false;
  std::string first_fault_;
};

extern template class Rescue<2>;
extern template class Rescue<3>;

}  // namespace ductile::meshadapt
