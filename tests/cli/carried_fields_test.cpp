#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "program.hpp"

namespace ductile::cli::carried_fields_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Writes a field at the vertices of waves2d.mesh: one of their coordinates, or both.
void add_field(const Folder& folder, const std::string& name, std::size_t first,
               std::size_t count) {
  using meshadapt::AnyField;
  const auto mesh = meshadapt::read_mesh(folder.path() / "waves2d.mesh");
  AnyField field{2, mesh.vertex_count(), {}, {}, ""};
  field.types = {count == 1 ? AnyField::Type::scalar : AnyField::Type::vector};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    for (std::size_t i = 0; i < count; ++i) {
      const double x = mesh.coordinates[2 * v + (first + i) % 2];
      field.values.push_back(x * x * static_cast<double>(first + 1));
    }
  std::filesystem::create_directories((folder.path() / name).parent_path());
  meshadapt::write_field(folder.path() / name, field);
}

TEST(CarriedFields, GoEachIntoAFileOfItsOwnAsIfItWereAlone) {
  const Folder folder;
  folder.add_example("waves2d");
  add_field(folder, "u.sol", 0, 1);
  add_field(folder, "velocity.solb", 0, 2);
  add_field(folder, "deep/p.sol", 1, 1);
  for (const std::string& way : {std::string(), std::string(" --interpolate")}) {
    const std::string adapt = "adapt waves2d.mesh -hmin 0.05" + way;
    const Outcome all = folder.run(
        adapt +
        " -o all.mesh --vtu all.vtu --field u.sol --field velocity.solb --field deep/p.sol");
    ASSERT_EQ(all.status, 0) << all.err;
    EXPECT_TRUE(contains(all.out, "all.u.sol, all.velocity.sol, all.p.sol")) << all.out;
    for (const char* name : {"u", "velocity", "p"})
      EXPECT_TRUE(contains(folder.read("all.vtu"), "Name=\"" + std::string(name) + "\"")) << name;
    for (const auto& [name, file] :
         {std::pair{"u", "u.sol"}, std::pair{"velocity", "velocity.solb"},
          std::pair{"p", "deep/p.sol"}}) {
      ASSERT_EQ(folder.run(adapt + " -o one.mesh --field " + file).status, 0);
      EXPECT_EQ(folder.read("all." + std::string(name) + ".sol"),
                folder.read("one." + std::string(name) + ".sol"))
          << name << way;
    }
  }
}

/// The file of an adapted mesh may hold solutions beside its metric.
TEST(CarriedFields, KeepTheirNamesAndLeaveTheMetricOut) {
  using meshadapt::NamedField;
  const Folder folder;
  const auto mesh = meshadapt::box_mesh<2>({1, 1}, {6, 6});
  std::vector<double> u, v, metric(mesh.vertex_count(), 0.2);
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const double x = mesh.coordinates[2 * i], y = mesh.coordinates[2 * i + 1];
    u.push_back(x * x);
    v.insert(v.end(), {x * y, y * y});
    metric[i] += y * y;
  }
  const NamedField heat{"heat", meshadapt::AnyField::Type::scalar, u},
      flow{"flow", meshadapt::AnyField::Type::vector, v},
      sizes{"metric", meshadapt::AnyField::Type::scalar, metric};
  const std::vector<NamedField> all = {heat, sizes, flow}, solutions = {heat, flow};
  meshadapt::write_mesh(folder.path() / "a.vtu", mesh, {.fields = all});
  meshadapt::write_mesh(folder.path() / "b.vtu", mesh, {.fields = solutions});
  ASSERT_EQ(folder.run("adapt a.vtu --field a.vtu --field b.vtu -o c.vtu").status, 0);
  std::vector<std::string> names;
  for (const auto& field : meshadapt::read_mesh_with_fields(folder.path() / "c.vtu").fields)
    names.push_back(field.name);
  EXPECT_EQ(names, (std::vector<std::string>{"metric", "heat", "flow", "b_heat", "b_flow"}));
  for (const char* file : {"a", "b"})
    ASSERT_EQ(folder
                  .run(std::string("metric make b.vtu ") + file +
                       ".vtu heat flow --elements 200 -o " + file + ".sol")
                  .status,
              0);
  EXPECT_EQ(folder.read("a.sol"), folder.read("b.sol"));
}

TEST(CarriedFields, AreRefusedBeforeTheWorkWhereNamesCollide) {
  const Folder folder;
  folder.add_example("waves2d");
  add_field(folder, "u.sol", 0, 1);
  add_field(folder, "deep/u.sol", 1, 1);
  const std::size_t files = folder.file_count();
  for (const std::string words : {"--field u.sol --field deep/u.sol", "--field u.sol --field u.sol",
                                  "--field u.sol --field u.solb"}) {
    const Outcome outcome = folder.run("adapt waves2d.mesh " + words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "would both be written to waves2d.o.u.sol")) << outcome.err;
  }
  EXPECT_EQ(folder.run("adapt waves2d.mesh -o u.mesh --field u.sol --no-metric").status, 0);
  const Outcome missing = folder.run("adapt waves2d.mesh --field u.sol --field none.sol");
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(contains(missing.err, "none.sol: ")) << missing.err;
  EXPECT_EQ(folder.file_count(), files + 2);  // u.mesh and u.u.sol
}

}  // namespace
}  // namespace ductile::cli::carried_fields_test
