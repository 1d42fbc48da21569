// Sizes by places, and bounds by reference, compared with an exhaustive search.

#include "ductile/meshadapt/sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/level_set_references.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/executor.hpp"
#include "io_support.hpp"
#include "mesh/distance.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::sizes_test {
namespace {

using runtime::Executor;
using test::below;
using test::chance;
using test::Random;
using test::uniform;

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector<3> place_of(const AnyMesh& mesh, std::size_t v) {
  Vector<3> at;
  for (int i = 0; i < mesh.dimension; ++i)
    at[i] = mesh.coordinates[v * static_cast<std::size_t>(mesh.dimension) +
                             static_cast<std::size_t>(i)];
  return at;
}

double to_segment(const Vector<3>& a, const Vector<3>& b, const Vector<3>& at) {
  return norm(at - closest_point(std::array{a, b}, at));
}
double to_triangle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c,
                   const Vector<3>& at) {
  return norm(at - closest_point(std::array{a, b, c}, at));
}

/// Distance to the nearest entity with a reference. For elements it is 0 at their corners, and
/// otherwise the distance to their sides.
double to_entities(const AnyMesh& mesh, int dimension, int reference, const Vector<3>& at) {
  double least = infinity;
  const auto p = [&](std::uint32_t v) { return place_of(mesh, v); };
  if (dimension == 0)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.vertex_reference[v] == reference) least = std::min(least, norm(p(v) - at));
  if (dimension == 1)
    for (std::size_t i = 0; i < mesh.edges.size(); ++i)
      if (mesh.edges.reference[i] == reference)
        least = std::min(
            least, to_segment(p(mesh.edges.vertices[i][0]), p(mesh.edges.vertices[i][1]), at));
  if (dimension == 2)
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      if (const auto& [a, b, c] = mesh.triangles.vertices[i];
          mesh.triangles.reference[i] == reference)
        least = std::min(least, to_triangle(p(a), p(b), p(c), at));
  if (dimension == 3)
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
      if (const auto& [a, b, c, d] = mesh.tetrahedra.vertices[i];
          mesh.tetrahedra.reference[i] == reference)
        least =
            std::min({least, to_triangle(p(a), p(b), p(c), at), to_triangle(p(a), p(b), p(d), at),
                      to_triangle(p(a), p(c), p(d), at), to_triangle(p(b), p(c), p(d), at)});
  return least;
}

/// Does the vertex belong to an entity with this reference?
bool belongs(const AnyMesh& mesh, int dimension, int reference, std::size_t vertex) {
  const auto among = [&](const auto& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells.reference[i] == reference &&
          std::find(cells.vertices[i].begin(), cells.vertices[i].end(), vertex) !=
              cells.vertices[i].end())
        return true;
    return false;
  };
  return dimension == 0   ? mesh.vertex_reference[vertex] == reference
         : dimension == 1 ? among(mesh.edges)
         : dimension == 2 ? among(mesh.triangles)
                          : among(mesh.tetrahedra);
}

/// A place for a size, and the distance to it.
struct Way {
  SizePlace place;
  std::function<double(const Vector<3>&)> distance;
  bool region = false;
};

Vector<3> random_point(Random& random, int dimension) {
  Vector<3> p;
  for (int i = 0; i < dimension; ++i) p[i] = uniform(random, -0.2, 1.2);
  return p;
}

Way random_entities(Random& random, const AnyMesh& mesh) {
  const int d = mesh.dimension;
  const std::size_t kind = below(random, 4);
  const int dimension = kind == 0 ? d : kind == 1 ? 0 : d - 1;
  const int reference = kind == 0   ? 1 + static_cast<int>(below(random, 2))
                        : kind == 1 ? static_cast<int>(below(random, 3))
                                    : 1 + static_cast<int>(below(random, 2 * mesh.dimension));
  Way way{Referenced{dimension, reference},
          [=, &mesh](const Vector<3>& at) { return to_entities(mesh, dimension, reference, at); },
          dimension == d};
  if (chance(random, 0.3))
    way.place = Named{"d" + std::to_string(dimension) + "r" + std::to_string(reference)};
  return way;
}

Way random_way(Random& random, const AnyMesh& mesh) {
  const int d = mesh.dimension;
  std::vector<Vector<3>> points;
  for (std::size_t i = 0; i < 1 + below(random, 20); ++i) points.push_back(random_point(random, d));
  switch (below(random, 6)) {
    case 0: {
      const Ball ball{points[0], chance(random, 0.3) ? 0 : uniform(random, 0, 0.5)};
      return {ball, [=](const Vector<3>& at) {
                return std::max(0.0, norm(at - ball.centre) - ball.radius);
              }};
    }
    case 1: {
      AxisBox box{points[0], points.back()};
      for (int i = 0; i < 3; ++i)
        if (box.low[i] > box.high[i]) std::swap(box.low[i], box.high[i]);
      if (d == 2) box.low[2] = box.high[2] = 7;  // is ignored in 2D
      return {box, [=](const Vector<3>& at) {
                Vector<3> nearest = at;
                for (int i = 0; i < d; ++i) nearest[i] = std::clamp(at[i], box.low[i], box.high[i]);
                return norm(at - nearest);
              }};
    }
    case 2:
      return {Polyline{points}, [=](const Vector<3>& at) {
                double least = norm(at - points[0]);
                for (std::size_t i = 1; i < points.size(); ++i)
                  least = std::min(least, to_segment(points[i - 1], points[i], at));
                return least;
              }};
    case 3: {
      TriangleSurface surface{points, {}};
      for (int i = 0; i < 10; ++i) {
        const auto any = [&] { return static_cast<std::uint32_t>(below(random, points.size())); };
        surface.triangles.push_back({any(), any(), any()});
      }
      return {surface, [=](const Vector<3>& at) {
                double least = infinity;
                for (const auto& [a, b, c] : surface.triangles)
                  least = std::min(least, to_triangle(points[a], points[b], points[c], at));
                return least;
              }};
    }
    default:
      return random_entities(random, mesh);
  }
}

SizeGrowth random_growth(Random& random, double size) {
  switch (below(random, 5)) {
    case 0:
      return {};
    case 1:
      return {.grow = 0};
    case 2:
      return {.grow = uniform(random, 1, 3), .largest = size * uniform(random, 1, 4)};
    case 3:
      return {.largest = size * uniform(random, 1, 9), .distance = uniform(random, 0.1, 1)};
    default:
      return {.grow = chance(random, 0.2) ? 1 : uniform(random, 1, 3)};
  }
}

double grown(double size, const SizeGrowth& growth, double distance) {
  if (distance < 1e-9 * size) return size;
  if (growth.distance > 0)
    return std::min(growth.largest, size + (growth.largest - size) * distance / growth.distance);
  if (growth.grow == 0) return infinity;
  const double there = size + distance * std::log(growth.grow);
  return growth.largest > 0 ? std::min(growth.largest, there) : there;
}

AnyMesh random_mesh(Random& random, int dimension) {
  test::Grid grid = test::unit_grid(dimension, dimension == 2 ? 9 : 5);
  grid.region = test::random_regions(random(), 2, false);
  AnyMesh mesh = test::make_grid(grid);
  test::jiggle(mesh, random, 0.3);
  for (auto& reference : mesh.vertex_reference) reference = static_cast<int>(below(random, 3));
  for (int d = 0; d <= dimension; ++d)
    for (int r = 0; r <= 2 * dimension; ++r)
      mesh.names.push_back({d, r, "d" + std::to_string(d) + "r" + std::to_string(r)});
  mesh.name = "a.mesh";
  return mesh;
}

TEST(Sizes, AreTheFinestThatAnyPlaceAsksFor) {
  for (std::uint64_t seed = 0; seed < test::trials(80); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const AnyMesh mesh = random_mesh(random, seed % 2 == 0 ? 2 : 3);
    Sizes sizes{.elsewhere = uniform(random, 0.05, 0.5)};
    if (chance(random, 0.3)) sizes.bounds = {0.04, 0.2};
    std::vector<Way> ways;
    for (std::size_t i = 0; i <= below(random, 5); ++i) {
      ways.push_back(random_way(random, mesh));
      const double size = std::pow(10, uniform(random, -2, -0.5));
      sizes.add(ways.back().place, size, random_growth(random, size));
    }
    const AnyField field = size_field(Executor({.threads = seed % 8 < 7 ? 1 : 2}), mesh, sizes);
    ASSERT_EQ(field.values.size(), mesh.vertex_count());
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vector<3> at = place_of(mesh, v);
      double finest = infinity, base = infinity;
      for (std::size_t i = 0; i < ways.size(); ++i) {
        const auto& [place, size, growth, name] = sizes.sources[i];
        const double distance = ways[i].distance(at);
        finest = std::min(finest, grown(size, growth, distance));
        if (ways[i].region && distance < 1e-12) base = std::min(base, size);
      }
      finest = std::min(finest, base == infinity ? sizes.elsewhere : base);
      if (sizes.bounds.largest > 0) finest = std::clamp(finest, 0.04, 0.2);
      EXPECT_NEAR(field.values[v], finest, 1e-9) << "vertex " << v;
    }
    EXPECT_NO_THROW(metric_of(field, mesh));
  }
}

TEST(Sizes, AreTheExtentWhereNothingIsSaid) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(3, 2));
  const Executor executor({.threads = 1});
  for (const double size : size_field(executor, mesh, {}).values)
    EXPECT_DOUBLE_EQ(size, std::sqrt(3.0));
  EXPECT_EQ(size_field(executor, mesh, {.bounds = {.largest = 0.5}}).values[0], 0.5);
}

TEST(Sizes, SayWhatMakesNoSense) {
  AnyMesh mesh = test::make_grid(test::unit_grid(2, 2));
  mesh.name = "a.mesh";
  mesh.names = {{1, 1, "wall"}, {2, 1, "steel"}};
  struct Fault {
    SizeSource source;
    const char* text;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Ball ball{{0.5, 0.5}, 0.1};
  for (const auto& [source, text] : std::vector<Fault>{
           {{ball, 0}, "expected a size from 1e-75 to 1e75, found 0"},
           {{ball, nan}, "expected a size from 1e-75 to 1e75, found nan"},
           {{ball, 0.1, {.grow = 0.5}}, "expected a growth of 1 or more, or 0 for none, found 0.5"},
           {{ball, 0.1, {.largest = 0.05}},
            "expected to grow to a size of 0.1 or more, found 0.05"},
           {{ball, 0.1, {.distance = 1}}, "expected a largest size to grow to"},
           {{ball, 0.1, {.largest = 1, .distance = -1}}, "over a distance above 0, found -1"},
           {{Ball{{nan, 0}, 1}, 0.1}, "expected a centre and a radius of 0 or more"},
           {{Ball{{0, 0}, -1}, 0.1}, "a radius of 0 or more, found a radius of -1"},
           {{AxisBox{{0, 1}, {1, 0}}, 0.1}, "found one from 1 to 0 along axis 1"},
           {{Polyline{}, 0.1}, "expected points, found none"},
           {{Polyline{{{0, 0}, {0, infinity}}}, 0.1}, "points[1]: expected finite coordinates"},
           {{TriangleSurface{}, 0.1}, "expected triangles, found none"},
           {{TriangleSurface{{{0, 0}}, {{0, 0, 1}}}, 0.1},
            "triangles[0]: expected points below 1, found 1"},
           {{Referenced{4, 1}, 0.1}, "expected entities of a dimension from 0 to 3, found 4"},
           {{Referenced{1, 77}, 0.1}, "expected edges of reference 77 in a.mesh, found none"},
           {{Named{"wal"}, 0.1}, "a name that the mesh has (steel, wall), found 'wal'"}}) {
    const std::string said = test::complaint([&, source = source] {
      Sizes sizes{.sources = {{ball, 0.1}, source}};
      size_field(Executor({.threads = 1}), mesh, sizes);
    });
    EXPECT_NE(said.find(std::string("sources[1]: ")), std::string::npos) << said;
    EXPECT_NE(said.find(text), std::string::npos) << said << ", expected " << text;
  }
  const Executor executor({.threads = 1});
  EXPECT_THROW(size_field(executor, mesh, {.elsewhere = -1}), InputError);
  EXPECT_THROW(size_field(executor, mesh, {.bounds = {2, 1}}), InputError);
  for (auto& corners : mesh.edges.vertices) corners[0] = 99;
  EXPECT_THROW(size_field(executor, mesh, Sizes{}.add(Named{"wall"}, 0.1)), InputError);
}

// ---- Bounds by reference ----

TEST(LocalSizes, BoundSizesWhereTheirEntitiesAre) {
  for (std::uint64_t seed = 0; seed < test::trials(60); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const AnyMesh mesh = random_mesh(random, seed % 2 == 0 ? 2 : 3);
    const int d = mesh.dimension;
    std::vector<LocalSize> locals;
    for (std::size_t i = 0; i <= below(random, 5); ++i) {
      const double a = uniform(random, 0.01, 1), b = uniform(random, 0.01, 1);
      locals.push_back({static_cast<int>(below(random, static_cast<std::size_t>(d) + 1)),
                        static_cast<int>(below(random, 5)), std::min(a, b), std::max(a, b)});
      if (chance(random, 0.2)) locals.back().smallest = 0;
      if (chance(random, 0.2)) locals.back().largest = 0;
    }
    const SizeBounds elsewhere{chance(random, 0.5) ? 0.05 : 0, chance(random, 0.5) ? 0.3 : 0};
    std::vector<double> size_of;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      size_of.push_back(uniform(random, 0.02, 2));
    const AnyField asked = metric_of(scalar_field(d, size_of), mesh);
    const AnyField bound =
        bound_sizes_locally(Executor({.threads = 1}), mesh, asked, locals, elsewhere);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      SizeBounds here = elsewhere;
      int of = d + 1;
      for (const LocalSize& local : locals) {
        if (local.dimension > of || !belongs(mesh, local.dimension, local.reference, v)) continue;
        const double least = local.smallest > 0 ? local.smallest : elsewhere.smallest;
        const double most = local.largest > 0 ? local.largest : elsewhere.largest;
        const bool first = local.dimension < of;
        of = local.dimension;
        here.smallest = first ? least : std::min(least, here.smallest);
        here.largest = first || here.largest == 0 ? most
                       : most == 0                ? here.largest
                                                  : std::min(most, here.largest);
      }
      double expected = size_of[v];
      if (here.smallest > 0) expected = std::max(expected, here.smallest);
      if (here.largest > 0) expected = std::min(expected, here.largest);
      const double found = 1 / std::sqrt(bound.values[v * stride_of(bound)]);
      EXPECT_NEAR(found, expected, 1e-9) << "vertex " << v;
    }
  }
}

TEST(LevelSetReferences, AreReadFromMmgsFiles) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& text, Warnings* warnings = nullptr) {
    test::put_bytes(folder / "a.mmg2d", text);
    return read_level_set_references(folder / "a.mmg2d", warnings);
  };
  Warnings warnings;
  const auto found = read(
      "Parameters 1\n1 Edge 1 2 3\nlsReferences # by hand\n2\n3 NoSplit\n-2 1 5\n"
      "LSBaseReferences\n2\n4 5\n",
      &warnings);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].reference, 3);
  EXPECT_FALSE(found[0].split);
  EXPECT_EQ(found[1].reference, -2);
  EXPECT_TRUE(found[1].split);
  EXPECT_EQ(found[1].minus, 1);
  EXPECT_EQ(found[1].plus, 5);
  EXPECT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(read("Parameters 0").empty());
  for (const char* text :
       {"LSReferences", "LSReferences -1", "LSReferences 1\n1", "LSReferences 1\n1 2",
        "LSReferences 1\n1 nosplitt", "LSReferences 1\n1 2 x", "LSReferences 1\nx nosplit",
        "LSReferences 2\n1 nosplit\n1 2 3", "LSReferences 1\n1 nosplit\n2 3 4",
        "LSReferences 99999999999999999\n1 2 3", "LSBaseReferences 2\n1"})
    EXPECT_THROW(read(text), InputError) << text;
}

TEST(LocalSizes, AreReadFromMmgsFiles) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& text, Warnings* warnings = nullptr) {
    test::put_bytes(folder / "a.mmg3d", text);
    return read_local_sizes(folder / "a.mmg3d", warnings);
  };
  const auto found = read(
      "# by hand\nPARAMETERS 3\n38 Triangles 1.8 2.2 0.01\n-7 tetrahedron 0 +1e-1 0 7 eDGE -1 -1 "
      "-1\n");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].dimension, 2);
  EXPECT_EQ(found[0].reference, 38);
  EXPECT_EQ(found[0].smallest, 1.8);
  EXPECT_EQ(found[0].largest, 2.2);
  EXPECT_EQ(found[0].hausdorff_tolerance, 0.01);
  EXPECT_EQ(found[1].dimension, 3);
  EXPECT_EQ(found[1].reference, -7);
  EXPECT_EQ(found[1].largest, 0.1);
  EXPECT_EQ(found[2].dimension, 1);
  EXPECT_EQ(found[2].smallest, 0);  // 0 is no bound
  Warnings warnings;
  EXPECT_EQ(read("LSReferences\n2\n3 nosplit\n2 1 5\nLSBaseReferences\n1\n4\nparameters\n1\n"
                 "1 Vertices 0.1 0.2 0",
                 &warnings)
                .size(),
            1U);
  EXPECT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(read("parameters 0\n").empty());
  struct Fault {
    const char *text, *said;
  };
  for (const auto& [text, said] : std::vector<Fault>{
           {"sizes 1", "a.mmg3d:1: expected Parameters or LSReferences, found 'sizes'"},
           {"parameters\nmany",
            ":2: expected the number of references, a whole number, found 'many'"},
           {"parameters -1", ":1: expected a number of references of 0 or more"},
           {"parameters 2\n1 Edge 1 2 3\n", "expected a reference, found the end of the file"},
           {"parameters 1\n1.5 Edge 1 2 3",
            ":2: expected a reference, a whole number, found '1.5'"},
           {"parameters 1\n99999999999 Edge 1 2 3",
            ":2: expected a reference, a whole number, found '9999"},
           {"parameters 1\n1 Quads 1 2 3", "expected Vertex, Edge, Triangle or Tetrahedron, found"},
           {"parameters 1\n1 Edge x 2 3", ":2: expected hmin, a number, found 'x'"},
           {"parameters 1\n1 Edge 1 inf 3", ":2: expected hmax, a finite number"},
           {"parameters 1\n1 Edge 2 1 3", ":2: expected hmin not to be above hmax"},
           {"parameters 1\n1 Edge 1 2", "expected hausd, found the end of the file"},
           {"parameters 1\n1 Edge 1 2 3 4", "expected Parameters or LSReferences, found '4'"}})
    EXPECT_NE(test::complaint([&, text = text] { read(text); }).find(said), std::string::npos)
        << text << ": " << test::complaint([&, text = text] { read(text); });
}

TEST(LocalSizes, RefuseWhatMakesNoSense) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(2, 2));
  const AnyField metric =
      metric_of(scalar_field(2, std::vector<double>(mesh.vertex_count(), 0.1)), mesh);
  const Executor executor({.threads = 1});
  for (const LocalSize& local : {LocalSize{3, 1, 0.1, 0.2}, LocalSize{-1, 1, 0.1, 0.2},
                                 LocalSize{1, 1, 0.2, 0.1}, LocalSize{1, 1, infinity, 0}})
    EXPECT_NE(test::complaint([&] {
                bound_sizes_locally(executor, mesh, metric, {{1, 2, 0.1}, local});
              }).find("local_sizes[1]: "),
              std::string::npos);
  EXPECT_EQ(bound_sizes_locally(executor, mesh, metric, {{1, 55, 1, 2}}).values, metric.values);
}

}  // namespace
}  // namespace ductile::meshadapt::sizes_test
