#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "program.hpp"

namespace ductile::cli::metric_command_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Metric;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A folder with an example and a field of two components on it, a front and a wave.
class Scene {
 public:
  explicit Scene(const std::string& name) {
    folder.add_example(name);
    mesh = meshadapt::read_mesh(folder.path() / (name + ".mesh"));
    const auto dimension = static_cast<std::size_t>(mesh.dimension);
    AnyField field{mesh.dimension, mesh.vertex_count(), {}, {}, {}};
    field.types = {AnyField::Type::scalar, AnyField::Type::scalar};
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      field.values.push_back(std::tanh(10 * (mesh.coordinates[v * dimension] - 0.5)));
      field.values.push_back(std::sin(4 * mesh.coordinates[v * dimension + 1]));
    }
    meshadapt::write_field(folder.path() / "f.sol", field);
  }

  template <int Dim>
  std::vector<Metric<Dim>> metrics(const std::string& name) const {
    const AnyField field = meshadapt::read_field(folder.path() / name);
    EXPECT_EQ(field.types, std::vector{AnyField::Type::symmetric});
    EXPECT_EQ(field.vertex_count, mesh.vertex_count());
    return meshadapt::tensors_of<Dim>(executor_, field);
  }

  template <int Dim>
  double complexity(const std::string& name) const {
    return meshadapt::complexity<Dim>(executor_, meshadapt::make_fixed_mesh<Dim>(executor_, mesh),
                                      metrics<Dim>(name));
  }

  /// Shortest and longest size, and the largest ratio of both at one vertex.
  template <int Dim>
  std::array<double, 3> sizes(const std::string& name) const {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0, ratio = 1;
    for (const Metric<Dim>& metric : metrics<Dim>(name)) {
      const auto value = meshadapt::principal_axes(metric).value;
      const auto [low, high] = std::minmax_element(value.begin(), value.end());
      shortest = std::min(shortest, 1 / std::sqrt(*high));
      longest = std::max(longest, 1 / std::sqrt(*low));
      ratio = std::max(ratio, std::sqrt(*high / *low));
    }
    return {shortest, longest, ratio};
  }

  Folder folder;
  AnyMesh mesh;

 private:
  runtime::Executor executor_{{.threads = 1}};
};

TEST(MetricCommand, MakesAMetricThatAdaptTakes) {
  for (const std::string name : {"waves2d", "waves3d"}) {
    const Scene scene(name);
    const std::string make = "metric make " + name + ".mesh f.sol -o m.sol ";
    for (const char* recovery : {"least-squares", "projection"}) {
      const Outcome made = scene.folder.run(make + "--complexity 500 --recovery " + recovery);
      EXPECT_EQ(made.status, 0) << made.err;
      EXPECT_TRUE(contains(made.err, "made of all its fields, f_1, f_2; name one")) << made.err;
      EXPECT_TRUE(contains(made.out, "complexity 500, for about")) << made.out;
      const double reached =
          name == "waves2d" ? scene.complexity<2>("m.sol") : scene.complexity<3>("m.sol");
      EXPECT_NEAR(reached, 500, 1e-3);
    }
    const Outcome adapted = scene.folder.run("adapt " + name + ".mesh -sol m.sol -o a.mesh");
    EXPECT_EQ(adapted.status, 0) << adapted.err;
  }
}

TEST(MetricCommand, WritesNothingForAMeshItCannotMeasure) {
  const Scene scene("waves2d");
  scene.folder.write("bare.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices 1\n0 0 0\nEnd\n");
  scene.folder.write("bare.sol",
                     "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 1\n1 1\n0.5\nEnd\n");
  EXPECT_EQ(scene.folder.run("metric bound bare.mesh bare.sol -o o.sol --hmax 1").status, 2);
  EXPECT_FALSE(scene.folder.has("o.sol"));
}

TEST(MetricCommand, MakesAMetricForElementsOrAnError) {
  const Scene scene("waves2d");
  const std::string make = "metric make waves2d.mesh f.sol ";
  EXPECT_EQ(scene.folder.run(make + "-o m.solb --elements 5000 --norm 1").status, 0);
  EXPECT_NEAR(scene.complexity<2>("m.solb"), meshadapt::complexity_of_elements(2, 5000), 1e-2);
  EXPECT_EQ(scene.folder.run(make + "-o coarse.sol --error 0.02 --norm inf").status, 0);
  EXPECT_EQ(scene.folder.run(make + "-o fine.sol --error 0.005 --norm inf").status, 0);
  // Four times the error means twice the sizes, except where the extent of the mesh bounds them.
  EXPECT_NEAR(scene.complexity<2>("fine.sol") / scene.complexity<2>("coarse.sol"), 4, 0.2);
}

TEST(MetricCommand, DoesNotDependOnThreads) {
  const Scene scene("waves3d");
  for (const char* threads : {"1", "2", "4"})
    EXPECT_EQ(scene.folder
                  .run(std::string("metric make waves3d.mesh f.sol --complexity 900 -hgrad 1.3 "
                                   "-hmax 0.3 --threads ") +
                       threads + " -o " + threads + ".sol")
                  .status,
              0);
  EXPECT_EQ(scene.folder.read("1.sol"), scene.folder.read("2.sol"));
  EXPECT_EQ(scene.folder.read("1.sol"), scene.folder.read("4.sol"));
  EXPECT_NEAR(scene.complexity<3>("1.sol"), 900, 0.02 * 900);  // of the graded metric
}

TEST(MetricCommand, ScalesWithinBounds) {
  const Scene scene("waves3d");
  const Outcome scaled = scene.folder.run(
      "metric scale waves3d.mesh waves3d.sol --complexity 2000 -hmin 0.04 --anisotropy 3 -o s.sol");
  EXPECT_EQ(scaled.status, 0) << scaled.err;
  EXPECT_NEAR(scene.complexity<3>("s.sol"), 2000, 1e-2);
  const auto [shortest, longest, ratio] = scene.sizes<3>("s.sol");
  EXPECT_GE(shortest, 0.04 * (1 - 1e-6));
  EXPECT_LE(ratio, 3 * (1 + 1e-6));
  const Outcome beyond = scene.folder.run(
      "metric scale waves3d.mesh waves3d.sol --complexity 1e9 -hmin 0.04 -o s.sol");
  EXPECT_EQ(beyond.status, 0);
  EXPECT_TRUE(contains(beyond.err, "no metric within the bounds has the complexity asked for"))
      << beyond.err;
}

TEST(MetricCommand, BoundsAndGrades) {
  const Scene scene("waves2d");
  EXPECT_EQ(scene.folder
                .run("metric bound waves2d.mesh waves2d.sol -hmin 0.02 -hmax 0.05 --anisotropy 2 "
                     "-o b.sol")
                .status,
            0);
  const auto [shortest, longest, ratio] = scene.sizes<2>("b.sol");
  EXPECT_NEAR(shortest, 0.02, 1e-6);
  EXPECT_NEAR(longest, 0.05, 1e-6);
  EXPECT_NEAR(ratio, 2, 1e-6);
  EXPECT_EQ(scene.folder.run("metric grade waves2d.mesh waves2d.sol -hgrad 1.1 -o g.sol").status,
            0);
  EXPECT_GT(scene.complexity<2>("g.sol"), 1.02 * scene.complexity<2>("waves2d.sol"));
}

TEST(MetricCommand, Intersects) {
  const Scene scene("waves2d");
  std::string sizes = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n" +
                      std::to_string(scene.mesh.vertex_count()) + "\n1 1\n";
  for (std::size_t v = 0; v < scene.mesh.vertex_count(); ++v) sizes += "0.05\n";
  scene.folder.write("h.sol", sizes + "End\n");
  const Outcome outcome =
      scene.folder.run("metric intersect waves2d.mesh h.sol waves2d.sol -v 0 -o i.sol");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_LE(scene.sizes<2>("i.sol")[1], 0.05 * (1 + 1e-6));
  EXPECT_GT(scene.complexity<2>("i.sol"), scene.complexity<2>("waves2d.sol"));
}

TEST(MetricCommand, WritesNoMetricThatWouldBeRefused) {
  const Scene scene("waves2d");
  scene.folder.write("old.sol", "old metric");
  for (const char* words :
       {"make waves2d.mesh f.sol --elements 1e300", "make waves2d.mesh f.sol --error 1e-300",
        "scale waves2d.mesh waves2d.sol --complexity 1e200",
        "scale waves2d.mesh waves2d.sol --complexity 1e152",
        "scale waves2d.mesh waves2d.sol --complexity 1e-300"}) {
    const Outcome outcome = scene.folder.run(std::string("metric ") + words + " -o old.sol");
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, "sizes from 1e-75 to 1e75")) << outcome.err;
  }
  EXPECT_EQ(scene.folder.read("old.sol"), "old metric");
}

TEST(MetricCommand, TakesTheMetricThatTheMeshImplies) {
  const Scene scene("waves3d");
  EXPECT_EQ(scene.folder.run("metric implied waves3d.mesh -o i.sol").status, 0);
  const Outcome info = scene.folder.run("info waves3d.mesh -sol i.sol");
  EXPECT_TRUE(contains(info.out, "100.00 %")) << info.out;
}

TEST(MetricCommand, TellsWhatIsWrongWithACommandLine) {
  const Folder folder;
  const auto expect = [&](const char* words, const char* part) {
    const Outcome outcome = folder.run(std::string("metric ") + words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, part)) << words << ": " << outcome.err;
  };
  expect("",
         "expected make, size, distance, implied, intersect, scale, bound or grade, found nothing");
  expect("mak a.mesh a.sol -o b.sol", "found 'mak'");
  expect("make a.mesh -o b.sol --error 1", "expected a mesh and a field, found 1 file");
  expect("implied a.mesh a.sol -o b.sol", "expected a mesh, found 2 files");
  expect("intersect a.mesh a.sol -o b.sol", "two metrics or more, found 2 files");
  expect("make a.mesh a.sol --error 1", "ending in .sol or .solb");
  expect("make a.mesh a.sol --error 1 -o b.mesh", "found 'b.mesh'");
  expect("make a.mesh a.sol -o b.sol", "expected one of --complexity, --elements and --error");
  expect("make a.mesh a.sol -o b.sol --error 1 --elements 2", "expected one of");
  expect("make a.mesh a.sol -o b.sol --error 1 --norm 0.5", "expected 1 or more, or inf");
  expect("make a.mesh a.sol -o b.sol --error 1 --recovery none", "least-squares or projection");
  expect("scale a.mesh a.sol -o b.sol", "expected one of --complexity, --elements");
  expect("scale a.mesh a.sol -o b.sol --error 1", "option --error: scale takes none");
  expect("bound a.mesh a.sol -o b.sol", "expected some of -hmin, -hmax and --anisotropy");
  expect("bound a.mesh a.sol -o b.sol -hmin 2 -hmax 1", "-hmin to be the smaller");
  expect("bound a.mesh a.sol -o b.sol --anisotropy 0.1", "expected 1 or more");
  expect("grade a.mesh a.sol -o b.sol", "grade: expected -hgrad");
  expect("grade a.mesh a.sol -o b.sol -hgrad 0.9", "a factor of 1 or more");
  expect("grade a.mesh a.sol -o nowhere/b.sol -hgrad 2", "nowhere");
  expect("grade a.mesh a.sol -o b.sol -hgrad 2", "a.mesh");
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(MetricCommand, TellsWhatIsWrongWithAFieldAndLeavesOldOutput) {
  const Scene scene("waves2d");
  scene.folder.write("old.sol", "old metric");
  scene.folder.write("short.sol",
                     "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 1\n1\n1\n1\nEnd\n");
  for (const char* words : {"make waves2d.mesh short.sol --error 1 -o old.sol",
                            "scale waves2d.mesh short.sol --complexity 10 -o old.sol",
                            "intersect waves2d.mesh waves2d.sol f.sol -o old.sol"}) {
    const Outcome outcome = scene.folder.run(std::string("metric ") + words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, contains(words, "short") ? "short.sol" : "f.sol"))
        << outcome.err;
  }
  EXPECT_EQ(scene.folder.read("old.sol"), "old metric");
}

// ---- Sizes by places ----

TEST(MetricCommand, SaysSizesByPlacesThatAdaptTakes) {
  struct Line {
    std::string name, places;
    double smallest, largest;
  };
  for (const auto& [name, places, smallest, largest] : std::vector<Line>{
           {"waves2d", "--default 0.2", 0.2, 0.2},
           {"waves2d", "--default 0.2 --near sphere:0.5,0.5,0.1:0.05", 0.05, 0.2},
           {"waves2d", "--default 0.2 --near=sphere:0.5,0.5,0.1:0.05:1.1:0.06", 0.05, 0.06},
           {"waves2d", "--default 0.2 --near line:0,0,1,0:0.05:0", 0.05, 0.2},
           {"waves2d", "--default 0.2 --on 1:0.03:0.1/0.2 --in 1:0.3", 0.03, 0.1},
           {"waves2d", "--near box:0.9,0.9,0,0:0.07:0 --default 0.1 -hmin 0.08", 0.08, 0.1},
           {"waves2d", "--near file:waves2d.mesh:0.02:1", 0.02, 0.02},
           {"waves3d", "--default 0.3 --near point:0,0,0:0.1:0.3/0.5 -hmax 0.25", 0.1, 0.25},
           {"waves3d", "--default 0.3 --near file:waves3d.mesh:0.1:1.5:0.2", 0.1, 0.2}}) {
    Scene scene(name);
    const Outcome made = scene.folder.run("metric size " + name + ".mesh " + places + " -o s.sol");
    ASSERT_EQ(made.status, 0) << places << ": " << made.err;
    EXPECT_EQ(made.err, "");
    const AnyField field = meshadapt::read_field(scene.folder.path() / "s.sol");
    EXPECT_EQ(field.types, std::vector{AnyField::Type::scalar});
    const auto [least, most] = std::minmax_element(field.values.begin(), field.values.end());
    EXPECT_NEAR(*least, smallest, 1e-12) << places;
    EXPECT_NEAR(*most, largest, 1e-12) << places;
    EXPECT_EQ(
        scene.folder.run("adapt " + name + ".mesh -sol s.sol --iterations 1 -o a.mesh").status, 0);
  }
}

TEST(MetricCommand, SaysWhatIsWrongWithPlaces) {
  const Folder folder;
  folder.add_example("waves2d");
  struct Line {
    const char *words, *text;
  };
  for (const auto& [words, text] : std::vector<Line>{
           {"", "size: expected some of --default, --near, --on and --in"},
           {"--near ball:0,0,1:0.1", "expected point, sphere, box, line or file, found 'ball'"},
           {"--near sphere:0,0,1", "expected SHAPE:WHERE:H[:GROW]"},
           {"--near sphere:0,0,0,1:0.1", "the mesh has dimension 2, found 4 numbers"},
           {"--near sphere:0,x,1:0.1", "(X,Y,R in 2D), found '0,x,1'"},
           {"--near sphere:0,0,-1:0.1", "expected a radius of 0 or more"},
           {"--near line:0,0,1:0.1", "found 3 numbers"},
           {"--near file:not.mesh:0.1", "not.mesh: "},
           {"--on 1:0", "expected a size from 1e-75 to 1e75, found '0'"},
           {"--on 1", "expected NAME:H[:GROW], or a number for NAME"},
           {"--on :0.1", "expected a place, found nothing"},
           {"--on 1:0.1:0.9", "expected a growth of 1 or more, or 0 for none, found '0.9'"},
           {"--on 1:0.1:0.05/1", "expected to grow to a size of at least '0.1', found '0.05'"},
           {"--on 1:0.1:0.2/0", "with a distance above 0"},
           {"--on 77:0.1", "option --on 77:0.1: expected edges of reference 77"},
           {"--in wall:0.1", "option --in wall:0.1: expected a number, because the mesh has no"},
           {"--default 0.1 --anisotropy 2", "option --anisotropy: size takes none"},
           {"--near file:waves2d.mesh:0.1 -o waves2d.sol", ""}}) {
    const std::string out = std::string(words).find("-o w") == std::string::npos ? " -o s.sol" : "";
    const Outcome outcome = folder.run("metric size waves2d.mesh " + std::string(words) + out);
    EXPECT_EQ(outcome.status, *text == 0 ? 0 : 2) << words;
    EXPECT_TRUE(contains(outcome.err, text)) << words << ": " << outcome.err;
  }
  EXPECT_FALSE(folder.has("s.sol"));
  EXPECT_TRUE(
      contains(folder.run("metric bound waves2d.mesh waves2d.sol -hmin 1 --on 1:1 -o s.sol").err,
               "option --on: bound takes none"));
}

/// A disk of radius 0.5 with reference 3 in a square, with a name.
AnyMesh disk_in_square() {
  AnyMesh mesh = meshadapt::box_mesh<2>({2, 2}, {16, 16});
  for (std::size_t e = 0; e < mesh.triangles.size(); ++e) {
    double most = 0;
    for (const std::uint32_t v : mesh.triangles.vertices[e])
      for (std::size_t k = 0; k < 2; ++k)
        most = std::max(most, std::abs(mesh.coordinates[2 * v + k] - 1));
    mesh.triangles.reference[e] = most < 0.51 ? 3 : 2;
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    double* const x = &mesh.coordinates[2 * v];
    const double far = std::max(std::abs(x[0] - 1), std::abs(x[1] - 1));
    if (far > 0.51 || far == 0) continue;
    const double scale = far / std::hypot(x[0] - 1, x[1] - 1);
    for (std::size_t k = 0; k < 2; ++k) x[k] = 1 + scale * (x[k] - 1);
  }
  mesh.names = {{2, 3, "disk"}};
  return mesh;
}

TEST(MetricCommand, WritesSignedDistances) {
  const Folder folder;
  const AnyMesh mesh = disk_in_square();
  meshadapt::write_mesh(folder.path() / "disk.msh", mesh);
  const Outcome made = folder.run("metric distance disk.msh --inside disk -hausd 0.01 -o phi.sol");
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(made.out, "distances from -0.5 to 0.914")) << made.out;
  ASSERT_EQ(folder.run("metric distance disk.msh --inside 3 -hausd 0.01 -o phi.vtu").status, 0);
  const AnyField field = meshadapt::read_field(folder.path() / "phi.sol");
  ASSERT_EQ(field.types, std::vector{AnyField::Type::scalar});
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_NEAR(field.values[v],
                std::hypot(mesh.coordinates[2 * v] - 1, mesh.coordinates[2 * v + 1] - 1) - 0.5,
                2e-3);
  const auto with = meshadapt::read_mesh_with_fields(folder.path() / "phi.vtu");
  ASSERT_EQ(with.fields.size(), 1U);
  EXPECT_EQ(with.fields[0].name, "distance");
  struct Line {
    const char *words, *text;
  };
  for (const auto& [words, text] : std::vector<Line>{
           {"", "distance: expected --inside with a region"},
           {"--inside 3 -hmin 1", "option -hmin: distance takes none"},
           {"--inside 3 --near point:0,0:1", "option --near: distance takes none"},
           {"--inside 3 -hausd -1", "option -hausd: "},
           {"--inside 9", "no element has the reference 9"},
           {"--inside wall", "expected a name that the mesh has (disk), found 'wall'"},
           {"--inside 2 --inside 3", "expected facets between elements inside and others"}}) {
    const Outcome outcome =
        folder.run("metric distance disk.msh " + std::string(words) + " -o no.sol");
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, text)) << words << ": " << outcome.err;
  }
  EXPECT_FALSE(folder.has("no.sol"));
  EXPECT_TRUE(contains(folder.run("metric implied disk.msh -hausd 1 -o no.sol").err,
                       "option -hausd: implied takes none"));
}

}  // namespace
}  // namespace ductile::cli::metric_command_test
