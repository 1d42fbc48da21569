/// @file
/// VtkGrid: an unstructured grid as VTK's files hold it, in XML or not (private to io). Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Values at points or in cells.
struct VtkArray {
  std::string name;
  std::size_t components = 1;
  std::vector<double> values;
  bool whole = false;  ///< the file holds whole numbers
};

struct VtkGrid {
  std::string name;                        ///< of the file
  std::vector<double> points;              ///< [point * 3 + axis]
  std::vector<std::int64_t> connectivity;  ///< the points of all cells
  std::vector<std::int64_t> ends;          ///< [cell] where its points end in connectivity
  std::vector<std::int64_t> types;         ///< [cell]
  std::vector<VtkArray> point_data, cell_data;
  std::vector<double> names;  ///< letters of lines "DIMENSION REFERENCE NAME", of references
};

/// The mesh of a grid. References are in the arrays "region" and "boundary", or in one array with a
/// name that other programs give; all other arrays become fields. Throws InputError for cells that
/// are not simplices, points that do not exist, and arrays whose lengths differ.
SpatialMesh mesh_of(VtkGrid&& grid);

/// One grid of the pieces that parallel programs write. Points of different pieces are one if they
/// have the same number in the array "GlobalPointIds" at points or, where a piece lacks it, exactly
/// the same coordinates; points of one piece are never joined by coordinates. Cells that
/// "vtkGhostType" marks as copies of another piece's are left out. Throws InputError, with the name
/// of the file, for pieces that do not fit together.
VtkGrid joined(const std::string& name, std::vector<VtkGrid>&& pieces);

}  // namespace ductile::meshadapt
