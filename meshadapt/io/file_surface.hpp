/// @file
/// Surfaces in files of formats that hold nothing else: the triangles that are read, and those of a
/// mesh that is written (private to io).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "number_reader.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Collects faces that are read. Those of more than three corners are cut into triangles.
class FaceCollector {
 public:
  explicit FaceCollector(const FileBytes& bytes) {
    mesh.dimension = 3;
    mesh.name = bytes.name;
  }

  /// `in` is behind the face, for messages.
  void add(const NumberReader& in, std::span<const std::uint32_t> corners, std::int32_t reference);
  /// The mesh; throws InputError if it has no faces. Warns if some were cut.
  MeshWithFields finish(const NumberReader& in, Warnings* warnings);

  AnyMesh mesh;  ///< to which the caller adds coordinates and names

 private:
  std::size_t cut_ = 0;
};

/// The triangles of a surface, or those on the boundary of tetrahedra, seen from outside, without
/// references.
struct FileSurface {
  std::vector<double> coordinates;
  Cells<3> triangles;

  std::span<const double> point(std::size_t vertex) const { return {&coordinates[3 * vertex], 3}; }
};

/// Throws InputError for a mesh of dimension 2. Warns of what tetrahedra lose.
FileSurface surface_of(const AnyMesh& mesh, const std::filesystem::path& path,
                       const WriteOptions& options);

}  // namespace ductile::meshadapt
