#include "formats.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <string>

#include "number_reader.hpp"

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

// ---- Formats that are known but not read ----

constexpr const char* by_meshio = "; convert it first, as with meshio convert FILE mesh.vtu";
constexpr const char* by_meshio_hdf =
    "; convert it first, as with meshio convert FILE mesh.vtu, which needs Python's h5py";
constexpr const char* by_meshio_netcdf =
    "; convert it first, as with meshio convert FILE mesh.vtu, which needs Python's netCDF4";
constexpr const char* by_meshio_avs =
    "; convert it first, as with meshio convert --input-format avsucd FILE mesh.vtu";
constexpr const char* by_gmsh = "; convert it first, as with gmsh FILE -save -o mesh.msh";
constexpr const char* by_paraview = "; save it as .vtu first, as in ParaView by Save Data";
constexpr const char* by_meshing = "; mesh it first, as with gmsh -3 FILE";
constexpr const char* by_foam =
    "; convert it first, as with foamToVTK, and split its cells into tetrahedra";

/// A format by how its files begin, after white space, or by the endings of their names; in any
/// case of letters, several with '|' between them.
struct Foreign {
  std::string_view signs;
  const char* what;
  const char* advice;
};
constexpr std::array beginnings{
    Foreign{"MFEM mesh|MFEM NC mesh", "a mesh of MFEM", "; write it there by Mesh::PrintVTK first"},
    Foreign{"*HEADING|*NODE|*PART|**", "Abaqus input", by_meshio},
    Foreign{"CDF\x01|CDF\x02|CDF\x05", "Exodus or netCDF", by_meshio_netcdf},
    Foreign{"@(#)ADF Database", "CGNS (ADF)", by_paraview},
    Foreign{"OFF\n", "OFF", by_meshio},
    Foreign{"mesh3d", "Netgen", by_meshio},
    Foreign{"BEGIN BULK|CEND|GRID|$ Nastran", "Nastran", by_meshio},
    Foreign{"(0 |(2 ", "Fluent", by_paraview},
    Foreign{"CONTROL INFO", "Gambit", by_gmsh},
    Foreign{"TITLE|VARIABLES", "Tecplot", by_meshio},
    Foreign{"PK\x03\x04", "a zip archive", "; unpack it first"},
    Foreign{"\x1f\x8b", "compressed by gzip", "; unpack it first, as with gunzip"},
    Foreign{"version https://git-lfs", "a pointer of Git LFS", "; fetch it by git lfs pull"},
};

constexpr const char* free_fem =
    "; FreeFEM's own are those of 2D: save it as .mesh first, by savemesh(Th, \"th.mesh\")";
constexpr std::array endings{
    Foreign{".inp", "AVS UCD", by_meshio_avs},
    Foreign{".avs", "AVS UCD", by_meshio},
    Foreign{".med|.rmed", "MED (Salome)", by_meshio_hdf},
    Foreign{".e|.ex2|.exo|.exii", "Exodus", by_meshio_netcdf},
    Foreign{".cgns", "CGNS", by_paraview},
    Foreign{".xdmf|.xmf", "XDMF", by_meshio_hdf},
    Foreign{".h5|.hdf5", "HDF5", by_paraview},
    Foreign{".h5m", "MOAB", by_meshio_hdf},
    Foreign{".vtkhdf", "VTKHDF", by_paraview},
    Foreign{".foam", "OpenFOAM", by_foam},
    Foreign{".off", "OFF", by_meshio},
    Foreign{".bdf|.nas|.fem", "Nastran", by_meshio},
    Foreign{".unv", "I-deas universal (UNV)", by_gmsh},
    Foreign{".neu", "Gambit", by_gmsh},
    Foreign{".cas", "Fluent", by_paraview},
    Foreign{".cdb", "Ansys", by_gmsh},
    Foreign{".vol", "Netgen", by_meshio},
    Foreign{".node|.ele", "TetGen", by_meshio},
    Foreign{".ugrid", "UGRID", by_meshio},
    Foreign{".mdpa", "Kratos", by_meshio},
    Foreign{".msh", "a .msh that is not Gmsh's", free_fem},
    Foreign{".step|.stp", "STEP, a shape without a mesh", by_meshing},
    Foreign{".brep", "a shape without a mesh", by_meshing},
    Foreign{".geo", "Gmsh's script", by_meshing},
};

/// Calls visit(sign) for each sign of a format.
void each_sign(const Foreign& one, auto&& visit) {
  for (std::string_view rest = one.signs; !rest.empty();) {
    const std::size_t end = std::min(rest.find('|'), rest.size());
    visit(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

[[noreturn]] void refuse(const FileBytes& bytes, std::string_view what, std::string advice) {
  // With the name, the advice is a command that can be copied.
  if (const std::size_t at = advice.find("FILE"); at != std::string::npos)
    advice.replace(at, 4, bytes.name);
  throw InputError(bytes.name + ": expected a mesh in a format that is read, found " +
                   std::string(what) + advice);
}

/// Names within an HDF5 file tell MED, Exodus, CGNS and others apart.
void refuse_hdf5(const FileBytes& bytes, std::string_view text) {
  const auto holds = [&](std::string_view name) {
    return text.find(name) != std::string_view::npos;
  };
  if (holds("INFOS_GENERALES") || holds("ENS_MAA")) refuse(bytes, "MED (Salome)", by_meshio_hdf);
  if (holds("CGNSLibraryVersion")) refuse(bytes, "CGNS", by_paraview);
  if (holds("num_nod_per_el") || holds("eb_prop1") || holds("coor_names"))
    refuse(bytes, "Exodus", by_meshio_netcdf);
  if (holds("tstt")) refuse(bytes, "MOAB", by_meshio_hdf);
  refuse(bytes, "HDF5", by_paraview);
}

bool begins_as_gmf(std::string_view text) {
  text = from_first_word(text, '#');
  return lower(text.substr(0, 11)) == "meshversion" ||
         text.starts_with(std::string_view("\1\0\0\0", 4)) ||
         text.starts_with(std::string_view("\0\0\0\1", 4));
}

/// Throws InputError, naming the format and a conversion that works, if the file begins as one of a
/// format that is known but not read, or its name ends so.
void refuse_foreign(const FileBytes& bytes) {
  std::string_view text(bytes.begin(), bytes.size);
  if (begins_as_gmf(text)) return;
  if (text.starts_with("\x89HDF\r\n")) refuse_hdf5(bytes, text);
  const std::string_view head = text.substr(0, 1024);
  if (head.find("<Xdmf") != std::string_view::npos) refuse(bytes, "XDMF", by_meshio_hdf);
  if (head.find("<dolfin") != std::string_view::npos) refuse(bytes, "a mesh of DOLFIN", by_meshio);
  if (head.find("FoamFile") != std::string_view::npos) refuse(bytes, "OpenFOAM", by_foam);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const Foreign& one : beginnings)
    each_sign(one, [&](std::string_view sign) {
      if (lower(text.substr(0, sign.size())) == lower(sign)) refuse(bytes, one.what, one.advice);
    });
  const std::string ending = lower(std::filesystem::path(bytes.name).extension().string());
  if (ending == ".inp" && text.starts_with('*')) refuse(bytes, "Abaqus input", by_meshio);
  for (const Foreign& one : endings)
    each_sign(one, [&](std::string_view sign) {
      if (ending == sign) refuse(bytes, one.what, one.advice);
    });
}

// ---- The table ----

// Ending, description, is read, is written, holds fields; detection, reader, writer. A file that no
// format recognises is read by the first.
constexpr std::array<FormatRow, 10> rows{
    {{{".mesh", "Medit and Mmg (GMF), text", true, true}, nullptr, read_gmf, write_gmf},
     {{".meshb", "Medit and Mmg (GMF), binary", true, true}, nullptr, read_gmf, write_gmf},
     {{".msh", "Gmsh, versions 2.2 and 4.1", true, true, true}, is_msh, read_msh, write_msh},
     {{".vtu", "VTK and ParaView, XML", true, true, true}, is_vtu, read_vtu, write_vtu},
     {{".pvtu", "VTK and ParaView, pieces in files", true, false, true},
      nullptr,
      read_vtu,
      nullptr},
     {{".vtk", "VTK and ParaView, legacy", true, true, true}, is_vtk, read_vtk, write_vtk},
     {{".su2", "SU2, with markers by name", true, true}, is_su2, read_su2, write_su2},
     {{".stl", "STL, surfaces in 3D", true, true}, is_stl, read_stl, write_stl},
     {{".ply", "PLY, surfaces in 3D", true, true}, is_ply, read_ply, write_ply},
     {{".obj", "Wavefront OBJ, surfaces in 3D", true, true}, is_obj, read_obj, write_obj}}};

const FormatRow* row_with(std::string_view ending) {
  const auto* const found = std::find_if(
      rows.begin(), rows.end(), [&](const FormatRow& row) { return row.ending == ending; });
  return found == rows.end() ? nullptr : found;
}

const FormatRow& format_row(const FileBytes& bytes) {
  const std::string_view text(bytes.begin(), bytes.size);
  for (const FormatRow& row : rows)
    if (row.is_it != nullptr && row.is_it(text)) return row;
  refuse_foreign(bytes);
  return rows[0];
}

void expect_fields_held(const FormatRow& row, const fs::path& path, const WriteOptions& options) {
  if (!options.fields.empty() && !row.holds_fields)
    throw InputError(path.string() + ": files of this format hold no fields; write them by " +
                     "themselves, to a .sol, or all to a .vtu");
}

}  // namespace

std::span<const FormatRow> format_rows() { return rows; }

std::vector<MeshFormat> mesh_formats() { return {rows.begin(), rows.end()}; }

const MeshFormat* format_of(const fs::path& path) { return row_with(path.extension().string()); }

std::string written_endings() {
  std::vector<std::string> endings;
  for (const FormatRow& row : rows)
    if (row.is_written) endings.emplace_back(row.ending);
  std::string list = endings[0];
  for (std::size_t i = 1; i < endings.size(); ++i)
    list += (i + 1 == endings.size() ? " or " : ", ") + endings[i];
  return list;
}

MeshWithFields read_mesh_with_fields(const fs::path& path, Warnings* warnings) {
  try {
    const FileBytes bytes = read_bytes(path);
    return format_row(bytes).read(bytes, warnings);
  } catch (const std::bad_alloc&) {
    throw Error(path.string() +
                ": not enough memory to read the file; allow more or use a larger machine");
  }
}

AnyMesh read_mesh(const fs::path& path, Warnings* warnings) {
  return read_mesh_with_fields(path, warnings).mesh;
}

void write_mesh(AtomicOutputs& outputs, const fs::path& path, const AnyMesh& mesh,
                const WriteOptions& options) {
  const std::string ending(options.format.empty() ? path.extension().string()
                                                  : std::string(options.format));
  const FormatRow* row = row_with(ending);
  // With an unknown ending, text or binary means the first format.
  if (row == nullptr && options.form != WriteOptions::Form::by_name) row = rows.data();
  if (row == nullptr || row->write == nullptr)
    throw InputError(path.string() + ": expected a name that ends in " + written_endings() +
                     ", found '" + ending + "'; choose another name");
  expect_fields_held(*row, path, options);
  expect_fit_for_file(mesh, options.fields);
  WriteOptions in_format = options;
  in_format.format = row->ending;
  row->write(outputs, path, mesh, in_format);
}

void write_mesh(const fs::path& path, const AnyMesh& mesh, const WriteOptions& options) {
  AtomicOutputs outputs;
  write_mesh(outputs, path, mesh, options);
  outputs.commit();
}

}  // namespace ductile::meshadapt
