/// @file
/// What the handle of a cut mesh keeps, and what adaptation and reports take from it.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "handles.hpp"

namespace ductile::c {

/// A cut without its mesh, which is in the handle, and what it was made from.
struct Cut {
  meshadapt::AnyMesh before;
  std::vector<double> values;  // [vertex of `before`]
  std::int32_t interface = 0;
  meshadapt::CutMesh made;
};

/// The sizes of the mesh before, at the vertices of the cut mesh.
meshadapt::AnyField metric_before(const runtime::Executor& executor, const Cut& cut);

/// The options of an adaptation of this mesh: with a Hausdorff tolerance and no geometry, the
/// interface of a cut mesh is put on the surface of its level set.
meshadapt::AdaptOptions on_surface(const ductile_mesh& mesh, const ductile_options& options);

double cut_figure(const meshadapt::CutReport& report, std::string_view name);

}  // namespace ductile::c
