#include "formats.hpp"

#include <algorithm>
#include <new>
#include <string>

namespace ductile::meshadapt {
namespace {

namespace fs = std::filesystem;

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
