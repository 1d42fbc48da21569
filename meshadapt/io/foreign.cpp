#include "foreign.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

constexpr const char* by_meshio = "; convert it first, as with meshio convert FILE mesh.vtu";
constexpr const char* by_meshio_hdf =
    "; convert it first, as with meshio convert FILE mesh.vtu, which needs Python's h5py";
constexpr const char* by_meshio_netcdf =
    "; convert it first, as with meshio convert FILE mesh.vtu, which needs Python's netCDF4";
constexpr const char* by_gmsh = "; convert it first, as with gmsh FILE -save -o mesh.msh";
constexpr const char* by_filling =
    ", a surface without tetrahedra; fill it first, as with Gmsh or TetGen, and give that mesh";
constexpr const char* by_paraview = "; save it as .vtu first, as in ParaView by Save Data";
constexpr const char* by_foam =
    "; convert it first, as with foamToVTK, and split its cells into tetrahedra";

/// A format by what a file begins with, after white space, in any case of letters.
struct ForeignBeginning {
  std::string_view begin;
  const char* what;
  const char* advice;
};
constexpr std::array beginnings{
    ForeignBeginning{"MFEM mesh", "a mesh of MFEM", "; write it there by Mesh::PrintVTK first"},
    ForeignBeginning{"MFEM NC mesh", "a mesh of MFEM", "; write it there by Mesh::PrintVTK first"},
    ForeignBeginning{"*HEADING", "Abaqus input", by_meshio},
    ForeignBeginning{"*NODE", "Abaqus input", by_meshio},
    ForeignBeginning{"*PART", "Abaqus input", by_meshio},
    ForeignBeginning{"**", "Abaqus input", by_meshio},
    ForeignBeginning{"CDF\x01", "Exodus or netCDF", by_meshio_netcdf},
    ForeignBeginning{"CDF\x02", "Exodus or netCDF", by_meshio_netcdf},
    ForeignBeginning{"CDF\x05", "Exodus or netCDF", by_meshio_netcdf},
    ForeignBeginning{"@(#)ADF Database", "CGNS (ADF)", by_paraview},
    ForeignBeginning{"ply\n", "PLY", by_filling},
    ForeignBeginning{"ply\r", "PLY", by_filling},
    ForeignBeginning{"OFF\n", "OFF", by_filling},
    ForeignBeginning{"solid", "STL", by_filling},
    ForeignBeginning{"mesh3d", "Netgen", by_meshio},
    ForeignBeginning{"BEGIN BULK", "Nastran", by_meshio},
    ForeignBeginning{"CEND", "Nastran", by_meshio},
    ForeignBeginning{"GRID", "Nastran", by_meshio},
    ForeignBeginning{"$ Nastran", "Nastran", by_meshio},
    ForeignBeginning{"(0 ", "Fluent", by_paraview},
    ForeignBeginning{"(2 ", "Fluent", by_paraview},
    ForeignBeginning{"CONTROL INFO", "Gambit", by_gmsh},
    ForeignBeginning{"TITLE", "Tecplot", by_meshio},
    ForeignBeginning{"VARIABLES", "Tecplot", by_meshio},
    ForeignBeginning{"PK\x03\x04", "a zip archive", "; unpack it first"},
    ForeignBeginning{"\x1f\x8b", "compressed by gzip", "; unpack it first, as with gunzip"},
    ForeignBeginning{"version https://git-lfs", "a pointer of Git LFS",
                     "; fetch it by git lfs pull"},
};

/// A format by the ending of a file's name.
struct ForeignEnding {
  std::string_view ending;
  const char* what;
  const char* advice;
};
constexpr std::array endings{
    ForeignEnding{".inp", "Abaqus input or AVS UCD", by_meshio},
    ForeignEnding{".avs", "AVS UCD", by_meshio},
    ForeignEnding{".med", "MED (Salome)", by_meshio_hdf},
    ForeignEnding{".rmed", "MED (Salome)", by_meshio_hdf},
    ForeignEnding{".e", "Exodus", by_meshio_netcdf},
    ForeignEnding{".ex2", "Exodus", by_meshio_netcdf},
    ForeignEnding{".exo", "Exodus", by_meshio_netcdf},
    ForeignEnding{".exii", "Exodus", by_meshio_netcdf},
    ForeignEnding{".cgns", "CGNS", by_paraview},
    ForeignEnding{".xdmf", "XDMF", by_meshio_hdf},
    ForeignEnding{".xmf", "XDMF", by_meshio_hdf},
    ForeignEnding{".h5", "HDF5", by_paraview},
    ForeignEnding{".hdf5", "HDF5", by_paraview},
    ForeignEnding{".h5m", "MOAB", by_meshio_hdf},
    ForeignEnding{".vtkhdf", "VTKHDF", by_paraview},
    ForeignEnding{".foam", "OpenFOAM", by_foam},
    ForeignEnding{".stl", "STL", by_filling},
    ForeignEnding{".obj", "Wavefront OBJ", by_filling},
    ForeignEnding{".ply", "PLY", by_filling},
    ForeignEnding{".off", "OFF", by_filling},
    ForeignEnding{".bdf", "Nastran", by_meshio},
    ForeignEnding{".nas", "Nastran", by_meshio},
    ForeignEnding{".fem", "Nastran", by_meshio},
    ForeignEnding{".unv", "I-deas universal (UNV)", by_gmsh},
    ForeignEnding{".neu", "Gambit", by_gmsh},
    ForeignEnding{".cas", "Fluent", by_paraview},
    ForeignEnding{".cdb", "Ansys", by_gmsh},
    ForeignEnding{".vol", "Netgen", by_meshio},
    ForeignEnding{".node", "TetGen", by_meshio},
    ForeignEnding{".ele", "TetGen", by_meshio},
    ForeignEnding{".ugrid", "UGRID", by_meshio},
    ForeignEnding{".mdpa", "Kratos", by_meshio},
    ForeignEnding{".step", "STEP, a shape without a mesh", "; mesh it first, as with gmsh -3 FILE"},
    ForeignEnding{".stp", "STEP, a shape without a mesh", "; mesh it first, as with gmsh -3 FILE"},
    ForeignEnding{".brep", "a shape without a mesh", "; mesh it first, as with gmsh -3 FILE"},
    ForeignEnding{".geo", "Gmsh's script", "; mesh it first, as with gmsh -3 FILE"},
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return result;
}

[[noreturn]] void refuse(const FileBytes& bytes, std::string_view what, std::string advice) {
  // The name makes a command of it that can be copied.
  if (const std::size_t at = advice.find("FILE"); at != std::string::npos)
    advice.replace(at, 4, bytes.name);
  throw InputError(bytes.name + ": expected a mesh in a format that is read, found " +
                   std::string(what) + advice);
}

/// HDF5 holds MED, Exodus, CGNS and more, which names within tell apart.
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

/// A binary STL has 80 bytes of any kind, a count and 50 bytes for each triangle.
bool is_binary_stl(std::string_view text) {
  if (text.size() < 84) return false;
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[80 + i]));
  };
  return text.size() == 84 + 50 * (byte(0) | byte(1) << 8U | byte(2) << 16U | byte(3) << 24U);
}

bool begins_as_gmf(std::string_view text) {
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (!text.starts_with('#')) break;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  return lower(text.substr(0, 11)) == "meshversion" ||
         text.starts_with(std::string_view("\1\0\0\0", 4)) ||
         text.starts_with(std::string_view("\0\0\0\1", 4));
}

}  // namespace

void refuse_foreign(const FileBytes& bytes) {
  std::string_view text(bytes.begin(), bytes.size);
  if (begins_as_gmf(text)) return;
  if (text.starts_with("\x89HDF\r\n")) refuse_hdf5(bytes, text);
  if (is_binary_stl(text)) refuse(bytes, "STL", by_filling);
  const std::string_view head = text.substr(0, 1024);
  if (head.find("<Xdmf") != std::string_view::npos) refuse(bytes, "XDMF", by_meshio_hdf);
  if (head.find("<dolfin") != std::string_view::npos) refuse(bytes, "a mesh of DOLFIN", by_meshio);
  if (head.find("FoamFile") != std::string_view::npos) refuse(bytes, "OpenFOAM", by_foam);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const ForeignBeginning& one : beginnings)
    if (lower(text.substr(0, one.begin.size())) == lower(one.begin))
      refuse(bytes, one.what, one.advice);
  const std::string ending = lower(std::filesystem::path(bytes.name).extension().string());
  for (const ForeignEnding& one : endings)
    if (ending == one.ending) refuse(bytes, one.what, one.advice);
}

}  // namespace ductile::meshadapt
