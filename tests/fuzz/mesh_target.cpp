// Any bytes as a mesh file for one reader of the table of formats: the file is read, or refused by
// a message. A mesh that is read must survive writing and reading in each of the formats, is
// checked, and becomes a Mesh if it can be adapted.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/surface_mesh.hpp"
#include "io/formats.hpp"
#include "oracle.hpp"
#include "targets.hpp"

namespace ductile::fuzz {
namespace {

using meshadapt::AnyMesh;
using meshadapt::WriteOptions;

template <int Corners>
void expect_cells(const meshadapt::Cells<Corners>& cells, std::size_t vertices) {
  expect(cells.vertices.size() == cells.reference.size(), "a cell without a reference");
  for (const auto& cell : cells.vertices)
    for (const auto vertex : cell) expect(vertex < vertices, "a corner out of range");
}

void expect_list(const std::vector<std::uint32_t>& list, std::size_t limit) {
  for (const auto index : list) expect(index < limit, "an index out of range");
}

void expect_whole(const AnyMesh& mesh, std::size_t bytes, bool compressed) {
  const std::size_t vertices = mesh.vertex_count();
  expect(mesh.dimension == 2 || mesh.dimension == 3, "the dimension is neither 2 nor 3");
  expect(vertices > 0, "no vertices");
  expect(mesh.coordinates.size() == vertices * static_cast<std::size_t>(mesh.dimension),
         "the number of coordinates");
  for (const double x : mesh.coordinates) expect(std::isfinite(x), "a coordinate is not finite");
  expect_cells(mesh.edges, vertices);
  expect_cells(mesh.triangles, vertices);
  expect_cells(mesh.tetrahedra, vertices);
  expect_list(mesh.corners, vertices);
  expect_list(mesh.required_vertices, vertices);
  expect_list(mesh.ridges, mesh.edges.size());
  expect_list(mesh.required_edges, mesh.edges.size());
  expect_list(mesh.required_triangles, mesh.triangles.size());
  expect_list(mesh.required_tetrahedra, mesh.tetrahedra.size());
  const std::size_t held = 8 * mesh.coordinates.capacity() + 12 * mesh.edges.vertices.capacity() +
                           16 * mesh.triangles.vertices.capacity() +
                           20 * mesh.tetrahedra.vertices.capacity();
  // Data compressed by zlib may be a thousand times as large.
  expect(held < 4096 + (compressed ? 16000 : 16) * bytes, "memory out of proportion to the file");
}

void expect_same(const AnyMesh& mesh, const MemoryFile& file) {
  AnyMesh again = meshadapt::read_mesh(file.path());
  expect(again.coordinates.size() == mesh.coordinates.size() &&
             std::memcmp(again.coordinates.data(), mesh.coordinates.data(),
                         8 * mesh.coordinates.size()) == 0,
         "coordinates differ after writing and reading");
  again.name = mesh.name;
  again.coordinates = mesh.coordinates;  // compared bit by bit above; -0 == 0 here
  expect(again == mesh, "the mesh differs after writing and reading");
}

/// Writes and reads in a form that the input chooses.
void expect_round_trip(AnyMesh mesh, std::size_t choice) {
  static MemoryFile file;
  file.set(nullptr, 0);
  mesh.names.clear();  // not every file can hold all names
  WriteOptions options;
  options.format = ".mesh";
  options.form = choice % 2 == 0 ? WriteOptions::Form::ascii : WriteOptions::Form::binary;
  options.version = static_cast<int>(2 + choice / 2 % 3);
  options.byte_order = choice / 6 % 2 == 0 ? std::endian::little : std::endian::big;
  mesh.dropped_axis = 2;
  write_mesh(file.path(), mesh, options);
  expect_same(mesh, file);
}

/// The same in a format that holds only cells and references, and three coordinates.
void expect_round_trip_in_space(AnyMesh mesh, std::size_t choice) {
  if (mesh.dimension == 2 && mesh.triangles.size() == 0) return;  // it would lie in no plane
  static MemoryFile file;
  file.set(nullptr, 0);
  for (auto* list : {&mesh.corners, &mesh.ridges, &mesh.required_vertices, &mesh.required_edges,
                     &mesh.required_triangles, &mesh.required_tetrahedra})
    list->clear();
  mesh.names.clear();
  mesh.dropped_axis = 2;
  WriteOptions options;
  constexpr std::array formats = {".msh", ".msh", ".vtk", ".vtu"};
  options.format = formats[choice % 4];
  if (choice % 4 < 2) options.version = choice % 4 == 0 ? 2 : 4;
  options.form = choice / 4 % 2 == 0 ? WriteOptions::Form::ascii : WriteOptions::Form::binary;
  write_mesh(file.path(), mesh, options);
  expect_same(mesh, file);
}

void make(auto&& maker) {
  for (const double tolerance : {0.0, 0.01}) {
    meshadapt::MakeMeshOptions options;
    options.complete_boundary = true;
    options.hausdorff_tolerance = tolerance;
    meshadapt::Warnings warnings;
    try {
      const auto back = meshadapt::take_apart(executor(), maker(options, warnings));
      expect(meshadapt::check_mesh(executor(), back.mesh).empty(),
             "a mesh that was made is no mesh");
    } catch (const meshadapt::InputError& error) {
      expect_message(error.what());
    }
    expect_messages(warnings);
  }
}

template <int Dim>
void make(const AnyMesh& mesh) {
  make([&](const meshadapt::MakeMeshOptions& options, meshadapt::Warnings& warnings) {
    meshadapt::Neighbours<Dim> neighbours;
    return meshadapt::make_mesh<Dim>(executor(), mesh, options, neighbours, warnings);
  });
}

void make_surface(const AnyMesh& mesh) {
  make([&](const meshadapt::MakeMeshOptions& options, meshadapt::Warnings& warnings) {
    meshadapt::Neighbours<2> neighbours;
    return meshadapt::make_surface_mesh(executor(), mesh, options, neighbours, warnings);
  });
}

/// False if areas and volumes would overflow; such meshes are not adapted.
bool is_in_scale(const AnyMesh& mesh) {
  return std::all_of(mesh.coordinates.begin(), mesh.coordinates.end(),
                     [](double x) { return std::abs(x) <= 1e50; });
}

void use(const AnyMesh& mesh) {
  const auto faults = meshadapt::check_mesh(executor(), mesh);
  expect_messages(faults);
  if (faults.empty()) {
    const auto domain = meshadapt::check_domain(executor(), mesh, mesh);
    expect(domain.empty() || !is_in_scale(mesh),
           "check_domain() finds that a mesh differs from itself");
    expect_messages(meshadapt::check_boundary(executor(), mesh));
  }
  meshadapt::measure(executor(), mesh, nullptr);
  if (mesh.dimension == 2)
    make<2>(mesh);
  else if (is_surface(mesh))
    make_surface(mesh);
  else
    make<3>(mesh);
}

}  // namespace

void try_mesh(std::string_view format, const std::uint8_t* bytes, std::size_t size) {
  static MemoryFile file;
  const auto rows = meshadapt::format_rows();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const auto& one) { return one.ending.substr(1) == format; });
  if (row == rows.end()) fail("no format " + std::string(format));
  file.set(bytes, size);
  meshadapt::Warnings warnings;
  try {  // this reader, whatever the bytes begin with
    const AnyMesh mesh = row->read(meshadapt::read_bytes(file.path()), &warnings).mesh;
    expect_messages(warnings);
    const std::string_view text(reinterpret_cast<const char*>(bytes), size);
    expect_whole(mesh, size, text.find("ZLib") != std::string_view::npos);
    expect_round_trip(mesh, size + bytes[size / 2]);
    expect_round_trip_in_space(mesh, size + bytes[size / 2]);
    use(mesh);
  } catch (const meshadapt::InputError& error) {
    expect_message_of(file.path(), error.what());
  }
}

}  // namespace ductile::fuzz
