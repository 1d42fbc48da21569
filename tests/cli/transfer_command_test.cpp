/// @file
/// `ductile transfer` on random meshes and fields: its output equals the library's result, and
/// meshes of different domains are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "program.hpp"
#include "support/meshes.hpp"

namespace ductile::cli::transfer_command_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Carrying;
using meshadapt::NamedField;
namespace test = meshadapt::test;
using test::Random;
using test::uniform;
using Type = AnyField::Type;
using Place = NamedField::Place;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

NamedField random_field(Random& random, const AnyMesh& mesh, const std::string& name, Place place,
                        Type type = Type::scalar) {
  NamedField field{name, type, {}, place};
  const std::size_t count = place == Place::vertices ? mesh.vertex_count() : element_count(mesh);
  for (std::size_t i = 0;
       i < count * static_cast<std::size_t>(component_count(type, mesh.dimension)); ++i)
    field.values.push_back(uniform(random, -1, 2));
  return field;
}

AnyMesh random_mesh(Random& random, int dimension, int n) {
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension, n));
  test::jiggle(mesh, random, 0.3);
  return mesh;
}

/// Writes two meshes of the unit square or cube, and fields on the first, in many formats.
class Case {
 public:
  explicit Case(std::uint64_t seed) : random_(seed) {
    const int dimension = seed % 2 == 0 ? 2 : 3;
    from_ = random_mesh(random_, dimension, dimension == 2 ? 5 : 2);
    to_ = random_mesh(random_, dimension, dimension == 2 ? 7 : 3);
    fields_ = {random_field(random_, from_, "u", Place::vertices),
               random_field(random_, from_, "k", Place::elements),
               random_field(random_, from_, "velocity", Place::vertices, Type::vector),
               random_field(random_, from_, "stress", Place::elements, Type::symmetric)};
    for (const char* name : {"old.vtu", "old.msh"})
      write_mesh(at(name), from_, {.fields = fields_});
    const NamedField own[] = {random_field(random_, to_, "own", Place::vertices),
                              random_field(random_, to_, "u", Place::vertices)};
    for (const char* name : {"old.mesh", "new.mesh", "new.meshb"})
      write_mesh(at(name), name[0] == 'o' ? from_ : to_);
    write_mesh(at("new.vtk"), to_, {.fields = own});
    meshadapt::write_field(at("u.sol"),
                           {dimension, from_.vertex_count(), {Type::scalar}, values("u"), ""});
  }

  std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }
  const Folder& folder() const { return folder_; }
  const std::vector<double>& values(const std::string& name) const {
    return std::find_if(fields_.begin(), fields_.end(),
                        [&](const auto& f) { return f.name == name; })
        ->values;
  }

  void expect_done(const std::string& words) const {
    const Outcome outcome = folder_.run("transfer --threads 1 " + words);
    EXPECT_EQ(outcome.status, 0) << words << "\n" << outcome.err;
    EXPECT_EQ(outcome.err, "") << words;
  }

  /// Expects the library's result under the given names, and no other fields except `own`.
  void expect_fields(const std::string& file, const std::vector<std::string>& names,
                     const std::vector<Carrying>& how, std::size_t own = 0) const {
    SCOPED_TRACE(file);
    const auto expected =
        transfer_fields(runtime::Executor({.threads = 1}), {from_, fields_}, to_, how);
    const auto found = meshadapt::read_mesh_with_fields(at(file));
    EXPECT_EQ(found.mesh.vertex_count(), to_.vertex_count());
    EXPECT_EQ(found.fields.size(), names.size() + own);
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const auto here = std::find_if(found.fields.begin(), found.fields.end(),
                                     [&](const auto& g) { return g.name == fields_[f].name; });
      const bool wanted = std::find(names.begin(), names.end(), fields_[f].name) != names.end();
      ASSERT_EQ(here != found.fields.end(), wanted) << fields_[f].name;
      if (!wanted) continue;
      EXPECT_EQ(here->type, fields_[f].type);
      EXPECT_EQ(here->place, fields_[f].place);
      EXPECT_TRUE(here->values == expected.fields[f].values) << fields_[f].name;
    }
  }

 private:
  Folder folder_;
  Random random_;
  AnyMesh from_, to_;
  std::vector<NamedField> fields_;
};

TEST(TransferCommand, WritesWhatTheLibraryCarries) {
  constexpr auto mean = Carrying::conservatively, value = Carrying::by_value;
  const std::vector<std::string> all{"u", "k", "velocity", "stress"};
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const Case trial(seed);
    trial.expect_done("old.vtu new.mesh");
    trial.expect_fields("new.o.vtu", all, {mean});
    trial.expect_done("old.vtu new.mesh -o again.vtu --threads 3");
    EXPECT_TRUE(trial.folder().read("again.vtu") == trial.folder().read("new.o.vtu"));
    trial.expect_done("old.msh new.vtk --interpolate");
    trial.expect_fields("new.o.vtk", all, {value}, 1);  // beside one of its own
    trial.expect_done("old.vtu k velocity new.mesh --by-value k -o some.vtu");
    trial.expect_fields("some.vtu", {"k", "velocity"}, {value, value, mean, value});
    trial.expect_done("old.mesh old.vtu new.mesh -v 0 -o given.vtu");
    trial.expect_fields("given.vtu", all, {mean});
    trial.expect_done("old.mesh u.sol new.meshb");
    trial.expect_done("old.vtu u new.meshb -o v.sol");
    trial.expect_done("old.mesh u.sol new.vtk -o alone.vtu");
    const auto carried = meshadapt::read_mesh_with_fields(trial.at("some.vtu"));
    const auto alone = meshadapt::read_field(trial.at("new.u.solb"));
    EXPECT_TRUE(alone.values == meshadapt::read_field(trial.at("v.sol")).values);
    EXPECT_TRUE(alone.values ==
                meshadapt::read_mesh_with_fields(trial.at("new.o.vtu")).fields.front().values);
    trial.expect_fields("alone.vtu", {"u"}, {mean}, 1);
  }
}

TEST(TransferCommand, SaysWhatDoesNotFit) {
  const Case plane(0), space(1);
  const Folder& folder = plane.folder();
  for (const char* name : {"old.mesh", "old.vtu", "u.sol"})
    std::filesystem::copy_file(space.at(name), plane.at("space_" + std::string(name)));
  folder.write("inf.vtk",
               "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n"
               "0 0 0 1 0 0 0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\nCELL_DATA 1\n"
               "SCALARS k double 1\nLOOKUP_TABLE default\ninf\n");
  const std::size_t files = folder.file_count();
  const struct {
    const char *words, *part;
  } wrong[] = {
      {"old.mesh", "expected OLD, maybe fields, and NEW, found 1 file"},
      {"old.mesh new.mesh -o a.vtu",
       "old.mesh: expected fields, found none\n  give a file of them"},
      {"old.vtu p new.mesh", "old.vtu: expected a field 'p', found u, velocity, k, stress"},
      {"old.mesh space_u.sol new.mesh", "space_u.sol: expected "},
      {"old.mesh space_old.vtu new.mesh",
       "space_old.vtu: expected fields of dimension 2, that of old.mesh, found 3"},
      {"space_old.vtu new.mesh",
       "new.mesh: expected a mesh of dimension 3, that of space_old.vtu, found 2"},
      {"new.vtk old.vtu new.mesh", "old.vtu: expected 64 values in 'u', one for each vertex of"},
      {"new.mesh u.sol old.mesh", "u.sol: expected 64 values, "},
      {"old.vtu u old.vtu new.mesh", "two fields are called 'u'"},
      {"old.vtu k new.mesh -o a.sol", "a.sol: holds fields at vertices only, not k on elements"},
      {"old.vtu new.mesh --by-value p", "option --by-value: expected one of u, velocity, k"},
      {"old.vtu new.mesh -o a.stl", "option -o: expected a name ending in .sol"},
      {"old.vtu new.mesh -o old.vtu", "old.vtu: is read, and would be replaced"},
      {"old.mesh u.sol new.mesh -o u.sol", "u.sol: is read, and would be replaced"},
      {"old.mesh u.sol u.sol new.mesh", "expected -o"},
      {"- - -o a.vtu", "expected one mesh from standard input"},
      {"old.vtu - < new.mesh", "expected -o, because NEW is read from standard input"},
      {"inf.vtk inf.vtk", "field \"k\": expected finite numbers, found inf at element 1"},
      {"none.vtu new.mesh", "none.vtu: "}};
  for (const auto& [words, part] : wrong) {
    const Outcome outcome = folder.run("transfer " + std::string(words));
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, part)) << words << ": " << outcome.err;
    EXPECT_TRUE(tells_one_error(outcome.err)) << outcome.err;
  }
  EXPECT_EQ(folder.file_count(), files);
  const Outcome some = folder.run("transfer old.vtu new.mesh -o a.sol");
  EXPECT_EQ(some.status, 0) << some.err;
  EXPECT_TRUE(contains(some.err, "not k, stress on elements; a .vtu takes both")) << some.err;
  EXPECT_TRUE(contains(folder.run("transfer old.vtu - -o -.vtk < new.mesh").out, "CELL_DATA"));
}

/// Two meshes whose domains may be changed to differ.
struct Domains {
  AnyMesh from, to;
};

/// The program's exit status, and its message for each way of transfer.
struct End {
  int status;
  std::string conservatively, by_value;
};

template <class Change>
void expect_transfer(const End& end, Domains domains, const Change& change) {
  change(domains);
  const Folder folder;
  const NamedField field{"u", Type::scalar, std::vector<double>(domains.from.vertex_count(), 0.7)};
  write_mesh(folder.path() / "old.vtu", domains.from, {.fields = {&field, 1}});
  write_mesh(folder.path() / "new.mesh", domains.to);
  for (const std::string way : {"", " --interpolate"}) {
    const Outcome outcome = folder.run("transfer --threads 1 old.vtu new.mesh" + way);
    const std::string& said = way.empty() ? end.conservatively : end.by_value;
    EXPECT_EQ(outcome.status, end.status) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, said)) << outcome.err;
    EXPECT_EQ(outcome.err.empty(), said.empty()) << outcome.err;
    const Outcome extended = folder.run("transfer --threads 1 old.vtu new.mesh --extend" + way);
    EXPECT_EQ(extended.status, 0) << extended.err;
    const auto written = meshadapt::read_mesh_with_fields(folder.path() / "new.o.vtu");
    for (const double value : written.fields.at(0).values) EXPECT_NEAR(value, 0.7, 1e-12);
  }
}

TEST(TransferCommand, RefusesMeshesThatStickOut) {
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int dimension = seed % 2 == 0 ? 2 : 3;
    const Domains same{random_mesh(random, dimension, 3), random_mesh(random, dimension, 4)};
    const double small = uniform(random, 1e-12, 1e-9), large = uniform(random, 0.2, 3);
    const auto shift = [&](double by) {
      return [&, by](Domains& domains) {
        for (std::size_t i = 0; i < domains.to.coordinates.size();
             i += static_cast<std::size_t>(dimension))
          domains.to.coordinates[i] += by;
      };
    };
    expect_transfer({0, "", ""}, same, shift(small));
    const std::string refused =
        " outside of old.vtu\n  give a mesh of the same domain, or --extend";
    expect_transfer({2, refused, refused}, same, shift(large));
    // The new mesh covers a part of the old domain: the loss is reported only if integrals are to
    // be kept.
    expect_transfer({0, "; integrals lose what is there", ""}, same, [&](Domains& domains) {
      for (double& x : domains.to.coordinates) x = 0.1 + 0.7 * x;
    });
    // The old domain has a hole that the new one fills with elements.
    const std::string share = dimension == 2 ? " % of its area lies" : " % of its volume lies";
    expect_transfer({2, share, share}, same, [&](Domains& domains) {
      test::Grid grid = test::unit_grid(dimension, 3);
      grid.region = test::with_hole(3);
      domains.from = test::make_grid(grid);
      domains.to = test::make_grid(test::unit_grid(dimension, 1));
    });
    // Two meshes of one curved domain.
    const std::string beyond = " is not in old.vtu; values there are the closest ones";
    expect_transfer({0, beyond, beyond}, same, [&](Domains& domains) {
      domains.from = test::make_grid(test::unit_grid(dimension, dimension == 2 ? 30 : 6));
      domains.to = test::make_grid(test::unit_grid(dimension, dimension == 2 ? 17 : 5));
      for (AnyMesh* mesh : {&domains.from, &domains.to}) test::bend(*mesh, 1.2);
    });
  }
}

}  // namespace
}  // namespace ductile::cli::transfer_command_test
