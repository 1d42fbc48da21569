/// @file
/// Adapts meshes whose boundary has thin facets at large angles to their neighbours: meshes cut out
/// of a grid, and meshes with steps lower than the tolerance.
#include "support/level_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::level_set_test {
namespace {

using runtime::Executor;

AdaptedMesh adapted(const AnyMesh& mesh, double size, double tolerance, int threads = 2) {
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  options.gradation = 1.3;
  const Executor executor({.threads = threads});
  AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, size), options);
  EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
  EXPECT_EQ(test::joined(check_domain(executor, mesh, result.mesh, tolerance)), "");
  return result;
}

/// Lengths of the edges of all triangles.
std::vector<double> sides(const AnyMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& corners : mesh.triangles.vertices)
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners)
        if (a < b) edges.emplace(a, b);
  std::vector<double> lengths;
  for (const auto& [a, b] : edges)
    lengths.push_back(norm(test::point<3>(mesh, a) - test::point<3>(mesh, b)));
  return lengths;
}

double farthest_from(const AnyMesh& mesh, const test::Level& distance) {
  double most = 0;
  for (const auto& corners : mesh.triangles.vertices)
    for (const std::uint32_t v : corners)
      most = std::max(most, std::abs(distance(test::point<3>(mesh, v))));
  return most;
}

/// Expects that cutting one sphere out of five grids gives similar numbers of facets.
void expect_alike(double least, double noise) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  constexpr double size = 0.2, tolerance = 0.01;
  std::vector<std::size_t> counts;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const int n = 10 + 2 * static_cast<int>(seed);
    const AnyMesh mesh = test::cut_out({n, 1.4, seed, least, noise}, test::sphere_level);
    const AnyMesh result = adapted(mesh, size, tolerance).mesh;
    counts.push_back(result.triangles.size());
    const std::vector<double> lengths = sides(result);
    const auto is_short = [](double length) { return length < 0.3 * size; };
    EXPECT_LT(std::count_if(lengths.begin(), lengths.end(), is_short), 0.03 * lengths.size());
    EXPECT_LT(farthest_from(result, test::sphere_level),
              farthest_from(mesh, test::sphere_level) + 2 * tolerance);
  }
  const auto [fewest, most] = std::minmax_element(counts.begin(), counts.end());
  EXPECT_LT(*most, 1.3 * *fewest);
  const double equilateral = 0.433 * size * size;
  EXPECT_LT(*most, 1.25 * 12.57 / equilateral);
}

TEST(LevelSet, FiveGridsOfASphereGiveAsManyTriangles) { expect_alike(0, 0); }
TEST(LevelSet, WhereZerosKeepAwayFromVerticesAsMany) { expect_alike(0.05, 0); }
TEST(LevelSet, WhereTheyAreOffAtRandomAsMany) { expect_alike(0, 0.02); }

TEST(LevelSet, GivesTheSameBytesAtEachThreadCount) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh mesh = test::cut_out({10, 1.5, 7, 0.03, 0.01}, test::torus_level);
  const AdaptedMesh first = adapted(mesh, 0.3, 0.02, 1);
  for (const int threads : test::thread_counts) {
    const AdaptedMesh other = adapted(mesh, 0.3, 0.02, threads);
    EXPECT_EQ(test::bits(first.mesh.coordinates), test::bits(other.mesh.coordinates));
    EXPECT_EQ(first.mesh.tetrahedra.vertices, other.mesh.tetrahedra.vertices);
  }
}

TEST(LevelSet, RandomGridsStayValid) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  test::Random random(5);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto& level = seed % 3 == 0   ? test::torus_level
                        : seed % 3 == 1 ? test::gyroid_level
                                        : test::cube_level;
    const test::LevelGrid grid{8 + static_cast<int>(test::below(random, 5)),
                               seed % 3 == 1 ? 0.5 : 1.6, seed, test::uniform(random, 0, 0.1),
                               test::uniform(random, 0, 0.1)};
    const double cell = 2 * grid.extent / grid.n;
    adapted(test::cut_out(grid, level), test::uniform(random, 1, 3) * cell,
            test::uniform(random, 0.02, 0.3) * cell);
  }
}

// ---- Features that stay ----

double volume(const AnyMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra.vertices) {
    const auto at = [&](std::uint32_t v) { return test::point<3>(mesh, v); };
    sum += std::abs(dot(cross(at(b) - at(a), at(c) - at(a)), at(d) - at(a))) / 6;
  }
  return sum;
}

/// A grid whose boundary facets all have reference 1.
AnyMesh in_one_piece(const test::Grid& grid) {
  AnyMesh mesh = test::make_grid(grid);
  auto& facets = grid.dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
  std::fill(facets.begin(), facets.end(), 1);
  return mesh;
}

/// Total length of the triangles' edges that lie on edges of the unit cube.
double length_on_edges(const AnyMesh& mesh) {
  const auto on_edge = [](const Vector<3>& p) {
    const auto ends =
        std::count_if(p.x.begin(), p.x.end(), [](double x) { return x == 0 || x == 1; });
    return ends >= 2;
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  double sum = 0;
  for (const auto& corners : mesh.triangles.vertices)
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners) {
        const Vector<3> p = test::point<3>(mesh, a), q = test::point<3>(mesh, b);
        if (a < b && on_edge(p) && on_edge(q) && on_edge(0.5 * (p + q)) &&
            seen.emplace(a, b).second)
          sum += norm(q - p);
      }
  return sum;
}

/// The cube's sides are rough by less than the tolerance; thin facets turn by 60 degrees there.
TEST(LevelSet, ARoughCubeKeepsItsEdges) {
  test::Grid grid;
  grid.dimension = 3;
  for (auto& lines : grid.lines) lines = {0, 0.25, 0.252, 0.5, 0.502, 0.75, 0.752, 1};
  grid.region = test::whole;
  AnyMesh mesh = in_one_piece(grid);
  test::Random random(3);
  for (double* p = mesh.coordinates.data(); p < mesh.coordinates.data() + mesh.coordinates.size();
       p += 3) {
    const auto at_end = [](double x) { return x == 0 || x == 1; };
    if (std::count_if(p, p + 3, at_end) == 1)
      *std::find_if(p, p + 3, at_end) += test::uniform(random, -0.002, 0.002);
  }
  const AnyMesh result = adapted(mesh, 0.3, 0.01).mesh;
  EXPECT_NEAR(length_on_edges(result), 12, 1e-9);
  EXPECT_LT(result.triangles.size(), 0.7 * mesh.triangles.size());
  EXPECT_NEAR(volume(result), 1, 0.01);
}

TEST(LevelSet, AThinPlateKeepsItsRim) {
  for (const double thickness : {0.001, 0.01, 0.04}) {
    test::Grid grid = test::unit_grid(3, 6);
    grid.lines[2] = {0, thickness};
    const AnyMesh mesh = in_one_piece(grid);
    EXPECT_NEAR(volume(adapted(mesh, 0.5, 0.02).mesh), thickness, 1e-9);
  }
}

/// A bent plate of several materials. At a rim next to a side between two materials, facets lower
/// than the tolerance are oriented as one side of the plate in the geometry.
TEST(LevelSet, AThinPlateOfManyMaterialsFitsItsOwnGeometry) {
  for (const double thickness : {0.002, 0.005, 0.03}) {
    SCOPED_TRACE(thickness);
    test::Grid grid = test::unit_grid(3, 6);
    grid.lines[2] = {0, thickness};
    AnyMesh mesh = in_one_piece(grid);
    test::Random random(3);
    for (auto& material : mesh.tetrahedra.reference)
      material = 1 + static_cast<std::int32_t>(test::below(random, 3));
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      double* const p = &mesh.coordinates[3 * v];
      const double angle = 2 * p[0], radius = 0.5 + p[2];
      p[0] = radius * std::cos(angle);
      p[2] = radius * std::sin(angle);
    }
    const double tolerance = 0.015;
    const Executor executor({.threads = 2});
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance;
    options.make.geometry =
        std::make_shared<const Geometry>(executor, mesh, GeometryOptions{.tolerance = tolerance});
    const AnyMesh result = adapt(executor, mesh, constant_metric(mesh, 0.4), options).mesh;
    EXPECT_EQ(test::joined(check_mesh(executor, result)), "");
    EXPECT_NEAR(volume(result) / volume(mesh), 1, 0.05);
  }
}

/// A block with four terraces.
AnyMesh terraces(double step) {
  test::Grid grid = test::unit_grid(3, 8);
  grid.lines[2] = {0, 0.25, 0.5, 0.5 + step};
  grid.region = [](const test::Cell& cell) { return cell[2] == 2 && cell[0] % 2 == 0 ? 0 : 1; };
  return in_one_piece(grid);
}

TEST(LevelSet, StepsHigherThanTheToleranceStay) {
  constexpr double tolerance = 0.02;
  EXPECT_NEAR(volume(adapted(terraces(0.03), 0.5, tolerance).mesh), 0.515, 1e-9);
  const AnyMesh low = adapted(terraces(0.01), 0.5, tolerance).mesh;
  EXPECT_NEAR(volume(low), 0.505, tolerance);
  EXPECT_LT(low.triangles.size(), 125U);  // 118 if no turn of a step counts
}

// ---- Voxels ----

/// The normals of the triangles at each edge, by the edge's ends.
using SideNormals = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Vector<3>>>;
SideNormals normals_at_sides(const AnyMesh& mesh) {
  SideNormals normals;
  for (const auto& corners : mesh.triangles.vertices) {
    const auto at = [&](std::size_t i) { return test::point<3>(mesh, corners[i % 3]); };
    const Vector<3> normal = cross(at(1) - at(0), at(2) - at(0));
    for (std::size_t i = 0; i < 3; ++i)
      normals[std::minmax(corners[i], corners[(i + 1) % 3])].push_back((1 / norm(normal)) * normal);
  }
  return normals;
}

/// Is the angle between these normals 45 degrees or more?
bool is_sharp(const std::vector<Vector<3>>& normals) {
  return normals.size() != 2 || dot(normals[0], normals[1]) < std::sqrt(0.5);
}

/// Number of sharp edges of the triangles.
std::size_t sharp_sides(const AnyMesh& mesh) {
  const SideNormals normals = normals_at_sides(mesh);
  return static_cast<std::size_t>(std::count_if(
      normals.begin(), normals.end(), [](const auto& at) { return is_sharp(at.second); }));
}

/// Vertices of a curve at which it turns by 45 degrees or more.
std::size_t sharp_corners(const AnyMesh& mesh) {
  std::map<std::uint32_t, std::vector<Vector<2>>> directions;  // of edges, away from the vertex
  for (const auto& [a, b] : mesh.edges.vertices) {
    const Vector<2> along = test::point<2>(mesh, b) - test::point<2>(mesh, a);
    directions[a].push_back((1 / norm(along)) * along);
    directions[b].push_back((-1 / norm(along)) * along);
  }
  return static_cast<std::size_t>(
      std::count_if(directions.begin(), directions.end(), [](const auto& at) {
        return at.second.size() != 2 || dot(at.second[0], at.second[1]) > -std::sqrt(0.5);
      }));
}

/// A ball of radius 1 made of cubes of this size (2D: a disk of squares), somewhere in their grid.
AnyMesh voxels(int dimension, double size, test::Random& random) {
  test::Grid grid;
  grid.dimension = dimension;
  const int n = static_cast<int>(std::ceil(2.2 / size)) + 1;
  Vector<3> centre;
  for (int i = 0; i < dimension; ++i) {
    centre[i] = n * size / 2 + test::uniform(random, 0, size);
    for (int k = 0; k <= n + 1; ++k) grid.lines[static_cast<std::size_t>(i)].push_back(k * size);
  }
  grid.region = [=](const test::Cell& cell) {
    Vector<3> away = -1.0 * centre;
    for (int i = 0; i < dimension; ++i) away[i] += (cell[static_cast<std::size_t>(i)] + 0.5) * size;
    return norm(away) < 1 ? 1 : 0;
  };
  return in_one_piece(grid);
}

/// The ideal number of equilateral triangles is 322.
TEST(LevelSet, VoxelsBecomeTheSphereThatTheyApproximate) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  test::Random random(11);
  for (const double size : {0.08, 0.07, 0.06}) {
    SCOPED_TRACE(size);
    const AnyMesh result = adapted(voxels(3, size, random), 0.3, 2 * size).mesh;
    EXPECT_LT(result.triangles.size(), 1.25 * 322);
    EXPECT_LE(sharp_sides(result), 8U);
  }
}

/// Total length of sharp edges.
double sharp_length(const AnyMesh& mesh) {
  double sum = 0;
  for (const auto& [ends, normals] : normals_at_sides(mesh))
    if (is_sharp(normals))
      sum += norm(test::point<3>(mesh, ends.second) - test::point<3>(mesh, ends.first));
  return sum;
}

/// A block whose upper side is a slope, at angles of 73 to 107 degrees to the other sides. Its
/// edges have a total length of 10.12.
TEST(LevelSet, ASlopeOfVoxelsHasAlmostStraightRims) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  for (const int n : {24, 32}) {
    SCOPED_TRACE(n);
    test::Grid grid = test::unit_grid(3, n);
    grid.region = [=](const test::Cell& cell) {
      const auto at = [&](std::size_t i) { return (cell[i] + 0.5) / n - 0.5; };
      return at(2) < 0.3 * at(0) + 0.17 * at(1) ? 1 : 0;
    };
    const AnyMesh result = adapted(in_one_piece(grid), 0.15, 2.0 / n).mesh;
    EXPECT_LT(sharp_length(result), 1.32 * 10.12);  // 1.36, 1.40 with sides across a gap
  }
}

/// A regular polygon with edges of the requested size has 21.
TEST(LevelSet, PixelsBecomeTheCircleThatTheyApproximate) {
  test::Random random(12);
  for (const double size : {0.15, 0.1, 0.06}) {
    SCOPED_TRACE(size);
    const AnyMesh result = adapted(voxels(2, size, random), 0.3, 2 * size).mesh;
    EXPECT_LT(result.edges.size(), 26U);
    EXPECT_EQ(sharp_corners(result), 0U);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::level_set_test
