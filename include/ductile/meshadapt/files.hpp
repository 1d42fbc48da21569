/// @file
/// Meshes and fields in files. One table, mesh_formats(), lists the formats: those of Medit and Mmg
/// (GMF: .mesh, .meshb, .sol, .solb, versions 1 to 4, either byte order), Gmsh, VTK, and others for
/// writing only. Reading goes by content, writing by the ending of the name. Reading throws
/// InputError, never crashes, on any sequence of bytes, and takes memory in proportion to the file.
/// Thread safety of all functions: any thread.
#pragma once

#include <bit>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

// ---- Formats ----

/// A file format and its support.
struct MeshFormat {
  std::string_view ending;  ///< ".msh"
  std::string_view what;    ///< "Gmsh, versions 2.2 and 4.1"
  bool is_read = false;
  bool is_written = false;
  bool holds_fields = false;  ///< at vertices and in elements, beside the mesh
};

/// All formats, in the order of the help text.
std::vector<MeshFormat> mesh_formats();

/// The format for a file of this name, by its ending; nullptr: none.
const MeshFormat* format_of(const std::filesystem::path& path);

/// The endings that can be written, ".mesh, .meshb or .vtu", for messages.
std::string written_endings();

// ---- Reading ----

/// Contents of a file: a mesh, and fields on it.
struct MeshWithFields {
  AnyMesh mesh;
  std::vector<NamedField> fields;
};

/// Reads a mesh. Indices are checked to be in range and coordinates to be finite, nothing else. A
/// mesh of dimension 3 that lies in a coordinate plane and has no tetrahedra becomes one of
/// dimension 2, see flatten(). Data that AnyMesh cannot hold (normals, solutions, keywords of bamg
/// or ParMmg, unknown keywords) are ignored, with one line in `warnings` if given. Throws
/// InputError ("FILE:LINE: expected, found; what to do"; in binary files the byte) for a file that
/// cannot be read, breaks the format, has cells other than points, edges, triangles and tetrahedra,
/// or a section whose name is one letter away from a known one.
AnyMesh read_mesh(const std::filesystem::path& path, Warnings* warnings = nullptr);

/// Reads a mesh with the fields in its file, whose values are numbers and may be infinite. Fields
/// with unsupported numbers of components, or on other cells, are left out with a warning.
MeshWithFields read_mesh_with_fields(const std::filesystem::path& path,
                                     Warnings* warnings = nullptr);

/// Options of read_field().
struct ReadFieldOptions {
  /// Accept infinite values, for example sizes that metric_of is to bound.
  bool infinite = false;
};

/// Reads the fields at the vertices (section SolAtVertices) of a .sol or .solb, all values finite.
/// Otherwise as read_mesh. Whether it fits a mesh is for the caller to check, see metric_of.
AnyField read_field(const std::filesystem::path& path, Warnings* warnings = nullptr,
                    const ReadFieldOptions& options = {});

// ---- Writing ----

/// Options of write_mesh() and write_field().
struct WriteOptions {
  /// Fields to write, if the format can hold some.
  std::span<const NamedField> fields{};
  /// Format of a mesh, by its ending; empty: that of the file's name.
  std::string_view format{};
  /// GMF: 1, floats of 4 bytes in binary; 2, doubles; 3, files beyond 2 GiB; 4, 64-bit numbers; 0,
  /// the smallest from 2 on that holds the data. Gmsh: 2 for 2.2, 4 or 0 for 4.1.
  int version = 0;
  /// By name: binary for .meshb and .solb, text for .mesh, .sol and .msh, each other format's
  /// default. With ascii or binary a mesh may have any name: GMF if the ending is unknown.
  enum class Form { by_name, ascii, binary } form = Form::by_name;
  std::endian byte_order = std::endian::native;  ///< of a binary GMF file
  /// Receives a line about data of the mesh that the format cannot hold.
  Warnings* warnings = nullptr;
};

/// Writes a mesh; reading a GMF, Gmsh or VTK file back gives the same numbers bit for bit (GMF
/// version 1: to the precision of float). The file appears whole or not at all. Throws InputError
/// for a place that cannot be written, a name with an unknown ending, fields that the format does
/// not hold, or invalid data (index out of range, not finite, inconsistent array lengths); Error if
/// the disk is full.
void write_mesh(const std::filesystem::path& path, const AnyMesh& mesh,
                const WriteOptions& options = {});

/// Writes the fields at the vertices as .sol or .solb, in the same way.
void write_field(const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options = {});

// ---- Outputs that appear whole, and together ----

class OutputFile;
class Sink;

/// Several output files that belong together and appear whole or not at all. While written, each
/// has a temporary name beside its place, `NAME.ductile-tmp-PID-N`; commit() renames all of them
/// once every byte is on disk. Until then, and after an error or an interrupt, the previous files
/// are untouched. Signals that end the process remove temporary files (except SIGKILL), and are
/// delayed during renaming (runtime/process.hpp). Files that are not regular (/dev/null, a pipe),
/// and those behind names such as /dev/stdout or /dev/fd/3, are written directly. Thread safety:
/// one thread.
class AtomicOutputs {
 public:
  AtomicOutputs();
  /// Removes the temporary files of outputs that were not committed.
  ~AtomicOutputs();
  AtomicOutputs(const AtomicOutputs&) = delete;
  AtomicOutputs& operator=(const AtomicOutputs&) = delete;

  /// Opens an output for `path`, valid until commit(). Follows symbolic links and replaces their
  /// target. Throws InputError if check_writable would, or if `path` is already staged.
  Sink& stage(const std::filesystem::path& path);

  /// Brings every file to disk, then moves each to its place. The old files of all outputs except
  /// the first are set aside before: a process killed meanwhile may leave the first one, old or
  /// new, without the others, but never old ones beside new ones. Throws Error: if a file could not
  /// be written completely or renamed, the old files are in place, except for new ones that the
  /// text names.
  void commit();

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

/// The files beside `path` with its old or intended content that a killed process left.
std::vector<std::filesystem::path> left_of(const std::filesystem::path& path);

/// Checks before long work that a file could be written at `path`: throws InputError if the path is
/// empty or a folder, or if its folder is missing or refuses a new file.
void check_writable(const std::filesystem::path& path);

/// Checks outputs that belong together; no two of them may be the same file.
void check_writable(const std::vector<std::filesystem::path>& paths);

/// Writes a mesh as one of several outputs.
void write_mesh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
                const WriteOptions& options = {});
/// Writes a field as one of several outputs.
void write_field(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options = {});
/// Writes bytes as one of several outputs.
void write_bytes(AtomicOutputs& outputs, const std::filesystem::path& path, std::string_view bytes);

}  // namespace ductile::meshadapt
