/// @file
/// The table of formats, and their readers and writers (private to io): a new format is a row, a
/// line for its reader or writer here, and a file with that. Any thread.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "ductile/meshadapt/files.hpp"
#include "file_bytes.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

using MeshReader = MeshWithFields(const FileBytes& bytes, Warnings* warnings);
using MeshWriter = void(AtomicOutputs& outputs, const std::filesystem::path& path,
                        const AnyMesh& mesh, const WriteOptions& options);

struct FormatRow : MeshFormat {
  bool (*is_it)(std::string_view bytes);  ///< whether a file begins so; null: not by its content
  MeshReader* read;                       ///< null: not read
  MeshWriter* write;                      ///< null: not written
};

std::span<const FormatRow> format_rows();

// ---- Detection: whether bytes begin as a file of the format does ----

bool is_msh(std::string_view bytes);
bool is_obj(std::string_view bytes);
bool is_ply(std::string_view bytes);
bool is_stl(std::string_view bytes);
bool is_su2(std::string_view bytes);
bool is_vtk(std::string_view bytes);
bool is_vtu(std::string_view bytes);

// ---- Readers; they throw InputError ----

MeshReader read_gmf;

/// Gmsh's files, versions 2.0 to 2.2 and 4.1, text and binary in either byte order.
MeshReader read_msh;

/// Surfaces. Faces of more than three corners are cut into triangles, with a warning. Groups, whose
/// names become names of references, are references, numbered unless they are called by a number.
MeshReader read_obj;

/// Surfaces, text and binary in either byte order; faces may have a property `reference`.
MeshReader read_ply;

/// Surfaces, text and binary. Points with the same coordinates become one vertex. Several solids of
/// a text get the references 1, 2 and so on, and their names.
MeshReader read_stl;

/// Facets get the reference of their marker. A marker whose name is a number has that reference.
/// Others get the numbers 1, 2, 3 and so on that are still free, in the order of the file, and
/// their names become names of references. Elements have reference 0.
MeshReader read_su2;

/// VTK's legacy files with an unstructured grid, versions 1 to 5.1, text and binary.
MeshReader read_vtk;

/// VTK's unstructured grids in XML, in all encodings that VTK writes except lz4 and lzma.
MeshReader read_vtu;

// ---- Writers of meshes that are fit for a file; they stage it and throw InputError ----

MeshWriter write_gmf;

/// Versions 2.2 and 4.1, text and binary. References become physical groups and entities of the
/// geometry with that number; vertices with a reference other than 0 become points.
MeshWriter write_msh;

/// The triangles of a surface, or on the boundary of tetrahedra, seen from outside; binary, in
/// single precision, or text. Throws InputError for meshes of dimension 2, too.
MeshWriter write_stl;

/// The same, with references as groups by their names, text.
MeshWriter write_obj;

/// The same, with references as a property of faces; binary, or text.
MeshWriter write_ply;

/// Each reference of facets becomes a marker, called by its names, several joined by '+', or else
/// by its number.
MeshWriter write_su2;

/// Version 4.2, which all readers know, text and binary.
MeshWriter write_vtk;

/// With compressed arrays.
MeshWriter write_vtu;

}  // namespace ductile::meshadapt
