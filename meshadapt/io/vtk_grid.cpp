#include "vtk_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "cell_shapes.hpp"
#include "ductile/meshadapt/error.hpp"
#include "number_reader.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

template <class... Parts>
[[noreturn, gnu::noinline]] void fail(const VtkGrid& grid, const Parts&... parts) {
  throw InputError(text_of(grid.name, ": ", parts...));
}

std::size_t vtk_corners(const VtkGrid& grid, std::size_t cell) {
  const CellShape shape = shape_of(&CellShape::vtk, grid.types[cell]);
  if (shape.corners > 0) return static_cast<std::size_t>(shape.corners);
  fail(grid, "expected vertices, lines, triangles and tetrahedra, found ", shape.name, " (type ",
       grid.types[cell], ") in cell ", cell + 1,
       "; split such cells into linear simplices first, as ParaView's Tetrahedralize "
       "does");
}

// ---- References ----

/// Names that programs give to the array of references.
constexpr std::array<std::string_view, 10> reference_names{
    "reference", "medit:ref",   "gmsh:physical", "CellEntityIds", "CellEntityId",
    "cell_tags", "MaterialIDs", "MaterialIds",   "material",      "Label"};

bool are_references(const VtkArray& array) {
  constexpr double least = std::numeric_limits<std::int32_t>::min(),
                   most = std::numeric_limits<std::int32_t>::max();
  return array.components == 1 &&
         std::all_of(array.values.begin(), array.values.end(),
                     [=](double x) { return x == std::floor(x) && x >= least && x <= most; });
}

/// Moves the array of that name out, if its values are references.
bool take_references(std::vector<VtkArray>& arrays, std::string_view name,
                     std::vector<std::int32_t>& references) {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& array) {
    return array.name == name && are_references(array);
  });
  if (found == arrays.end()) return false;
  references.resize(found->values.size());
  std::transform(found->values.begin(), found->values.end(), references.begin(),
                 [](double x) { return static_cast<std::int32_t>(x); });
  arrays.erase(found);
  return true;
}

std::vector<std::int32_t> first_references(std::vector<VtkArray>& arrays, std::size_t count) {
  std::vector<std::int32_t> references;
  for (const std::string_view name : reference_names)
    if (take_references(arrays, name, references)) return references;
  return std::vector<std::int32_t>(count, 0);
}

/// [cell] the references of elements and of all others.
CellReferences take_cell_references(std::vector<VtkArray>& arrays, std::size_t count) {
  CellReferences of;
  const bool apart = take_references(arrays, "region", of.region);
  if (take_references(arrays, "boundary", of.boundary)) {
    if (!apart) of.region.assign(count, 0);
    return of;
  }
  if (!apart) of.region = first_references(arrays, count);
  of.boundary = of.region;
  return of;
}

// ---- Cells ----

template <std::size_t Corners>
std::array<std::uint32_t, Corners> corners_at(const std::int64_t* points) {
  std::array<std::uint32_t, Corners> corners;
  std::transform(points, points + Corners, corners.begin(),
                 [](std::int64_t point) { return static_cast<std::uint32_t>(point); });
  return corners;
}

void expect_cell(const VtkGrid& grid, std::size_t cell, std::size_t begin, std::size_t corners) {
  const std::int64_t end = grid.ends[cell];
  const std::string which = "cell " + std::to_string(cell + 1);
  if (end < 0 || static_cast<std::uint64_t>(end) > grid.connectivity.size() ||
      static_cast<std::uint64_t>(end) != begin + corners)
    fail(grid, "expected ", corners, " points in ", which,
         ", found an end of its list that does not fit; the file is damaged, write it "
         "again");
  const std::size_t points = grid.points.size() / 3;
  for (std::size_t i = begin; i < begin + corners; ++i)
    if (grid.connectivity[i] < 0 || static_cast<std::uint64_t>(grid.connectivity[i]) >= points)
      fail(grid, "expected points from 0 to ", points - 1, " in ", which, ", found ",
           grid.connectivity[i], "; correct it");
}

void take_cells(SpatialMesh& to, const VtkGrid& grid, const CellReferences& of) {
  const bool in_space =
      std::find(grid.types.begin(), grid.types.end(), vtk_tetrahedron) != grid.types.end();
  std::size_t begin = 0;
  for (std::size_t cell = 0; cell < grid.types.size(); ++cell) {
    if (grid.types[cell] == 0 && static_cast<std::size_t>(grid.ends[cell]) == begin) continue;
    const std::size_t corners = vtk_corners(grid, cell);
    expect_cell(grid, cell, begin, corners);
    const std::int64_t* const points = &grid.connectivity[begin];
    begin += corners;
    if (corners == 1) {
      if (of.boundary[cell] != 0)
        to.mesh.vertex_reference[static_cast<std::size_t>(points[0])] = of.boundary[cell];
    } else if (corners == 2) {
      to.mesh.edges.add(corners_at<2>(points), of.boundary[cell]);
    } else if (corners == 3) {
      to.mesh.triangles.add(corners_at<3>(points), in_space ? of.boundary[cell] : of.region[cell]);
      to.cell_of_triangle.push_back(cell);
    } else {
      to.mesh.tetrahedra.add(corners_at<4>(points), of.region[cell]);
      to.cell_of_tetrahedron.push_back(cell);
    }
  }
}

void take_fields(SpatialMesh& to, std::vector<VtkArray>&& arrays, NamedField::Place place) {
  for (VtkArray& array : arrays)
    to.fields.push_back(
        {std::move(array.name), place, array.components, std::move(array.values), array.whole});
}

void expect_lengths(const VtkGrid& grid) {
  const std::size_t points = grid.points.size() / 3;
  if (points == 0) fail(grid, "expected points, found none; give a mesh file");
  if (points >= std::numeric_limits<std::uint32_t>::max())
    fail(grid, "expected fewer than 4294967295 points, found more; take a smaller mesh");
  if (grid.ends.size() != grid.types.size())
    fail(grid, "expected as many ends of cells as types, found ", grid.ends.size(), " and ",
         grid.types.size(), "; the file is damaged, write it again");
}

/// Takes "2 10 steel" as a name; other lines are no names of references.
void take_name(AnyMesh& mesh, std::string_view line) {
  ReferenceName name;
  NumberReader in(line, "");
  if (!in.take(name.dimension) || name.dimension < 0 || name.dimension > 3 ||
      !in.take(name.reference) || in.left() == 0)
    return;
  name.name.assign(in.at() + 1, in.left() - 1);
  mesh.names.push_back(std::move(name));
}

void take_names(AnyMesh& mesh, const std::vector<double>& letters) {
  std::string line;
  for (const double letter : letters) {
    if (letter == '\n') {
      take_name(mesh, line);
      line.clear();
    } else if (letter > 0 && letter < 256) {
      line.push_back(static_cast<char>(static_cast<unsigned char>(letter)));
    }
  }
}

}  // namespace

SpatialMesh mesh_of(VtkGrid&& grid) {
  expect_lengths(grid);
  SpatialMesh to;
  to.mesh.name = grid.name;
  to.mesh.dimension = 3;
  to.mesh.vertex_reference = first_references(grid.point_data, grid.points.size() / 3);
  take_cells(to, grid, take_cell_references(grid.cell_data, grid.types.size()));
  take_names(to.mesh, grid.names);
  take_fields(to, std::move(grid.point_data), NamedField::Place::vertices);
  take_fields(to, std::move(grid.cell_data), NamedField::Place::elements);
  to.mesh.coordinates = std::move(grid.points);
  return to;
}

}  // namespace ductile::meshadapt
