/// @file
/// joined: one grid of the pieces that parallel programs write (private to io). Any thread.
#pragma once

#include <string>
#include <vector>

#include "vtk_grid.hpp"

namespace ductile::meshadapt {

/// Points of different pieces are one if they have the same number in the array "GlobalPointIds" at
/// points or, where a piece lacks it, exactly the same coordinates; points of one piece are never
/// joined by coordinates. Cells that "vtkGhostType" marks as copies of another piece's are left
/// out. Throws InputError, with the name of the file, for pieces that do not fit together.
VtkGrid joined(const std::string& name, std::vector<VtkGrid>&& pieces);

}  // namespace ductile::meshadapt
