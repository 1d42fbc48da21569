/// @file
/// Meshes and fields in the Gamma mesh format (GMF) of Medit, Mmg, Gmsh and feflo.a: .mesh and .sol
/// (ASCII), .meshb and .solb (binary), versions 1 to 4, either byte order. Reading goes by content,
/// writing by the name's ending. Reading throws InputError, never crashes, on any sequence of
/// bytes, and takes memory in proportion to the file. All functions: any thread.
#pragma once

#include <bit>
#include <filesystem>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/atomic_file.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// Reads a mesh. Every index in it is in range, every coordinate finite; nothing else is checked.
/// A mesh of dimension 3 that lies in a coordinate plane and has no tetrahedra becomes one of
/// dimension 2, see flatten(). Sections with other data (normals, solutions, what only bamg or
/// ParMmg knows, any other word) are left out, all with one line in `warnings` if that is given.
/// Throws InputError ("FILE:LINE: expected, found; what to do"; in binary files the byte and
/// section) for a file that cannot be read, breaks the format, has cells other than edges,
/// triangles and tetrahedra, or a section whose name is one letter away from theirs.
AnyMesh read_mesh(const std::filesystem::path& path, Warnings* warnings = nullptr);

struct ReadFieldOptions {
  /// Take infinite values, too, as of sizes that metric_of is to bound.
  bool infinite = false;
};

/// Reads the fields at the vertices (section SolAtVertices), all values finite. Otherwise as
/// read_mesh. That it belongs to a mesh is for the caller to check, see metric_of.
AnyField read_field(const std::filesystem::path& path, Warnings* warnings = nullptr,
                    const ReadFieldOptions& options = {});

struct GmfOptions {
  /// 1: floats of 4 bytes in binary; 2: doubles; 3: files past 2 GiB; 4: 64-bit numbers.
  /// 0: the smallest from 2 on that holds the data.
  int version = 0;
  enum class Form { by_name, ascii, binary } form = Form::by_name;
  std::endian byte_order = std::endian::native;  ///< of a binary file
};

/// Writes a mesh; reading it back gives the same numbers bit for bit (version 1: to the precision
/// of float). The file appears whole or not at all. Throws InputError for a place that cannot be
/// written, a name with an unknown ending, or data that is not fit for a file (index out of range,
/// not finite, arrays of lengths that do not belong together); Error if the disk fills up.
void write_mesh(const std::filesystem::path& path, const AnyMesh& mesh, GmfOptions options = {});

/// Writes the fields at the vertices, likewise.
void write_field(const std::filesystem::path& path, const AnyField& field, GmfOptions options = {});

/// The same as one of several outputs that appear together.
void write_mesh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
                GmfOptions options = {});
void write_field(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyField& field,
                 GmfOptions options = {});

}  // namespace ductile::meshadapt
