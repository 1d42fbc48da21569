/// @file
/// SizesByPlaces: sizes near places, evaluated anew on each adapted mesh, which shows more of them.
#pragma once

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/sizes.hpp"

namespace ductile::meshadapt {

/// Sizes at the vertices of the mesh as it stands, until it was adapted to about these, or finer,
/// everywhere; at most five times.
class SizesByPlaces : public MetricSource {
 public:
  /// Places are those of this mesh and stay there, even if adaptation removes its vertices, or in
  /// 3D edges, that carry a reference. No sizes below the smallest of the bounds are asked for.
  SizesByPlaces(const AnyMesh& input, const Sizes& sizes, const SizeBounds& bounds);

  const AnyField* next(const AdaptState& state) override;

 private:
  Sizes sizes_;  // references of vertices, and in 3D of edges, are places here
  Sizes first_;  // as given, for the input
  SizeBounds bounds_;
  int times_ = 1;  // that a mesh was adapted, the input included
  AnyField metric_;
};

}  // namespace ductile::meshadapt
