/// @file
/// Level sets of `ductile adapt`: -ls, and what goes with it.
#include "level_set_option.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "program.hpp"
#include "support/trials.hpp"

namespace ductile::cli::level_set_option_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::NamedField;
using Point = std::array<double, 3>;
using Function = std::function<double(const Point&)>;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Point position(const AnyMesh& mesh, std::size_t vertex) {
  Point p{};
  const auto d = static_cast<std::size_t>(mesh.dimension);
  std::copy_n(&mesh.coordinates[vertex * d], d, p.begin());
  return p;
}

const auto& references(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
}

double volume_of(const AnyMesh& mesh, std::size_t element) {
  std::array<Point, 4> p;
  if (mesh.dimension == 2) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = position(mesh, mesh.triangles.vertices[element][i]);
    return ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) /
           2;
  }
  for (std::size_t i = 0; i < 4; ++i) p[i] = position(mesh, mesh.tetrahedra.vertices[element][i]);
  std::array<Point, 3> e;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) e[i][k] = p[i + 1][k] - p[0][k];
  return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
          e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
         6;
}

std::map<int, double> volume_by_reference(const AnyMesh& mesh) {
  std::map<int, double> volume;
  for (std::size_t e = 0; e < references(mesh).size(); ++e)
    volume[references(mesh)[e]] += volume_of(mesh, e);
  return volume;
}

/// Facets with a reference: how many, and the largest |function| at their corners.
std::pair<std::size_t, double> facets_on(const AnyMesh& mesh, int reference,
                                         const Function& function) {
  std::size_t count = 0;
  double most = 0;
  const auto look = [&](const auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (facets.reference[f] != reference) continue;
      ++count;
      for (const std::uint32_t v : facets.vertices[f])
        most = std::max(most, std::abs(function(position(mesh, v))));
    }
  };
  mesh.dimension == 2 ? look(mesh.edges) : look(mesh.triangles);
  return {count, most};
}

/// In each dimension, a box in which elements right of the middle have reference 2, and a ball.
class LevelSetOption : public testing::TestWithParam<int> {
 protected:
  LevelSetOption() {
    if (dimension_ == 2)
      mesh_ = meshadapt::box_mesh<2>({1, 1}, {16, 16});
    else
      mesh_ = meshadapt::box_mesh<3>({1, 1, 1}, {8, 8, 8});
    write("m.mesh", mesh_);
    write_values("phi.sol", ball_);
  }

  void write(const std::string& name, const AnyMesh& mesh,
             const std::vector<NamedField>& fields = {}) const {
    meshadapt::write_mesh(folder_.path() / name, mesh, {.fields = fields});
  }

  std::vector<double> values(const Function& function) const {
    std::vector<double> values;
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v)
      values.push_back(function(position(mesh_, v)));
    return values;
  }

  void write_values(const std::string& name, const Function& function) const {
    meshadapt::write_field(
        folder_.path() / name,
        {dimension_, mesh_.vertex_count(), {AnyField::Type::scalar}, values(function), ""});
  }

  AnyMesh run(const std::string& words) const {
    const Outcome outcome = folder_.run("adapt m.mesh -o o.mesh " + words);
    EXPECT_EQ(outcome.status, 0) << words << ": " << outcome.err;
    said_ = outcome.out;
    warned_ = outcome.err;
    EXPECT_EQ(folder_.run("info o.mesh").status, 0) << words;
    return meshadapt::read_mesh(folder_.path() / "o.mesh");
  }

  /// Expects exit status 2 and one line on standard error that contains a text, and no output.
  void expect_refused(const std::string& words, const std::string& why) const {
    std::filesystem::remove(folder_.path() / "no.mesh");
    const Outcome outcome = folder_.run("adapt m.mesh -o no.mesh " + words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, why)) << words << ": " << outcome.err;
    EXPECT_TRUE(tells_one_error(outcome.err)) << outcome.err;
    EXPECT_FALSE(folder_.has("no.mesh")) << words;
  }

  double ball_volume(double radius) const {
    return dimension_ == 2 ? std::numbers::pi * radius * radius
                           : 4 * std::numbers::pi / 3 * radius * radius * radius;
  }

  std::string size() const {
    return dimension_ == 2 ? "-hsiz 0.06 -hausd 0.001 " : "-hsiz 0.12 -hausd 0.008 ";
  }

  const int dimension_ = GetParam();
  const Folder folder_;
  AnyMesh mesh_;
  const Function ball_ = [this](const Point& p) {
    const double z = dimension_ == 2 ? 0 : p[2] - 0.5;
    return std::hypot(p[0] - 0.5, p[1] - 0.5, z) - 0.3;
  };
  mutable std::string said_, warned_;
};

TEST_P(LevelSetOption, CutsAndAdaptsToTheSurface) {
  for (const double level : {-0.05, 0.0, 0.05}) {
    const AnyMesh found = run("-ls " + std::to_string(level) + " -sol phi.sol " + size());
    const auto volume = volume_by_reference(found);
    ASSERT_EQ(volume.size(), 2U);
    EXPECT_NEAR(volume.at(3) / ball_volume(0.3 + level), 1, dimension_ == 2 ? 0.02 : 0.15);
    EXPECT_NEAR(volume.at(3) + volume.at(2), 1, 1e-9);
    const auto [count, most] =
        facets_on(found, 10, [&](const Point& p) { return ball_(p) - level; });
    EXPECT_GT(count, 10U);
    EXPECT_LT(most, dimension_ == 2 ? 0.003 : 0.02);
    EXPECT_TRUE(contains(said_, "m.mesh: cut where phi.sol is ")) << said_;
    EXPECT_TRUE(contains(said_, "references below: 3 (")) << said_;
    EXPECT_EQ(warned_, "");
  }
}

/// The words "-noinsert -noswap -nomove" leave the mesh as it was cut.
TEST_P(LevelSetOption, ChangesNothingElseIfNoKernelRuns) {
  const AnyMesh found = run("-ls -noinsert -noswap -nomove -hsiz 1 -sol phi.sol");
  std::size_t there = 0;
  std::set<Point> places;
  for (std::size_t v = 0; v < found.vertex_count(); ++v) places.insert(position(found, v));
  for (std::size_t v = 0; v < mesh_.vertex_count(); ++v)
    there += places.contains(position(mesh_, v)) ? 1 : 0;
  EXPECT_GT(there, mesh_.vertex_count() * 3 / 4);
  EXPECT_GT(found.vertex_count(), mesh_.vertex_count());
  EXPECT_EQ(warned_, "");
}

/// The level set is given by -sol as a file or a field of the mesh's file; without -sol it is
/// beside the mesh or in it.
TEST_P(LevelSetOption, IsFoundWhereAMetricIsFound) {
  run("-ls -sol phi.sol " + size());
  const std::string right = folder_.read("o.mesh");
  std::filesystem::copy(folder_.path() / "phi.sol", folder_.path() / "m.sol");
  run("-ls " + size());
  EXPECT_EQ(folder_.read("o.mesh"), right);
  std::filesystem::remove(folder_.path() / "m.sol");
  const NamedField phi{"phi", AnyField::Type::scalar, values(ball_)};
  const NamedField metric{"metric", AnyField::Type::scalar, values([](auto&) { return 0.3; })};
  write("one.vtu", mesh_, {phi, metric});
  for (const char* words : {"one.vtu", "one.vtu -sol phi", "one.vtu -sol phi.sol"}) {
    const Outcome outcome = folder_.run("adapt -ls " + size() + "-o o.mesh " + words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(folder_.read("o.mesh"), right) << words;
  }
  write("two.vtu", mesh_, {phi, {"psi", AnyField::Type::scalar, values(ball_)}});
  EXPECT_EQ(folder_.run("adapt -ls -sol phi -o o.mesh two.vtu " + size()).status, 0);
  const Outcome which = folder_.run("adapt -ls -o o.mesh two.vtu");
  EXPECT_EQ(which.status, 2);
  EXPECT_TRUE(contains(which.err, "found phi, psi\n  give a file or a field")) << which.err;
}

/// A metric of the mesh before is carried to the cut mesh; sizes by places may name the interface.
TEST_P(LevelSetOption, TakesAMetricAndSizesByPlaces) {
  write_values("size.sol", [](const Point& p) { return p[0] < 0.5 ? 0.05 : 0.2; });
  const AnyMesh found = run("-ls -sol phi.sol -met size.sol -hausd 0.01");
  EXPECT_TRUE(contains(said_, "metric: size.sol (given by -met)")) << said_;
  std::array<std::size_t, 2> on_side{};
  for (std::size_t v = 0; v < found.vertex_count(); ++v)
    ++on_side[position(found, v)[0] < 0.5 ? 0 : 1];
  EXPECT_GT(on_side[0], 2 * on_side[1]);
  const AnyMesh plain = run("-ls -sol phi.sol -hsiz 0.2 -hausd 0.02");
  const AnyMesh fine = run("-ls -sol phi.sol -hsiz 0.2 --on 10:0.05 -hausd 0.02");
  EXPECT_GT(facets_on(fine, 10, ball_).first, 2 * facets_on(plain, 10, ball_).first);
}

/// A level that is met nowhere gives one side, and a warning.
TEST_P(LevelSetOption, AdaptsAMeshThatTheLevelDoesNotMeet) {
  for (const auto& [level, reference] : {std::pair{"9", 3}, std::pair{"-9", 2}}) {
    const AnyMesh found = run("-ls " + std::string(level) + " -sol phi.sol " + size());
    EXPECT_TRUE(contains(warned_, "is met nowhere")) << warned_;
    EXPECT_EQ(volume_by_reference(found).size(), 1U);
    EXPECT_NEAR(volume_by_reference(found)[reference], 1, 1e-9);
  }
}

TEST_P(LevelSetOption, RemovesSmallComponentsAndKeepsAVolume) {
  const Function two = [](const Point& p) {  // a bar, and a bubble of one vertex
    const double bar = std::abs(p[0] - 0.25) - 0.15;
    return std::min(bar, std::hypot(p[0] - 0.75, p[1] - 0.5, p[2]) - 0.04);
  };
  write_values("two.sol", two);
  const double both = volume_by_reference(run("-ls -sol two.sol -noinsert -noswap -nomove"))[3];
  const double one =
      volume_by_reference(run("-ls -sol two.sol -rmc 0.01 -noinsert -noswap -nomove"))[3];
  EXPECT_LT(one, both - 1e-6);
  EXPECT_TRUE(contains(said_, "1 small component removed")) << said_;
  EXPECT_EQ(volume_by_reference(run("-ls -sol two.sol -rmc -noinsert -noswap -nomove"))[3], both);
  const double kept =
      volume_by_reference(run("-ls -sol phi.sol --keep-volume 0.2 -noinsert -noswap -nomove"))[3];
  EXPECT_NEAR(kept, 0.2, 1e-5);
}

TEST_P(LevelSetOption, SplitsMaterialsByTheTableOfMmg) {
  auto mesh = mesh_;
  auto& reference = dimension_ == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
  for (std::size_t e = 0; e < reference.size(); ++e) {
    double x = 0;
    const auto add = [&](const auto& corners) {
      for (const std::uint32_t v : corners)
        x += position(mesh, v)[0] / static_cast<double>(corners.size());
    };
    dimension_ == 2 ? add(mesh.triangles.vertices[e]) : add(mesh.tetrahedra.vertices[e]);
    reference[e] = x < 0.5 ? 1 : x < 0.75 ? 2 : 4;
  }
  write("m.mesh", mesh);
  const std::string file = dimension_ == 2 ? "m.mmg2d" : "m.mmg3d";
  folder_.write(file, "LSReferences 3\n1 11 12\n2 21 22\n4 nosplit\nParameters 0\n");
  const AnyMesh found = run("-ls -sol phi.sol -isoref 77 " + size());
  const auto volume = volume_by_reference(found);
  std::vector<int> all;
  for (const auto& [name, size] : volume) all.push_back(name);
  EXPECT_EQ(all, (std::vector<int>{4, 11, 12, 21, 22}));
  EXPECT_NEAR(volume.at(11) + volume.at(12), 0.5, 1e-9);
  EXPECT_NEAR(volume.at(21) + volume.at(22), 0.25, 1e-9);
  EXPECT_GT(facets_on(found, 77, ball_).first, 10U);
  EXPECT_TRUE(contains(said_, "references below: 11, 21 (")) << said_;
  folder_.write(file, "LSReferences 1\n1 11 12\n");
  expect_refused("-ls -sol phi.sol " + size(),
                 "has the reference 2, which is not in the table of materials");
}

/// Fields are on the mesh before the cut; their integrals stay.
TEST_P(LevelSetOption, CarriesFieldsFromTheMeshBefore) {
  write_values("u.sol", [](const Point& p) { return 1 + p[0] + 2 * p[1]; });
  const AnyMesh found = run("-ls -sol phi.sol --field u.sol " + size());
  const AnyField u = meshadapt::read_field(folder_.path() / "o.u.sol");
  double integral = 0;
  const auto add = [&](const auto& elements) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (const std::uint32_t v : elements.vertices[e])
        integral += volume_of(found, e) * u.values[v] / (dimension_ + 1);
  };
  dimension_ == 2 ? add(found.triangles) : add(found.tetrahedra);
  EXPECT_NEAR(integral, 2.5, 1e-9);
}

TEST_P(LevelSetOption, DoesNotDependOnThreads) {
  if (meshadapt::test::address_sanitized) GTEST_SKIP() << meshadapt::test::compares_threads;
  run("-ls -sol phi.sol --threads 1 --json 1.json " + size());
  const std::string right = folder_.read("o.mesh"), metric = folder_.read("o.sol");
  EXPECT_TRUE(contains(folder_.read("1.json"), "\"cut\": {\"where\": \"phi.sol is 0\""));
  for (const char* threads : {"2", "3", "8"}) {
    run(std::string("-ls -sol phi.sol --threads ") + threads + " " + size());
    EXPECT_EQ(folder_.read("o.mesh"), right) << threads;
    EXPECT_EQ(folder_.read("o.sol"), metric) << threads;
  }
}

/// Random waves, steep and flat, with kinks and with values of exactly 0 at vertices.
TEST_P(LevelSetOption, CutsRandomFunctions) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < (dimension_ == 2 ? 12 : 6); ++i) {
    const double a = uniform(3, 14), b = uniform(3, 14), c = uniform(-0.5, 0.5), s = uniform(0, 6);
    const double rounded = i % 3 == 0 ? 8 : 1e9;
    write_values("w.sol", [&](const Point& p) {
      double f = std::sin(a * p[0] + s) + std::cos(b * p[1] - p[2] * a) - c;
      if (i % 4 == 1) f = std::abs(f) - 0.3;
      return std::round(f * rounded) / rounded;
    });
    const AnyMesh found = run("-ls -sol w.sol -rmc 1e-4 " + size());
    double all = 0;
    for (const auto& [reference, volume] : volume_by_reference(found)) {
      EXPECT_TRUE(reference == 2 || reference == 3) << reference;
      all += volume;
    }
    EXPECT_NEAR(all, 1, 1e-9);
  }
}

/// The boundary of a box, alone and with its tetrahedra: the same triangles on each side.
TEST_P(LevelSetOption, CutsSurfaces) {
  if (dimension_ == 2) return;
  write_values("x.sol", [](const Point& p) { return p[0] + 0.3 * p[1] - 0.6; });
  const AnyMesh solid = run("-lssurf 0.05 -sol x.sol -noinsert -noswap -nomove");
  EXPECT_TRUE(contains(said_, "vertices moved onto the curve"));
  EXPECT_EQ(volume_by_reference(solid).size(), volume_by_reference(mesh_).size());
  AnyMesh surface = mesh_;
  surface.tetrahedra = {};
  write("m.mesh", surface);
  const AnyMesh alone = run("-ls 0.05 -sol x.sol -noinsert -noswap -nomove");
  EXPECT_EQ(alone.triangles.reference.size(), solid.triangles.reference.size());
  EXPECT_EQ(std::set(alone.triangles.reference.begin(), alone.triangles.reference.end()),
            (std::set<std::int32_t>{2, 3}));
  for (const std::string words : {"-ls 0.05 -sol x.sol -hausd 0.01 ", "-ls -sol x.sol "}) {
    const AnyMesh fine = run(words + size());
    EXPECT_GT(fine.triangles.size(), alone.triangles.size());
    EXPECT_GT(std::ranges::count(fine.edges.reference, 10), 10);
  }
}

TEST_P(LevelSetOption, RefusesInOneLine) {
  write_values("short.sol", ball_);
  const Function bad = [](const Point& p) { return p[0] > 0.9 ? std::nan("") : p[0]; };
  auto half = values(ball_);
  half.resize(half.size() / 2);
  meshadapt::write_field(folder_.path() / "short.sol",
                         {dimension_, half.size(), {AnyField::Type::scalar}, half, ""});
  auto vectors = values(ball_);
  vectors.resize(vectors.size() * static_cast<std::size_t>(dimension_));
  meshadapt::write_field(folder_.path() / "vector.sol",
                         {dimension_, mesh_.vertex_count(), {AnyField::Type::vector}, vectors, ""});
  folder_.write("bad.mmg2d", "LSReferences 2\n1 2 3\n1 nosplit\n");
  folder_.write("worse.mmg2d", "LSReferences 1\n1 split\n");
  expect_refused("-ls", "m.mesh: expected the values of the level set, found none");
  expect_refused("-ls -sol none.sol", "none.sol");
  expect_refused("-ls -sol short.sol", "short.sol: expected");
  expect_refused("-ls -sol vector.sol", "expected one number at each vertex");
  expect_refused("-ls -sol phi.sol -rmc 2", "option -rmc: expected a fraction");
  expect_refused("-ls -sol phi.sol -isoref x", "option -isoref: expected a whole number");
  expect_refused("-ls -sol phi.sol --keep-volume -1", "option --keep-volume: expected");
  expect_refused("-ls -sol phi.sol --keep-volume 7", "keep_volume: expected one between 0 and");
  expect_refused("-ls -sol phi.sol -hausd 0.1 -geometry m.mesh", "options -ls and -geometry");
  expect_refused("--keep-volume 1", "option --keep-volume: expected -ls");
  expect_refused("-ls -sol phi.sol -met phi.sol", "phi.sol");
  expect_refused("-ls -sol phi.sol -met phi.sol -hsiz 1", "options -hsiz and -met");
  expect_refused("-sol phi.sol -met phi.sol", "options -sol and -met");
  expect_refused("-ls -sol phi.sol -f bad.mmg2d", "bad.mmg2d:3: expected each reference once");
  expect_refused("-ls -sol phi.sol -f worse.mmg2d", "worse.mmg2d:2: expected nosplit or");
  expect_refused("-ls -sol phi.sol -lssurf", "options -ls and -lssurf: expected one of them");
  expect_refused("-lssurf -sol phi.sol --keep-volume 1", "option --keep-volume: expected -ls");
  if (dimension_ == 2)
    expect_refused("-lssurf -sol phi.sol", "m.mesh: expected tetrahedra and triangles");
  expect_refused("-ls -sol phi.sol -o phi.sol", "phi.sol");
}

INSTANTIATE_TEST_SUITE_P(Dimensions, LevelSetOption, testing::Values(2, 3),
                         [](const auto& named) { return std::to_string(named.param) + "D"; });

}  // namespace
}  // namespace ductile::cli::level_set_option_test
