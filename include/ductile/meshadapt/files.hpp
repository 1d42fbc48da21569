/// @file
/// Meshes and fields in files. One table, mesh_formats(), says which formats there are: those of
/// Medit and Mmg (GMF: .mesh, .meshb, .sol, .solb, versions 1 to 4, either byte order), Gmsh, VTK,
/// and others to write. Reading goes by content, writing by the name's ending. Reading throws
/// InputError, never crashes, on any sequence of bytes, and takes memory in proportion to the file.
/// All functions: any thread.
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

// ---- Which formats there are ----

/// A format of files, and what Ductile does with it.
struct MeshFormat {
  std::string_view ending;  ///< ".msh"
  std::string_view what;    ///< "Gmsh, versions 2.2 and 4.1"
  bool is_read = false;
  bool is_written = false;
  bool holds_fields = false;  ///< at vertices and in elements, beside the mesh
};

/// All of them, in the order of help.
std::vector<MeshFormat> mesh_formats();

/// The format that a file of this name is written in, by its ending; nullptr: none.
const MeshFormat* format_of(const std::filesystem::path& path);

/// The endings of those that can be written, ".mesh, .meshb or .vtu", for messages.
std::string written_endings();

// ---- Reading ----

/// What a file holds: a mesh, and fields on it.
struct MeshWithFields {
  AnyMesh mesh;
  std::vector<NamedField> fields;
};

/// Reads a mesh. Every index in it is in range, every coordinate finite; nothing else is checked.
/// A mesh of dimension 3 that lies in a coordinate plane and has no tetrahedra becomes one of
/// dimension 2, see flatten(). What the format has beyond AnyMesh (normals, solutions, what only
/// bamg or ParMmg knows, any other word) is left out, all with one line in `warnings` if that is
/// given. Throws InputError ("FILE:LINE: expected, found; what to do"; in binary files the byte)
/// for a file that cannot be read, breaks the format, has cells other than points, edges, triangles
/// and tetrahedra, or a section whose name is one letter away from one that is read.
AnyMesh read_mesh(const std::filesystem::path& path, Warnings* warnings = nullptr);

/// The same with the fields that the file has beside the mesh, whose values are numbers, which may
/// be infinite. Those that the mesh has no place for (of other numbers of components, on other
/// cells) are left out with a warning.
MeshWithFields read_mesh_with_fields(const std::filesystem::path& path,
                                     Warnings* warnings = nullptr);

/// How fields are read.
struct ReadFieldOptions {
  /// Take infinite values, too, as of sizes that metric_of is to bound.
  bool infinite = false;
};

/// Reads the fields at the vertices (section SolAtVertices) of a .sol or .solb, all values finite.
/// Otherwise as read_mesh. That it belongs to a mesh is for the caller to check, see metric_of.
AnyField read_field(const std::filesystem::path& path, Warnings* warnings = nullptr,
                    const ReadFieldOptions& options = {});

// ---- Writing ----

/// What goes into a file beside the mesh, and how.
struct WriteOptions {
  /// Fields to go into the file, where the format holds some.
  std::span<const NamedField> fields{};
  /// Of a mesh: its format, by the ending; empty: that of the file's name.
  std::string_view format{};
  /// GMF: 1, floats of 4 bytes in binary; 2, doubles; 3, files past 2 GiB; 4, 64-bit numbers.
  /// 0, the smallest from 2 on that holds the data. Gmsh: 2 for 2.2, 4 or 0 for 4.1.
  int version = 0;
  /// By name: binary for .meshb and .solb, text for .mesh, .sol and .msh, and what suits others.
  /// Whoever says which may give a mesh any name: GMF if its ending is that of no format.
  enum class Form { by_name, ascii, binary } form = Form::by_name;
  std::endian byte_order = std::endian::native;  ///< of a binary GMF file
  /// Gets a line about what the mesh has and the format has no place for.
  Warnings* warnings = nullptr;
};

/// Writes a mesh; reading a GMF, Gmsh or VTK file back gives the same numbers bit for bit (GMF
/// version 1: to the precision of float). The file appears whole or not at all. Throws InputError
/// for a place that cannot be written, a name with an unknown ending, fields that the format does
/// not hold, or data that is not fit for a file (index out of range, not finite, arrays of lengths
/// that do not belong together); Error if the disk fills up.
void write_mesh(const std::filesystem::path& path, const AnyMesh& mesh,
                const WriteOptions& options = {});

/// Writes the fields at the vertices as .sol or .solb, likewise.
void write_field(const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options = {});

// ---- Outputs that appear whole, and together ----

class OutputFile;

/// Several output files that belong together and appear whole or not at all. Each one has no name
/// while it is written, or, where the file system has no such files, a temporary one beside its
/// place, `NAME.ductile-tmp-PID-N`; commit() gives all of them their names when every byte of every
/// one is on disk. Until then, and after an error or an interrupt, the files that were there before
/// are untouched. Signals that end the process remove temporary files, and wait while names are
/// given (runtime/process.hpp). What is no regular file (/dev/null, a pipe) is written directly,
/// and so is what a name such as /dev/stdout or /dev/fd/3 stands for. Thread safety: one thread.
class AtomicOutputs {
 public:
  AtomicOutputs();
  /// Removes the temporaries of what was not committed.
  ~AtomicOutputs();
  AtomicOutputs(const AtomicOutputs&) = delete;
  AtomicOutputs& operator=(const AtomicOutputs&) = delete;

  /// Opens an output for `path`, valid until commit(). A symbolic link is followed: the file that
  /// it names is replaced. Throws InputError where check_writable would, or when `path` is staged.
  OutputFile& stage(const std::filesystem::path& path);

  /// Brings every file to disk, then moves each to its place. The old files of all but the first
  /// that was staged are set aside before: a process that is killed meanwhile may leave the first
  /// one, old or new, without the others, but never old ones beside new ones. Throws Error: if a
  /// file could not be written to its end, or a rename fails, the old files are in place, except
  /// where the text names what new ones are.
  void commit();

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

/// The files beside `path` that hold what it held or was to hold, because a process that wrote it
/// was killed.
std::vector<std::filesystem::path> left_of(const std::filesystem::path& path);

/// Whether a file could be written at `path`, to be asked before long work: throws InputError if
/// the path is empty or a folder, or if its folder is missing or refuses a new file.
void check_writable(const std::filesystem::path& path);

/// The same of outputs that belong together, of which no two may be one file.
void check_writable(const std::vector<std::filesystem::path>& paths);

/// Writes a mesh as one of several outputs.
void write_mesh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
                const WriteOptions& options = {});
/// The same for a field: the file appears with the other outputs.
void write_field(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options = {});
/// The same for any bytes.
void write_bytes(AtomicOutputs& outputs, const std::filesystem::path& path, std::string_view bytes);

}  // namespace ductile::meshadapt
