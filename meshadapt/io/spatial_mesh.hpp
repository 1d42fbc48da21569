/// @file
/// SpatialMesh: a mesh and fields from a format with three coordinates and one list of cells of all
/// shapes. finish() turns it into a mesh for the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Adds a warning, if they are wanted.
inline void warn(Warnings* warnings, const std::string& text) {
  if (warnings != nullptr) warnings->push_back(printable(text));
}

/// A field with the number of components that the file says.
struct SpatialField {
  std::string name;
  NamedField::Place place = NamedField::Place::vertices;
  std::size_t components = 1;
  std::vector<double> values;  ///< [vertex or number of a cell in the file, component]
  bool whole = false;          ///< whole numbers
};

struct SpatialMesh {
  AnyMesh mesh;                                                    ///< of dimension 3
  std::vector<std::size_t> cell_of_triangle, cell_of_tetrahedron;  ///< their numbers in the file
  std::vector<SpatialField> fields;
};

/// Throws InputError for coordinates that are not finite. Becomes a mesh of dimension 2 if it is
/// flat, see flatten(), without a word if it lies in z = 0. Fields that cannot be used are left
/// out, with a warning.
MeshWithFields finish(SpatialMesh&& spatial, Warnings* warnings);

/// Widens a field for a file with three coordinates: scalars stay, vectors get three components,
/// tensors nine, row by row; components that the plane lacks are 0.
SpatialField in_space(const NamedField& field, const AnyMesh& mesh);

/// The values of a field of whole numbers, `count` of them, with 0 for those that it lacks; nothing
/// unless all are whole and a double counts them.
std::optional<std::vector<std::int64_t>> whole_values(const SpatialField& field, std::size_t count);

/// Three coordinates of each vertex.
std::vector<double> points_in_space(const AnyMesh& mesh);

/// Throws InputError unless the mesh and the fields are fit for a file: arrays of lengths that
/// belong together, indices in range, numbers that are finite, fields with names in UTF-8 without
/// control characters.
void expect_fit_for_file(const AnyMesh& mesh, std::span<const NamedField> fields);

/// Lists data of a mesh beside cells and references, for the warning of a format that cannot hold
/// them: "required vertices (3), required edges (2)"; empty if there are none. Corners and ridges
/// are not listed, because they are found again by their angles.
std::string beside_cells(const AnyMesh& mesh);

/// Adds the warning, if there is something to say.
void warn_of_lost(const WriteOptions& options, const std::filesystem::path& path,
                  const std::string& lost);

}  // namespace ductile::meshadapt
