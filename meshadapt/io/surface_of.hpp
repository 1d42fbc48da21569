/// @file
/// surface_of(): what formats of surfaces hold of a mesh of dimension 3.
#pragma once

#include <filesystem>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The triangles of a surface, or those on the boundary of tetrahedra, seen from outside, without
/// references.
struct FileSurface {
  std::vector<double> coordinates;
  Cells<3> triangles;
};

/// Throws InputError for a mesh that is not fit for a file, or of dimension 2.
FileSurface surface_of(const AnyMesh& mesh, const std::filesystem::path& path);

}  // namespace ductile::meshadapt
