/// @file
/// Data of files beside cells: groups, markers, pieces, counts and the order of components. Each
/// kind is tested with many random inputs.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io_support.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::tagged_files_test {
namespace {

using Random = std::mt19937_64;

int below(Random& random, int limit) {
  return static_cast<int>(random() % static_cast<unsigned>(limit));
}

AnyMesh read_text(const std::string& name, const std::string& text, Warnings* warnings = nullptr) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / name, text);
  return read_mesh(folder / name, warnings);
}

std::string complaint_about(const std::string& name, const std::string& text) {
  return test::complaint([&] { read_text(name, text); });
}

// ---- Legacy VTK ----

/// The parts of a file of two triangles; the count of part `off` is wrong.
std::vector<std::string> vtk_parts(int off) {
  const auto count = [&](int part, int right) { return std::to_string(right + (off == part)); };
  return {"POINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n", "CELLS 2 8\n3 0 1 2\n3 0 2 3\n",
          "CELL_TYPES " + count(2, 2) + "\n5 5 " + (off == 2 ? "5\n" : "\n"),
          "POINT_DATA " + count(3, 4) + "\nSCALARS a float\nLOOKUP_TABLE default\n1 2 3 4 " +
              (off == 3 ? "5\n" : "\n"),
          "CELL_DATA " + count(4, 2) + "\nSCALARS b float\nLOOKUP_TABLE default\n1 2 " +
              (off == 4 ? "3\n" : "\n")};
}

TEST(TaggedFiles, HavePartsOfLegacyVtkInAnyOrder) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  std::array<std::size_t, 5> order{0, 1, 2, 3, 4};
  const test::TemporaryFolder folder;
  do {
    for (const int off : {-1, 2, 3, 4}) {
      std::string text = head;
      const auto parts = vtk_parts(off);
      for (const std::size_t part : order) text += parts[part];
      if (off >= 0) {
        EXPECT_NE(complaint_about("a.vtk", text).find("count"), std::string::npos) << text;
        continue;
      }
      test::put_bytes(folder / "a.vtk", text);
      const MeshWithFields file = read_mesh_with_fields(folder / "a.vtk");
      EXPECT_EQ(file.mesh.triangles.size(), 2U);
      EXPECT_EQ(file.fields.size(), 2U);
      for (const std::string& part : parts)  // twice
        EXPECT_NE(complaint_about("a.vtk", text + part).find("found a second"), std::string::npos);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

// ---- Gmsh ----

/// A strip of triangles, each with its groups, in Gmsh's version 4.1.
std::string strip_in_groups(const std::vector<std::set<int>>& groups_of) {
  const auto n = std::to_string(groups_of.size());
  std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"one\"\n2 3 "
      "\"three\"\n$EndPhysicalNames\n$Entities\n0 0 " +
      n + " 0\n";
  for (std::size_t i = 0; i < groups_of.size(); ++i) {
    text += std::to_string(i + 1) + " 0 0 0 1 1 0 " + std::to_string(groups_of[i].size());
    for (const int group : groups_of[i]) text += " " + std::to_string(group);
    text += " 0\n";
  }
  const auto nodes = groups_of.size() + 2;
  text += "$EndEntities\n$Nodes\n1 " + std::to_string(nodes) + " 1 " + std::to_string(nodes) +
          "\n2 1 0 " + std::to_string(nodes) + "\n";
  for (std::size_t i = 1; i <= nodes; ++i) text += std::to_string(i) + "\n";
  for (std::size_t i = 0; i < nodes; ++i)
    text += std::to_string(i / 2) + " " + std::to_string(i % 2) + " 0\n";
  text += "$EndNodes\n$Elements\n" + n + " " + n + " 1 " + n + "\n";
  for (std::size_t i = 1; i <= groups_of.size(); ++i)
    text += "2 " + std::to_string(i) + " 2 1\n" + std::to_string(i) + " " + std::to_string(i) +
            " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  return text + "$EndElements\n";
}

/// The groups of each triangle in a file of version 4.1, in the order of the file.
std::map<int, std::set<int>> groups_in(const std::string& text) {
  const auto after = [&](const char* section) {
    return text.c_str() + text.find(section) + std::string(section).size();
  };
  char* at = nullptr;
  const auto next = [&] { return static_cast<int>(std::strtod(at, &at)); };
  std::set<int> none;
  for (const char* name = std::strstr(text.c_str(), "\"no group\""); name != nullptr;
       name = nullptr) {
    const char* line = name;
    while (line[-1] != '\n') --line;
    at = const_cast<char*>(line);
    if (next() == 2) none.insert(next());
  }
  at = const_cast<char*>(after("$Entities"));
  const int points = next(), lines = next(), surfaces = next();
  next();
  EXPECT_EQ(points + lines, 0);
  std::map<int, std::set<int>> of_entity, of_triangle;
  for (int i = 0; i < surfaces; ++i) {
    std::set<int>& groups = of_entity[next()];
    for (int k = 0; k < 6; ++k) std::strtod(at, &at);
    for (int k = next(); k > 0; --k) groups.insert(next());
    next();
  }
  at = const_cast<char*>(after("$Elements"));
  const int blocks = next();
  for (int k = 0; k < 3; ++k) next();
  for (int b = 0; b < blocks; ++b) {
    next();
    std::set<int> groups = of_entity[next()];
    next();
    EXPECT_FALSE(groups.empty());  // meshio and MFEM refuse such
    for (const int group : none) groups.erase(group);
    for (int k = next(); k > 0; --k) {
      of_triangle[next()] = groups;
      for (int c = 0; c < 3; ++c) next();
    }
  }
  return of_triangle;
}

TEST(TaggedFiles, KeepAllOfGmshsGroupsOfAnElement) {
  const test::TemporaryFolder folder;
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<std::set<int>> groups_of(2 + random() % 12);
    bool any = false;
    for (auto& groups : groups_of)
      for (int k = below(random, 4); k > 0; --k) groups.insert(1 + below(random, 5));
    for (const auto& groups : groups_of) any = any || !groups.empty();
    if (!any) continue;  // then the entities determine the references
    const AnyMesh mesh = read_text("a.msh", strip_in_groups(groups_of));
    for (const char* way : {".msh", ".vtu", ".vtk", "old"}) {
      const bool old = std::string(way) == "old";
      write_mesh(folder / "way.msh", mesh,
                 {.format = old ? ".msh" : std::string_view(way), .version = old ? 2 : 0});
      write_mesh(folder / "b.msh", read_mesh(folder / "way.msh"));
      const auto found = groups_in(test::get_bytes(folder / "b.msh"));
      ASSERT_EQ(found.size(), groups_of.size()) << way;
      for (std::size_t i = 0; i < groups_of.size(); ++i)
        EXPECT_EQ(found.at(static_cast<int>(i) + 1), groups_of[i]) << way << " " << trial;
    }
  }
}

// ---- SU2 ----

TEST(TaggedFiles, KeepAllMarkersApart) {
  const test::TemporaryFolder folder;
  Random random(6);
  const std::vector<std::string> names{"wall 1", "wall_1", "wall_1_2", "2", "3",
                                       "wall=1", "-1",     "",         "07"};
  for (int trial = 0; trial < 300; ++trial) {
    AnyMesh mesh = box_mesh<2>({1, 1}, {2, 2});
    for (std::int32_t& reference : mesh.edges.reference) reference = below(random, 6) - 1;
    for (int reference = -1; reference < 5; ++reference)
      if (random() % 4 != 0) mesh.names.push_back({1, reference, names[random() % names.size()]});
    Warnings warnings;
    write_mesh(folder / "a.su2", mesh, {.warnings = &warnings});
    const AnyMesh found = read_mesh(folder / "a.su2");
    std::map<std::array<std::uint32_t, 2>, std::int32_t> reference_of;
    for (std::size_t i = 0; i < mesh.edges.size(); ++i)
      reference_of[mesh.edges.vertices[i]] = mesh.edges.reference[i];
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    std::set<std::int32_t> before, after;
    for (std::size_t i = 0; i < found.edges.size(); ++i) {
      pairs.emplace(reference_of.at(found.edges.vertices[i]), found.edges.reference[i]);
      before.insert(reference_of.at(found.edges.vertices[i]));
      after.insert(found.edges.reference[i]);
    }
    EXPECT_EQ(pairs.size(), before.size());
    EXPECT_EQ(after.size(), before.size()) << test::get_bytes(folder / "a.su2");
  }
}

// ---- Pieces of .vtu ----

std::string array(const std::string& type, const std::string& name, int components,
                  const std::string& text) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + text + "</DataArray>";
}

/// A piece with the triangles of this part, and only the points that they need.
std::string piece_of(const AnyMesh& mesh, const std::vector<int>& part_of, int part, bool numbers) {
  std::map<std::uint32_t, std::size_t> index_of;
  std::string points, ids, values, cells, ends, types, regions;
  int count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (part_of[t] != part) continue;
    for (const std::uint32_t v : mesh.triangles.vertices[t]) {
      const auto [at, is_new] = index_of.try_emplace(v, index_of.size());
      cells += std::to_string(at->second) + " ";
      if (!is_new) continue;
      points += std::to_string(mesh.coordinates[2 * v]) + " " +
                std::to_string(mesh.coordinates[2 * v + 1]) + " 0 ";
      ids += std::to_string(v) + " ";
      values += std::to_string(v) + " ";
    }
    ends += std::to_string(3 * ++count) + " ";
    types += "5 ";
    regions += std::to_string(t) + " ";
  }
  const std::string head = "<Piece NumberOfPoints=\"" + std::to_string(index_of.size()) +
                           "\" NumberOfCells=\"" + std::to_string(count) + "\">";
  if (count == 0) return head + "</Piece>";
  return head + "<Points>" + array("Float64", "Points", 3, points) + "</Points><Cells>" +
         array("Int64", "connectivity", 1, cells) + array("Int64", "offsets", 1, ends) +
         array("UInt8", "types", 1, types) + "</Cells><PointData>" +
         array("Float64", "u", 1, values) +
         (numbers ? array("Int64", "GlobalPointIds", 1, ids) : "") + "</PointData><CellData>" +
         array("Int32", "region", 1, regions) + "</CellData></Piece>";
}

std::string vtu_of(const std::string& pieces) {
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + pieces +
         "</UnstructuredGrid></VTKFile>";
}

/// Positions and values of the corners of triangles, by the triangles' region.
std::map<std::int32_t, std::set<std::array<double, 3>>> triangles_of(const MeshWithFields& file) {
  std::map<std::int32_t, std::set<std::array<double, 3>>> result;
  for (std::size_t t = 0; t < file.mesh.triangles.size(); ++t)
    for (const std::uint32_t v : file.mesh.triangles.vertices[t])
      result[file.mesh.triangles.reference[t]].insert({file.mesh.coordinates[2 * v],
                                                       file.mesh.coordinates[2 * v + 1],
                                                       file.fields.at(0).values[v]});
  return result;
}

TEST(TaggedFiles, JoinPiecesOfGrids) {
  const test::TemporaryFolder folder;
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    AnyMesh mesh = box_mesh<2>({1, 1}, {1 << below(random, 3), 1 << below(random, 3)});
    const int parts = 1 + below(random, 5);
    std::vector<int> part_of(mesh.triangles.size());
    for (int& part : part_of) part = below(random, parts);
    std::string pieces, sources;
    const bool numbers = trial % 2 == 0;
    for (int part = 0; part <= parts; ++part) {  // the last one is empty
      const std::string piece = piece_of(mesh, part_of, part, numbers),
                        name = "p" + std::to_string(part) + ".vtu";
      pieces += piece;
      test::put_bytes(folder / name, vtu_of(piece));
      sources += "<Piece Source=\"" + name + "\"/>";
    }
    test::put_bytes(folder / "a.vtu", vtu_of(pieces));
    test::put_bytes(folder / "a.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>" +
                                           sources + "</PUnstructuredGrid></VTKFile>");
    test::put_bytes(folder / "one.vtu",
                    vtu_of(piece_of(mesh, std::vector<int>(part_of.size(), 0), 0, false)));
    const auto expected = triangles_of(read_mesh_with_fields(folder / "one.vtu"));
    for (const char* name : {"a.vtu", "a.pvtu"}) {
      const MeshWithFields found = read_mesh_with_fields(folder / name);
      EXPECT_EQ(found.mesh.vertex_count(), mesh.vertex_count());
      EXPECT_EQ(triangles_of(found), expected);
      EXPECT_EQ(found.fields.size(), 1U);
    }
  }
}

TEST(TaggedFiles, RefusePiecesThatDoNotFit) {
  const auto triangle = [](const std::string& points, const std::string& arrays) {
    return "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>" +
           array("Float64", "P", 3, points) + "</Points><Cells>" +
           array("Int64", "connectivity", 1, "0 1 2") + array("Int64", "offsets", 1, "3") +
           array("UInt8", "types", 1, "5") + "</Cells><PointData>" + arrays +
           "</PointData></Piece>";
  };
  const std::string twice = triangle("0 0 0 1 0 0 0 1 0 0 0 0", ""),
                    once = triangle("0 0 0 1 0 0 0 -1 0 5 5 0", "");
  EXPECT_NE(complaint_about("a.vtu", vtu_of(twice + once)).find("GlobalPointIds"),
            std::string::npos);
  const std::string more = triangle("9 0 0 8 0 0 8 1 0 9 9 0", array("Float64", "u", 1, "1 2 3 4"));
  EXPECT_NE(complaint_about("a.vtu", vtu_of(once + more)).find("arrays"), std::string::npos);
  EXPECT_NE(complaint_about("a.vtu", vtu_of(more + once)).find("'u'"), std::string::npos);
}

/// Zeros as appended data: the table of one block, then the block.
std::string packed_zeros(std::size_t bytes) {
  const std::string plain(bytes, '\0');
  uLongf size = compressBound(bytes);
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(plain.data()), bytes);
  packed.resize(size);
  std::string head;
  for (const std::size_t number : {std::size_t{1}, bytes, std::size_t{0}, packed.size()})
    for (std::size_t k = 0; k < 4; ++k) head.push_back(static_cast<char>(number >> (8 * k) & 255));
  return head + packed;
}

/// A grid of points with arrays that all refer to one compressed block.
std::string sharing(int arrays, std::size_t values) {
  const std::string points = packed_zeros(24 * values);
  const std::string type = "<DataArray type=\"Float64\" format=\"appended\" ";
  std::string text =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" "
      "compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
      std::to_string(values) + "\" NumberOfCells=\"0\"><PointData>";
  for (int i = 0; i < arrays; ++i)
    text += type + "Name=\"a" + std::to_string(i) + "\" offset=\"" + std::to_string(points.size()) +
            "\"/>";
  return text + "</PointData><Points>" + type + "NumberOfComponents=\"3\" offset=\"0\"/></Points>" +
         "<Cells>" + array("Int64", "connectivity", 1, "") + array("Int64", "offsets", 1, "") +
         array("UInt8", "types", 1, "") +
         "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" + points +
         packed_zeros(8 * values) + "</AppendedData></VTKFile>";
}

TEST(TaggedFiles, ShareNoCompressedBlocksBeyondTheirSize) {
  // Without a bound, 100 arrays of one block would take 100 times its memory.
  for (const int arrays : {60, 100, 1000}) {
    const std::string told = complaint_about("a.vtu", sharing(arrays, 100000));
    EXPECT_NE(told.find("share"), std::string::npos) << told;
  }
  EXPECT_EQ(read_text("b.vtu", sharing(1, 1000)).vertex_count(), 1000U);
}

// ---- Vertices whose references mark points ----

AnyMesh random_box(Random& random, int dimension) {
  const int n = 3 + below(random, 4);
  return dimension == 2 ? box_mesh<2>({1, 1}, {n, n + 1}) : box_mesh({1, 1, 1}, {n, n, 3});
}

AdaptedMesh adapted(const AnyMesh& mesh, double size) {
  return adapt(runtime::Executor({.threads = 2}), mesh, constant_metric(mesh, size));
}

using Marks = std::set<std::pair<std::int32_t, std::vector<double>>>;

Marks marks_of(const AnyMesh& mesh) {
  const auto d = static_cast<std::size_t>(mesh.dimension);
  Marks marks;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.vertex_reference[v] != 0)
      marks.insert(
          {mesh.vertex_reference[v], {&mesh.coordinates[d * v], &mesh.coordinates[d * v] + d}});
  return marks;
}

TEST(TaggedFiles, KeepVerticesThatAreMarked) {
  const test::TemporaryFolder folder;
  Random random(9);
  for (const int dimension : {2, 3})
    for (std::uint64_t trial = 0; trial < test::trials(15); ++trial) {
      AnyMesh mesh = random_box(random, dimension);
      for (int k = 1 + below(random, 5); k > 0; --k)
        mesh.vertex_reference[random() % mesh.vertex_count()] =
            10 + below(random, 3) - 20 * below(random, 2);
      const Marks marks = marks_of(mesh);
      for (const char* name : {"a.mesh", "a.meshb", "a.msh", "a.vtu", "a.vtk"}) {
        write_mesh(folder / name, mesh);
        // Adapted twice, coarser and finer, because a reference that is kept once must be kept
        // again.
        const AnyMesh once = adapted(read_mesh(folder / name), 0.8).mesh;
        write_mesh(folder / name, once);
        const AnyMesh twice = adapted(read_mesh(folder / name), 0.2).mesh;
        EXPECT_EQ(marks_of(once), marks) << name;
        EXPECT_EQ(marks_of(twice), marks) << name;
      }
    }
}

TEST(TaggedFiles, FreezeNoBoundaryWhoseVerticesAreLabelled) {
  for (const int dimension : {2, 3}) {
    AnyMesh mesh = dimension == 2 ? box_mesh<2>({1, 1}, {12, 12}) : box_mesh({1, 1, 1}, {8, 8, 8});
    const auto plain = adapted(mesh, 0.5).mesh.vertex_count();
    for (std::size_t i = 0; i < mesh.edges.size() && dimension == 2; ++i)
      for (const std::uint32_t v : mesh.edges.vertices[i])
        mesh.vertex_reference[v] = mesh.edges.reference[i];
    for (std::size_t i = 0; i < mesh.triangles.size() && dimension == 3; ++i)
      for (const std::uint32_t v : mesh.triangles.vertices[i])
        mesh.vertex_reference[v] = mesh.triangles.reference[i];
    EXPECT_EQ(adapted(mesh, 0.5).mesh.vertex_count(), plain);
  }
}

// ---- Formats that are not read, and components in another order ----

TEST(TaggedFiles, AreToldByTheirFormat) {
  using std::string_literals::operator""s;
  const std::vector<std::array<std::string, 3>> files{
      {"a.inp", "*HEADING\nx\n*NODE\n1, 0, 0, 0\n", "Abaqus"},
      {"a.inp", "*INCLUDE, INPUT=b.inp\n", "Abaqus"},
      {"a.inp", "# made by a program\n5 8 1 0 0\n1 0 0 0\n", "--input-format avsucd"},
      {"a.txt", "** made by hand\n*Node\n1, 0., 0.\n", "Abaqus"},
      {"a.med", "\x89HDF\r\n\x1a\n....INFOS_GENERALES", "MED"},
      {"a.x", "\x89HDF\r\n\x1a\n....CGNSLibraryVersion", "CGNS"},
      {"a.exo", "\x89HDF\r\n\x1a\n....coor_names", "Exodus"},
      {"a.e", "CDF\x01\0\0"s, "Exodus"},
      {"a.xdmf", "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"/>", "XDMF"},
      {"a.mesh", "MFEM mesh v1.0\ndimension\n2\n", "MFEM"},
      {"a.bdf", "$ made by hand\nGRID,1,,0.,0.,0.\n", "Nastran"},
      {"points", "/*--*/\nFoamFile\n{\n", "OpenFOAM"},
      {"a.msh", "4 2 4\n0 0 1\n1 0 1\n", "FreeFEM"},
      {"a.mesh", "\x1f\x8b\b\0"s, "gzip"}};
  for (const auto& [name, text, format] : files) {
    const std::string told = complaint_about(name, text);
    EXPECT_NE(told.find(format), std::string::npos) << told;
    EXPECT_NE(told.find("first"), std::string::npos) << told;
    EXPECT_EQ(told.find('\n'), std::string::npos) << told;
  }
}

TEST(TaggedFiles, SuspectAnotherOrderOfComponents) {
  Random random(8);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 100; ++trial) {
      AnyMesh mesh = dimension == 2 ? box_mesh<2>({1, 1}, {2, 2}) : box_mesh({1, 1, 1}, {1, 1, 1});
      AnyField field;
      field.dimension = dimension;
      field.vertex_count = mesh.vertex_count();
      field.types = {AnyField::Type::symmetric};
      const bool wrong = trial % 2 == 0;
      for (std::size_t v = 0; v < field.vertex_count; ++v) {
        // Off-diagonal entries are smaller than the diagonal ones only in the right order.
        const double a = 1 + below(random, 9), b = 100 * a, c = 1e4 * a;
        const std::vector<double> in_vtk = dimension == 2
                                               ? std::vector{a, b, 0.1 * a}
                                               : std::vector{a, b, c, 0.1 * a, 0.2 * a, -0.1 * a};
        field.values.insert(field.values.end(), in_vtk.begin(), in_vtk.end());
        if (!wrong && v == 0) field.values[0] = -1;  // no metric in any order
      }
      const std::string told = test::complaint([&] { metric_of(field, mesh); });
      EXPECT_EQ(told.find("order of components") != std::string::npos, wrong) << told;
    }
}

}  // namespace
}  // namespace ductile::meshadapt::tagged_files_test
