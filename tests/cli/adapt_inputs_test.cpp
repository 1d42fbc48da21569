/// @file
/// Inputs of `ductile adapt` and messages about them: the metric in force, metrics of solutions,
/// sizes on elements, meshes that are not connected, requests that are too large.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "program.hpp"
#include "support/meshes.hpp"

namespace ductile::cli::adapt_inputs_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::NamedField;
namespace test = meshadapt::test;
using Place = NamedField::Place;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

AnyMesh grid(int dimension, int n) { return test::make_grid(test::unit_grid(dimension, n)); }

NamedField field_of(const AnyMesh& mesh, const std::string& name, Place place, auto value) {
  NamedField field;
  field.name = name;
  field.place = place;
  const std::size_t count = place == Place::vertices ? mesh.vertex_count() : element_count(mesh);
  for (std::size_t i = 0; i < count; ++i) field.values.push_back(value(i));
  return field;
}

/// Returns the mesh together with another one at its right side; the two share no vertices.
AnyMesh beside(AnyMesh mesh, const AnyMesh& other) {
  const auto shift = static_cast<std::uint32_t>(mesh.vertex_count());
  const auto d = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t i = 0; i < other.coordinates.size(); ++i)
    mesh.coordinates.push_back(other.coordinates[i] + (i % d == 0 ? 1 : 0));
  mesh.vertex_reference.insert(mesh.vertex_reference.end(), other.vertex_reference.begin(),
                               other.vertex_reference.end());
  const auto add = [&](auto& cells, const auto& others) {
    for (std::size_t i = 0; i < others.size(); ++i) {
      auto corners = others.vertices[i];
      for (auto& corner : corners) corner += shift;
      cells.add(corners, others.reference[i]);
    }
  };
  add(mesh.edges, other.edges);
  add(mesh.triangles, other.triangles);
  add(mesh.tetrahedra, other.tetrahedra);
  return mesh;
}

class AdaptInputs : public testing::TestWithParam<int> {
 protected:
  void write(const std::string& name, const AnyMesh& mesh,
             const std::vector<NamedField>& fields = {}) const {
    meshadapt::write_mesh(folder_.path() / name, mesh, {.fields = fields});
  }
  const Folder folder_;
  const int dimension_ = GetParam();
};

TEST_P(AdaptInputs, VerticesThatHangAreNamed) {
  for (const int n : {1, 2, 3}) {
    write("hang.mesh", beside(grid(dimension_, n), grid(dimension_, 2 * n)));
    for (const std::string words : {"adapt hang.mesh -hsiz 0.3 -o out.mesh", "info hang.mesh"}) {
      const Outcome outcome = folder_.run(words);
      EXPECT_TRUE(contains(outcome.err, " hangs: it lies on ")) << words << outcome.err;
      EXPECT_TRUE(contains(outcome.err, " is at the place of vertex ")) << words << outcome.err;
    }
  }
  write("whole.mesh", grid(dimension_, 3));
  EXPECT_FALSE(contains(folder_.run("info whole.mesh").err, "hangs"));
}

TEST_P(AdaptInputs, JoinsDoubledVerticesWithinATolerance) {
  const AnyMesh once = grid(dimension_, 3);
  AnyMesh twice = beside(once, once);
  for (std::size_t i = once.coordinates.size(); i < twice.coordinates.size(); ++i)
    twice.coordinates[i] += 1e-7;
  const auto joined = meshadapt::join_vertices(twice, 1e-6);
  const std::size_t side = dimension_ == 2 ? 4 : 16;
  EXPECT_EQ(joined.mesh.vertex_count(), twice.vertex_count() - side);
  write("twice.mesh", twice);
  meshadapt::write_field(
      folder_.path() / "twice.sol",
      meshadapt::scalar_field(dimension_, std::vector<double>(twice.vertex_count(), 0.3)));
  const Outcome joining = folder_.run("adapt twice.mesh --join 1e-6 --json - -o out.mesh");
  EXPECT_EQ(joining.status, 0) << joining.err;
  EXPECT_TRUE(contains(joining.err, std::to_string(side) + " vertices were joined")) << joining.err;
  EXPECT_FALSE(contains(joining.err, "not connected")) << joining.err;
  EXPECT_TRUE(joining.out.starts_with("{\"before\"")) << joining.out;
  EXPECT_TRUE(contains(joining.out, "twice.sol (found beside the mesh)")) << joining.out;
  const Outcome coarse = folder_.run("adapt twice.mesh --join 0.9 -o no.mesh");
  EXPECT_EQ(coarse.status, 2);
  EXPECT_TRUE(contains(coarse.err, "no farther apart than the tolerance")) << coarse.err;
  EXPECT_FALSE(folder_.has("no.mesh"));
}

TEST_P(AdaptInputs, NamesTheOptionThatJoinsOnlyForDoubledVertices) {
  const auto hint_beside = [&](const char* fault) {
    const std::string told = folder_.run("info a.mesh").err;
    const std::size_t at = told.find(fault);
    EXPECT_NE(at, std::string::npos) << told;
    return contains(told.substr(at, told.find('\n', at) - at), "--join");
  };
  for (const int n : {1, 2, 3}) {
    write("a.mesh", beside(grid(dimension_, n), grid(dimension_, 2 * n)));
    EXPECT_FALSE(hint_beside(" hangs: "));
    EXPECT_TRUE(hint_beside(" is at the place of vertex "));
  }
}

/// Whatever the format, the mesh is connected and fields have the values of vertices that stay.
TEST_P(AdaptInputs, ConvertsWithDoubledVerticesJoined) {
  const AnyMesh once = grid(dimension_, 3);
  const AnyMesh twice = beside(once, once);
  const std::size_t side = dimension_ == 2 ? 4 : 16, elements = dimension_ == 2 ? 36 : 324;
  std::vector<double> of_vertex(twice.vertex_count()), of_element(elements);
  for (std::size_t v = 0; v < of_vertex.size(); ++v)
    of_vertex[v] = twice.coordinates[v * static_cast<std::size_t>(dimension_)];
  for (std::size_t e = 0; e < of_element.size(); ++e) of_element[e] = static_cast<double>(e);
  using Place = NamedField::Place;
  const auto scalar = AnyField::Type::scalar;
  ASSERT_EQ(elements, dimension_ == 2 ? twice.triangles.size() : twice.tetrahedra.size());
  write("twice.vtu", twice,
        {{"x", scalar, of_vertex, Place::vertices}, {"e", scalar, of_element, Place::elements}});
  for (const char* out : {"a.vtu", "a.vtk", "a.msh", "a.mesh", "a.meshb", "a.su2"}) {
    const Outcome outcome = folder_.run("convert twice.vtu --join 1e-9 " + std::string(out));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, std::to_string(side) + " vertices were joined")) << out;
    const auto file = meshadapt::read_mesh_with_fields(folder_.path() / out);
    const AnyMesh& mesh = file.mesh;
    EXPECT_EQ(mesh.vertex_count(), twice.vertex_count() - side) << out;
    EXPECT_FALSE(contains(folder_.run("info " + std::string(out)).err, "not connected")) << out;
    for (const NamedField& field : file.fields)
      for (std::size_t i = 0; i < field.values.size(); ++i)
        EXPECT_EQ(field.values[i], field.name == "x"
                                       ? mesh.coordinates[i * static_cast<std::size_t>(dimension_)]
                                       : static_cast<double>(i))
            << out << field.name;
  }
  for (const char* wrong : {"-1", "x", "inf"})
    EXPECT_EQ(folder_.run("convert twice.vtu b.mesh --join " + std::string(wrong)).status, 2);
  EXPECT_TRUE(contains(folder_.run("convert twice.vtu b.sol --join 0").err, "option --join"));
  EXPECT_EQ(folder_.run("convert twice.vtu b.mesh --join 0.9").status, 2);
  EXPECT_FALSE(folder_.has("b.mesh"));
}

TEST_P(AdaptInputs, SaysWhichMetricAndBoundsAreInForce) {
  const AnyMesh mesh = grid(dimension_, 3);
  write("part.mesh", mesh);
  const std::vector<double> sizes(mesh.vertex_count(), 0.3);
  meshadapt::write_field(folder_.path() / "part.sol", meshadapt::scalar_field(dimension_, sizes));
  const Outcome found = folder_.run("adapt part.mesh -hmin 0.2 -hgrad 1.4 -o a.mesh");
  EXPECT_TRUE(
      contains(found.out, "metric: part.sol (found beside the mesh); -hmin 0.2, -hgrad 1.4\n"))
      << found.out;
  EXPECT_TRUE(contains(found.out, "the metric asks for about ")) << found.out;
  EXPECT_EQ(folder_.run("adapt part.mesh -v 0 -o a.mesh").out, "");
  const Outcome given = folder_.run("adapt part.mesh -sol part.sol -hausd 0.01 -o a.mesh");
  EXPECT_TRUE(contains(given.out, "metric: part.sol (given by -sol); -hausd 0.01, -ar 45\n"))
      << given.out;
  EXPECT_TRUE(contains(folder_.run("adapt part.mesh -hsiz 0.4 -o a.mesh").out,
                       "metric: the size of -hsiz everywhere; -hsiz 0.4\n"));
}

TEST_P(AdaptInputs, MakesTheMetricOfAFieldInOneCommand) {
  const AnyMesh mesh = grid(dimension_, 8);
  const auto at = [&](std::size_t v) { return mesh.coordinates[v * std::size_t(dimension_)]; };
  write("part.vtu", mesh,
        {field_of(mesh, "u", Place::vertices, [&](std::size_t v) { return at(v) * at(v); }),
         field_of(mesh, "p", Place::vertices, [](std::size_t v) { return double(v % 7); })});
  EXPECT_EQ(folder_.run("metric make part.vtu u --elements 800 -o u.sol").status, 0);
  EXPECT_EQ(folder_.run("adapt part.vtu -sol u.sol -o two.mesh").status, 0);
  const Outcome one =
      folder_.run("adapt part.vtu --solution u --elements 800 --field part.vtu -o one.mesh");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(folder_.read("one.mesh").substr(30), folder_.read("two.mesh").substr(30));
  EXPECT_TRUE(folder_.has("one.part.sol"));
  EXPECT_EQ(
      folder_.run("metric make part.vtu u --elements 800 --recovery projection -o u.sol").status,
      0);
  const std::string projected = "adapt part.vtu --solution u --elements 800 --recovery ";
  EXPECT_EQ(folder_.run("adapt part.vtu -sol u.sol -o two.mesh").status, 0);
  EXPECT_EQ(folder_.run(projected + "projection -o one.mesh").status, 0);
  EXPECT_EQ(folder_.read("one.mesh").substr(30), folder_.read("two.mesh").substr(30));
  EXPECT_EQ(folder_.run(projected + "guess -o no.mesh").status, 2);
  EXPECT_EQ(folder_.run("adapt part.vtu --recovery projection -o no.mesh").status, 2);
  for (const std::string words : {"metric make part.vtu part.vtu --elements 800 -o no.sol",
                                  "adapt part.vtu --solution part.vtu --elements 800 -o no.mesh"}) {
    const Outcome several = folder_.run(words);
    EXPECT_EQ(several.status, 2) << words;
    EXPECT_TRUE(contains(several.err, "2: u, p\n  name one of them")) << several.err;
  }
  EXPECT_TRUE(contains(folder_.run("metric make part.vtu w --error 1 -o no.sol").err,
                       "expected a field 'w' at its vertices, found u, p"));
  EXPECT_EQ(folder_.run("metric make part.vtu part.vtu u p --elements 800 -o up.sol").status, 0);
  EXPECT_EQ(folder_.run("adapt part.vtu --solution u -o no.mesh").status, 2);
}

TEST_P(AdaptInputs, OfViewsOfGmshTheWayOutIsNamed) {
  folder_.write("size.pos", "View \"size\" {\nSP(0,0,0){0.1};\n};\n");
  write("part.mesh", grid(dimension_, 2));
  for (const std::string words : {"info size.pos", "convert part.mesh out.pos"}) {
    const Outcome outcome = folder_.run(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "a .msh with")) << outcome.err;
  }
}

TEST_P(AdaptInputs, SizesOnElementsAreUsed) {
  const AnyMesh mesh = grid(dimension_, 4);
  const auto half = [](std::size_t) { return 0.5; };
  write("cells.vtu", mesh, {field_of(mesh, "metric", Place::elements, half)});
  write("size.vtu", mesh, {field_of(mesh, "h", Place::elements, half)});
  write("plain.mesh", mesh);
  EXPECT_EQ(folder_.run("adapt cells.vtu -o a.mesh").status, 0);
  EXPECT_EQ(folder_.run("adapt plain.mesh -sol size.vtu -o b.mesh").status, 0);
  for (const char* name : {"a.sol", "b.sol"})
    for (const double value : meshadapt::read_field(folder_.path() / name).values)
      EXPECT_NEAR(value, value > 1 ? 4 : 0, 1e-12);
}

TEST_P(AdaptInputs, RequestsThatCannotBeNumberedAreRefusedInOneLine) {
  // Needles so thin that the integral of the density is no estimate of the number of elements.
  for (const double thin : {1e-3, 1e-9, 1e-12}) {
    AnyMesh mesh = grid(dimension_, 1);
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
      if (i % std::size_t(dimension_) != 0) mesh.coordinates[i] *= thin;
    write("needle.mesh", mesh);
    const Outcome outcome = folder_.run("adapt needle.mesh -hsiz 1e-11 -o no.mesh");
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "32-bit numbers count at most 4,294,967,294")) << outcome.err;
    EXPECT_TRUE(tells_one_error(outcome.err)) << outcome.err;
    EXPECT_FALSE(folder_.has("no.mesh"));
  }
}

TEST_P(AdaptInputs, WholeNumbersOnElementsAreCarriedByValueAndStayWhole) {
  const AnyMesh mesh = grid(dimension_, 4);
  NamedField marks = field_of(mesh, "marks", Place::elements,
                              [](std::size_t i) { return double(1000003 * (i % 5)) - 7; });
  marks.whole = true;
  for (const std::string ending : {"vtu", "vtk"}) {
    write("old." + ending, mesh, {marks});
    write("new.mesh", grid(dimension_, 7));
    const Outcome outcome = folder_.run("transfer old." + ending + " new.mesh -o out." + ending);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto found = meshadapt::read_mesh_with_fields(folder_.path() / ("out." + ending));
    ASSERT_EQ(found.fields.size(), 1U);
    EXPECT_TRUE(found.fields[0].whole) << ending;
    for (const double value : found.fields[0].values)
      EXPECT_NE(std::find(marks.values.begin(), marks.values.end(), value), marks.values.end());
  }
}

TEST_P(AdaptInputs, ASizeAtAnUnusedVertexDoesNotMatter) {
  AnyMesh mesh = grid(dimension_, 3);
  for (int i = 0; i < dimension_; ++i) mesh.coordinates.push_back(5);
  mesh.vertex_reference.push_back(0);
  for (const double none : {std::numeric_limits<double>::quiet_NaN(), 0.0, -1.0}) {
    std::vector<double> sizes(mesh.vertex_count(), 0.3);
    sizes.back() = none;
    const AnyField metric = meshadapt::metric_of(meshadapt::scalar_field(dimension_, sizes), mesh);
    EXPECT_EQ(metric.values.back(), metric.values[std::size_t(dimension_ == 2 ? 2 : 5)]);
    sizes.back() = 0.3;
    sizes.front() = none;
    EXPECT_THROW(meshadapt::metric_of(meshadapt::scalar_field(dimension_, sizes), mesh),
                 meshadapt::InputError);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, AdaptInputs, testing::Values(2, 3),
                         [](const auto& tested) { return std::to_string(tested.param) + "D"; });

}  // namespace
}  // namespace ductile::cli::adapt_inputs_test
