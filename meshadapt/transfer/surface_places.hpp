/// @file
/// SurfacePlaces: the closest points of a surface alone, by which fields on it are transferred.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/indices.hpp"
#include "transfer/evaluate.hpp"

namespace ductile::meshadapt {

class SurfacePlaces {
 public:
  /// Refers to the mesh. Throws InputError unless all corners of its triangles exist.
  SurfacePlaces(const runtime::Executor& executor, const AnyMesh& surface)
      : executor_(executor), triangles_(surface.triangles.vertices) {
    expect_corners<2>(executor, surface);
    position_of_.resize(surface.vertex_count());
    runtime::parallel_for(executor, position_of_.size(),
                          [&](std::size_t v) { position_of_[v] = position_in<3>(surface, v); });
    tree_.emplace(executor, Simplices<2, 3>{triangles_, position_of_});
  }

  /// Values of a field at vertices, at so many points: at(i) is the i-th. Thread safety: one
  /// caller; runs on the executor.
  std::vector<double> interpolated(const Components& field, std::size_t count, auto&& at) const {
    std::vector<double> values(count * field.stride);
    runtime::parallel_for(executor_, count, [&](std::size_t i) {
      const ClosestPoint<2> place = tree_->closest(at(i));
      for (std::size_t k = 0; k < field.stride; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          values[i * field.stride + k] +=
              place.weight[c] * field.values[triangles_[place.element][c] * field.stride + k];
    });
    return values;
  }

  /// Values of a field of the triangles, in the same way.
  std::vector<double> of_elements(const Components& field, std::size_t count, auto&& at) const {
    std::vector<double> values(count * field.stride);
    runtime::parallel_for(executor_, count, [&](std::size_t i) {
      std::copy_n(&field.values[tree_->closest(at(i)).element * field.stride], field.stride,
                  &values[i * field.stride]);
    });
    return values;
  }

 private:
  const runtime::Executor& executor_;
  const std::vector<Corners<2>>& triangles_;
  std::vector<Vector<3>> position_of_;
  std::optional<BoxTree<2, 3>> tree_;
};

[[noreturn]] inline void refuse_projection() {
  throw InputError(
      "expected fields on a surface to be carried by their values (--interpolate, "
      "Carrying::by_value), found another way");
}

/// The centre of a triangle in space.
inline Vector<3> centre_of(const AnyMesh& surface, std::size_t triangle) {
  Vector<3> centre;
  for (const VertexId v : surface.triangles.vertices[triangle])
    centre += (1.0 / 3) * position_in<3>(surface, v);
  return centre;
}

}  // namespace ductile::meshadapt
