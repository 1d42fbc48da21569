#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::formats_test {
namespace {

using Form = WriteOptions::Form;
using Place = NamedField::Place;
using Type = AnyField::Type;

// ---- Files that are written are read ----

NamedField random_named(const AnyMesh& mesh, Type type, Place place, unsigned seed) {
  const std::size_t count = place == Place::vertices ? mesh.vertex_count()
                            : mesh.dimension == 2    ? mesh.triangles.size()
                                                     : mesh.tetrahedra.size();
  return {"field " + std::to_string(seed), type,
          test::random_field(mesh.dimension, count, {type}, seed).values, place};
}

/// A mesh with all kinds of cells, references and names that formats with three coordinates hold.
MeshWithFields random_file(int dimension, std::size_t size, unsigned seed) {
  MeshWithFields file{test::random_mesh(dimension, size, seed), {}};
  AnyMesh& mesh = file.mesh;
  for (auto* list : {&mesh.corners, &mesh.ridges, &mesh.required_vertices, &mesh.required_edges,
                     &mesh.required_triangles, &mesh.required_tetrahedra})
    list->clear();
  for (std::size_t i = 0; i < size; ++i) {
    if (i % 3 == 0) mesh.vertex_reference[i] = 0;
    if (i < mesh.edges.size() && i % 4 == 0) mesh.edges.reference[i] = 0;
    if (i < mesh.triangles.size() && i % 2 == 0) mesh.triangles.reference[i] = 7;
  }
  mesh.names = {{dimension, 7, "steel"}, {1, -3, "outer wall"}, {0, 5, "tip \xC3\xA9"}};
  unsigned number = 10 * seed;
  for (const Place place : {Place::vertices, Place::elements})
    for (const Type type : {Type::scalar, Type::vector, Type::symmetric, Type::matrix})
      file.fields.push_back(random_named(mesh, type, place, ++number));
  return file;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

void expect_same(const MeshWithFields& found, const MeshWithFields& expected) {
  AnyMesh mesh = found.mesh;
  EXPECT_TRUE(same_bits(mesh.coordinates, expected.mesh.coordinates));
  mesh.name = expected.mesh.name;
  EXPECT_EQ(mesh, expected.mesh);
  ASSERT_EQ(found.fields.size(), expected.fields.size());
  for (const NamedField& field : expected.fields) {
    const auto same =
        std::find_if(found.fields.begin(), found.fields.end(),
                     [&](const NamedField& other) { return other.name == field.name; });
    ASSERT_NE(same, found.fields.end()) << field.name;
    EXPECT_EQ(same->type, field.type) << field.name;
    EXPECT_EQ(same->place, field.place) << field.name;
    EXPECT_TRUE(same_bits(same->values, field.values)) << field.name;
  }
}

struct Way {
  const char* ending;
  int version;
  Form form;
};
constexpr Way ways[] = {{".msh", 2, Form::ascii},   {".msh", 2, Form::binary},
                        {".msh", 4, Form::ascii},   {".msh", 4, Form::binary},
                        {".msh", 0, Form::by_name}, {".vtu", 0, Form::by_name},
                        {".vtk", 0, Form::ascii},   {".vtk", 0, Form::binary}};

TEST(Formats, ReadWhatTheyWrite) {
  const test::TemporaryFolder folder;
  unsigned seed = 0;
  for (const Way& way : ways)
    for (const int dimension : {2, 3})
      for (const std::size_t size : {1U, 2U, 17U, 300U}) {
        SCOPED_TRACE(std::string(way.ending) + " " + std::to_string(way.version) + " " +
                     std::to_string(static_cast<int>(way.form)) + " " + std::to_string(dimension) +
                     " " + std::to_string(size));
        const MeshWithFields file = random_file(dimension, size, ++seed);
        const auto path = folder / ("a" + std::string(way.ending));
        Warnings warnings;
        WriteOptions options;
        options.fields = file.fields;
        options.version = way.version;
        options.form = way.form;
        options.warnings = &warnings;
        write_mesh(path, file.mesh, options);
        expect_same(read_mesh_with_fields(path, &warnings), file);
        EXPECT_EQ(warnings, Warnings{});
      }
}

/// meshio and others turn each block of a file into a block of cells.
TEST(Formats, WriteOneBlockForEachEntityOfGmsh) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = box_mesh<2>({1, 1}, {6, 6});
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    mesh.triangles.reference[i] = i % 3 == 0 ? 7 : -2;
  write_mesh(folder / "a.msh", mesh, {});
  const std::string text = test::get_bytes(folder / "a.msh");
  EXPECT_NE(text.find("$Elements\n6 "), std::string::npos);  // four sides, two regions
  EXPECT_EQ(read_mesh(folder / "a.msh").triangles, mesh.triangles);
}

TEST(Formats, KeepSurfacesInSpace) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = box_mesh({1, 1, 1}, {2, 2, 2});
  mesh.tetrahedra = {};
  mesh.edges.add({0, 1}, 9);
  for (const Way& way : ways) {
    const auto path = folder / ("a" + std::string(way.ending));
    WriteOptions options;
    options.version = way.version;
    options.form = way.form;
    write_mesh(path, mesh, options);
    const AnyMesh found = read_mesh(path);
    EXPECT_EQ(found.dimension, 3);
    EXPECT_EQ(found.triangles, mesh.triangles) << way.ending << way.version;
    EXPECT_EQ(found.edges, mesh.edges) << way.ending << way.version;
  }
}

TEST(Formats, KeepReferencesThatAreAllZeroAndNoFields) {
  const test::TemporaryFolder folder;
  for (const Way& way : ways) {
    AnyMesh mesh = box_mesh<2>({1, 1}, {2, 3});
    mesh.triangles.reference.assign(mesh.triangles.size(), 0);
    const auto path = folder / ("a" + std::string(way.ending));
    WriteOptions options;
    options.version = way.version;
    options.form = way.form;
    write_mesh(path, mesh, options);
    AnyMesh found = read_mesh(path);
    found.name = mesh.name;
    found.corners = mesh.corners;  // the format has no corners
    EXPECT_EQ(found, mesh) << way.ending << way.version;
  }
}

TEST(Formats, SayWhatTheyHaveNoPlaceFor) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = box_mesh<2>({1, 1}, {2, 2});
  mesh.required_edges = {0, 1};
  mesh.names = {{2, 1, "steel"}};
  const std::vector<NamedField> fields = {
      {"u", Type::scalar, std::vector<double>(mesh.vertex_count(), 0.5)}};
  const auto lost = [&](const char* name) {
    Warnings warnings;
    WriteOptions options;
    options.warnings = &warnings;
    write_mesh(folder / name, mesh, options);
    return warnings.empty() ? std::string() : warnings.at(0);
  };
  EXPECT_NE(lost("a.mesh").find("names of references (1)"), std::string::npos);
  for (const char* name : {"a.msh", "a.vtu", "a.vtk"})
    EXPECT_NE(lost(name).find("required edges (2)"), std::string::npos) << name;
  EXPECT_NE(test::complaint([&] {
              write_mesh(folder / "b.mesh", mesh, {.fields = fields});
            }).find("hold no fields"),
            std::string::npos);
}

TEST(Formats, WriteSu2WithMarkersByName) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = box_mesh<2>({1, 1}, {1, 1});
  mesh.edges.reference = {1, 2, 2, 2};
  mesh.names = {{1, 2, "outer wall"}, {2, 1, "not this"}};
  mesh.required_edges = {0};
  Warnings warnings;
  WriteOptions options;
  options.warnings = &warnings;
  write_mesh(folder / "a.su2", mesh, options);
  const std::string text = test::get_bytes(folder / "a.su2");
  EXPECT_TRUE(text.starts_with("NDIME= 2\nNELEM= 2\n5 ")) << text;
  EXPECT_NE(text.find("NPOIN= 4\n0 0 \n"), std::string::npos) << text;
  EXPECT_NE(text.find("NMARK= 2\nMARKER_TAG= 1\nMARKER_ELEMS= 1\n3 "), std::string::npos) << text;
  EXPECT_NE(text.find("MARKER_TAG= outer_wall\nMARKER_ELEMS= 3\n"), std::string::npos) << text;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("required edges (1)"), std::string::npos);
}

TEST(Formats, WriteTheSurfaceAsStl) {
  const test::TemporaryFolder folder;
  const AnyMesh mesh = box_mesh({1, 1, 1}, {3, 3, 3});
  write_mesh(folder / "a.stl", mesh);
  const std::string bytes = test::get_bytes(folder / "a.stl");
  ASSERT_EQ(bytes.size(), 84U + 108U * 50U);  // two triangles on each of six times nine squares
  double volume = 0, area = 0;
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    std::array<float, 12> x;  // normal, corners
    std::memcpy(x.data(), &bytes[at], sizeof x);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      const double cross = (x[6 + l] - x[3 + l]) * (x[9 + m] - x[3 + m]) -
                           (x[6 + m] - x[3 + m]) * (x[9 + l] - x[3 + l]);
      area += cross * x[k] / 2;
      volume += cross * x[3 + k] / 6;
    }
  }
  EXPECT_NEAR(area, 6, 1e-5);  // so normals point outwards, and corners are ordered accordingly
  EXPECT_NEAR(volume, 1, 1e-5);
  EXPECT_NE(test::complaint([&] {
              write_mesh(folder / "b.stl", box_mesh<2>({1, 1}, {2, 2}));
            }).find("dimension 3"),
            std::string::npos);
}

TEST(Formats, AreInOneTable) {
  for (const MeshFormat& format : mesh_formats()) {
    const MeshFormat* const found = format_of("a" + std::string(format.ending));
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->what, format.what);
    EXPECT_TRUE(format.is_read || format.is_written);
    EXPECT_EQ(written_endings().find(format.ending) != std::string::npos, format.is_written);
  }
  EXPECT_EQ(format_of("a.xyz"), nullptr);
}

// ---- Files of other programs ----

MeshWithFields foreign(const std::string& name, Warnings* warnings = nullptr) {
  return read_mesh_with_fields(std::string(DUCTILE_TEST_FILES) + "/" + name, warnings);
}

std::size_t count_of(const std::vector<std::int32_t>& references, std::int32_t reference) {
  return static_cast<std::size_t>(std::count(references.begin(), references.end(), reference));
}

void expect_square(const AnyMesh& mesh) {
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.vertex_count(), 21U);
  EXPECT_EQ(count_of(mesh.vertex_reference, 3), 1U);
  EXPECT_EQ(count_of(mesh.edges.reference, 5), 6U);
  EXPECT_EQ(count_of(mesh.edges.reference, 7), 8U);
  EXPECT_EQ(count_of(mesh.triangles.reference, 10), 14U);
  EXPECT_EQ(count_of(mesh.triangles.reference, 20), 14U);
  EXPECT_EQ(mesh.edges.size() + mesh.triangles.size(), 42U);
  EXPECT_EQ(mesh.names,
            (std::vector<ReferenceName>{
                {0, 3, "corner"}, {1, 5, "wall"}, {2, 10, "steel"}, {2, 20, "soft rubber"}}));
}

TEST(Formats, ReadGmshsFiles) {
  AnyMesh square = foreign("square-41-text.msh").mesh;
  square.name.clear();
  for (const char* name : {"square-22-text.msh", "square-22-binary.msh", "square-41-text.msh",
                           "square-41-binary.msh", "param-22-binary.msh", "param-41-text.msh"}) {
    SCOPED_TRACE(name);
    Warnings warnings;
    expect_square(foreign(name, &warnings).mesh);
    EXPECT_EQ(warnings, Warnings{});
    if (std::string_view(name).starts_with("square-41")) {
      AnyMesh mesh = foreign(name).mesh;
      mesh.name.clear();
      mesh.coordinates = square.coordinates;  // Gmsh writes 16 digits
      EXPECT_EQ(mesh, square);
    }
  }
  for (const char* name : {"parts-22-text.msh", "parts-41-binary.msh"}) {
    SCOPED_TRACE(name);
    Warnings warnings;
    expect_square(foreign(name, &warnings).mesh);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("partition"), std::string::npos);
  }
  for (const char* name : {"box-22-binary.msh", "box-41-text.msh"}) {
    const AnyMesh box = foreign(name).mesh;
    EXPECT_EQ(box.dimension, 3);
    EXPECT_EQ(box.triangles.reference, std::vector<std::int32_t>(44, 1));
    EXPECT_EQ(count_of(box.tetrahedra.reference, 1), 24U);
    EXPECT_EQ(count_of(box.tetrahedra.reference, 2), 24U);
    EXPECT_EQ(box.names.size(), 3U);
  }
}

TEST(Formats, GiveElementsInSeveralOfGmshsGroupsAReferenceOfTheirOwn) {
  for (const char* name : {"groups-22-text.msh", "groups-41-text.msh"}) {
    SCOPED_TRACE(name);
    Warnings warnings;
    const AnyMesh mesh = foreign(name, &warnings).mesh;
    EXPECT_EQ(mesh.triangles.reference, std::vector<std::int32_t>(14, 3));
    EXPECT_EQ(count_of(mesh.edges.reference, 4), 6U);
    EXPECT_EQ(count_of(mesh.edges.reference, 1), 2U);
    EXPECT_EQ(warnings, Warnings{});
  }
}

TEST(Formats, ReadGmshsFields) {
  const MeshWithFields file = foreign("fields-binary.msh");
  expect_square(file.mesh);
  ASSERT_EQ(file.fields.size(), 2U);
  EXPECT_EQ(file.fields[0].name, "u");
  for (std::size_t v = 0; v < 21; ++v)
    EXPECT_DOUBLE_EQ(file.fields[0].values[v],
                     file.mesh.coordinates[2 * v] + 2 * file.mesh.coordinates[2 * v + 1]);
  EXPECT_EQ(file.fields[1].type, Type::vector);
  EXPECT_EQ(file.fields[1].place, Place::elements);
  for (std::size_t t = 0; t < 28; ++t)
    EXPECT_EQ(file.fields[1].values[2 * t + 1], -static_cast<double>(16 + t));
}

void expect_two_tetrahedra(const MeshWithFields& file) {
  EXPECT_EQ(file.mesh.dimension, 3);
  EXPECT_EQ(file.mesh.coordinates,
            (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(file.mesh.tetrahedra.vertices,
            (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(file.mesh.tetrahedra.reference, (std::vector<std::int32_t>{10, 11}));
  EXPECT_EQ(file.mesh.triangles.reference, (std::vector<std::int32_t>{12, 13, 14, 15, 16, 17}));
  ASSERT_EQ(file.fields.size(), 3U);
  EXPECT_EQ(file.fields[0].values, (std::vector<double>{0, 1, 2, 3, 6}));
  EXPECT_EQ(file.fields[1].type, Type::vector);
  EXPECT_EQ(file.fields[2].place, Place::elements);
  EXPECT_EQ(file.fields[2].values, (std::vector<double>{0, 0.125}));
}

TEST(Formats, ReadVtksFiles) {
  for (const char* name : {"vtk3d-ascii-32.vtu", "vtk3d-inline-32.vtu", "vtk3d-inline-zlib-64.vtu",
                           "vtk3d-raw-32.vtu", "vtk3d-raw-64.vtu", "vtk3d-raw-zlib-32.vtu",
                           "vtk3d-base64-64.vtu", "vtk3d-base64-zlib-32.vtu", "vtk3d-text-42.vtk",
                           "vtk3d-binary-42.vtk", "vtk3d-text-51.vtk", "vtk3d-binary-51.vtk"}) {
    SCOPED_TRACE(name);
    Warnings warnings;
    expect_two_tetrahedra(foreign(name, &warnings));
    EXPECT_EQ(warnings, Warnings{});
  }
  for (const char* name : {"vtk2d-raw-zlib-64.vtu", "vtk2d-text-42.vtk", "vtk2d-binary-42.vtk",
                           "vtk2d-text-51.vtk", "vtk2d-binary-51.vtk"}) {
    const MeshWithFields flat = foreign(name);
    EXPECT_EQ(flat.mesh.dimension, 2);
    EXPECT_EQ(flat.mesh.edges.reference, (std::vector<std::int32_t>{12, 13, 14, 15}));
    EXPECT_EQ(flat.fields[1].values, (std::vector<double>{0, 0, .25, 0, .25, .25, 0, .25}));
  }
}

// ---- Files that cannot be read ----

TEST(Formats, RefuseInWords) {
  const auto says = [](const std::string& name) { return test::complaint([&] { foreign(name); }); };
  EXPECT_NE(says("second-22-text.msh").find("a line of second order"), std::string::npos);
  EXPECT_NE(says("vtk2d-lz4.vtu").find("write the file with zlib"), std::string::npos);
  const test::TemporaryFolder folder;
  struct Case {
    const char *bytes, *place, *fault;
  };
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", nodes = "$Nodes\n2\n7 0 0 0\n";
  const std::string twice = head + nodes + "7 1 0 0\n$EndNodes\n",
                    missing = head + nodes + "9 1 0 0\n$EndNodes\n$Elements\n1\n1 1 0 7 8\n",
                    below = head + nodes + "9 1 0 0\n$EndNodes\n$Elements\n1\n1 1 0 7 -8\n",
                    quad = head + nodes + "9 1 0 0\n$EndNodes\n$Elements\n1\n1 3 0 7 8 9 9\n",
                    many = head + "$Nodes\n4000000000\n1 0 0 0\n$EndNodes\n";
  for (const Case& one : std::initializer_list<Case>{
           {"$MeshFormat\n4 0 8\n$EndMeshFormat\n", ":2: ", "version 2.2 or 4.1"},
           {"$NOD\n1\n", ":1: ", "expected $MeshFormat first"},
           {"$MeshFormat\n4.1 0 8\n", ":3: ", "cut short"},
           {twice.c_str(), ":", "found node 7 twice"},
           {missing.c_str(), ":11: ", "found 8"},
           {below.c_str(), ":11: ", "found -8"},
           {quad.c_str(), ":11: ", "a quadrangle (type 3)"},
           {many.c_str(), ":5: ", "found a count of 4000000000"},
           {"<VTKFile type=\"PolyData\">\n</VTKFile>", ": ", "found 'PolyData'"},
           {"<VTKFile type=\"UnstructuredGrid\">\n", ": ", "cut short"}}) {
    test::put_bytes(folder / "bad.msh", one.bytes);
    const std::string complaint = test::complaint([&] { read_mesh(folder / "bad.msh"); });
    EXPECT_NE(complaint.find("bad.msh" + std::string(one.place)), std::string::npos) << complaint;
    EXPECT_NE(complaint.find(one.fault), std::string::npos) << complaint;
  }
}

}  // namespace
}  // namespace ductile::meshadapt::formats_test
