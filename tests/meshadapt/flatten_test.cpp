#include "mesh/flatten.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io_support.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::flatten_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;

/// The same triangles in space, with the heights of `height()` along `axis`.
template <class Height>
AnyMesh in_space(const AnyMesh& flat, std::size_t axis, Height height) {
  AnyMesh mesh = flat;
  mesh.dimension = 3;
  mesh.coordinates.clear();
  for (std::size_t v = 0; v < flat.vertex_count(); ++v)
    for (std::size_t a = 0, from = 0; a < 3; ++a)
      mesh.coordinates.push_back(a == axis ? height(v) : flat.coordinates[2 * v + from++]);
  return mesh;
}

AnyMesh random_flat(Random& random) {
  AnyMesh mesh = test::make_grid(test::unit_grid(2, 2 + static_cast<int>(random() % 5)));
  const double scale = std::pow(10, uniform(random, -6, 6)), shift = uniform(random, -3, 3);
  for (double& x : mesh.coordinates) x = scale * (x + shift);
  return mesh;
}

/// A random error: none, or the rounding of doubles or floats at this height, of sines of pi, or of
/// a few digits.
double rounding_of(Random& random, double at, double scale) {
  switch (random() % 4) {
    case 0:
      return 0;
    case 1:
      return std::abs(at) * 2e-16;
    case 2:
      return scale * 1e-16;
    default:
      return scale * 3e-7;
  }
}

TEST(Flatten, TakesAnyCoordinatePlaneUpToRoundingForAMeshOfDimension2) {
  const test::TemporaryFolder folder;
  const Executor executor({.threads = 1});
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const AnyMesh flat = random_flat(random);
    const std::size_t axis = random() % 3;
    const double extent = std::abs(flat.coordinates[0] - flat.coordinates.back());
    const double at = random() % 3 == 0 ? 0 : extent * uniform(random, -100, 100);
    const double rounding = rounding_of(random, at, extent);
    const AnyMesh space =
        in_space(flat, axis, [&](std::size_t) { return at + rounding * uniform(random, -1, 1); });
    write_mesh(folder / (seed % 2 ? "a.mesh" : "a.meshb"), space);
    Warnings warnings;
    const AnyMesh read = read_mesh(folder / (seed % 2 ? "a.mesh" : "a.meshb"), &warnings);
    ASSERT_EQ(read.dimension, 2);
    EXPECT_EQ(read.coordinates, flat.coordinates);
    EXPECT_EQ(read.triangles, flat.triangles);
    EXPECT_EQ(read.dropped_axis, static_cast<int>(axis));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find(std::string(1, static_cast<char>('x' + axis)) + " = "),
              std::string::npos)
        << warnings[0];
    if (seed % 10 == 0) {
      const auto adapted = adapt(executor, read, constant_metric(read, extent / 5));
      EXPECT_TRUE(check_mesh(executor, adapted.mesh).empty());
    }
  }
}

TEST(Flatten, LeavesASurfaceInSpaceAsItIs) {
  const Executor executor({.threads = 1});
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const AnyMesh flat = random_flat(random);
    const double extent = std::abs(flat.coordinates[0] - flat.coordinates.back());
    const double slope = std::pow(10, uniform(random, -3, 0)), bump = uniform(random, -1, 1);
    const std::size_t axis = random() % 3;
    AnyMesh surface = in_space(flat, axis, [&](std::size_t v) {
      const double x = flat.coordinates[2 * v] / extent, y = flat.coordinates[2 * v + 1] / extent;
      return extent * slope * (x + bump * x * y);
    });
    Warnings warnings;
    flatten(surface, &warnings);
    EXPECT_EQ(surface.dimension, 3);
    EXPECT_TRUE(warnings.empty());
    EXPECT_TRUE(is_surface(adapt(executor, surface, constant_metric(surface, extent)).mesh));
    const std::string text = test::complaint([&] { make_fixed_mesh<3>(executor, surface); });
    EXPECT_NE(text.find("triangles in no plane x, y or z = constant"), std::string::npos) << text;
  }
}

TEST(Flatten, LooksAtTrianglesAndEdgesAlone) {
  AnyMesh mesh = in_space(test::make_grid(test::unit_grid(2, 2)), 1, [](std::size_t) { return 4; });
  mesh.coordinates.insert(mesh.coordinates.end(), {7, 8, 9});  // no triangle has this vertex
  mesh.vertex_reference.push_back(0);
  AnyMesh in_air = mesh;
  flatten(mesh);
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.coordinates[2 * 9], 7);
  EXPECT_EQ(mesh.coordinates[2 * 9 + 1], 9);
  in_air.edges.add({0, 9}, 1);
  flatten(in_air);
  EXPECT_EQ(in_air.dimension, 3);
}

TEST(Flatten, LeavesMeshesOfTetrahedraAndOfDimension2Alone) {
  AnyMesh solid = test::make_grid(test::unit_grid(3, 1)),
          flat = test::make_grid(test::unit_grid(2, 1));
  const AnyMesh before = solid, flat_before = flat;
  flatten(solid);
  flatten(flat);
  EXPECT_EQ(solid, before);
  EXPECT_EQ(flat, flat_before);
}

/// Tensors of a field in space become those of the plane that the mesh lies in.
TEST(Flatten, MetricsFollow) {
  using Type = AnyField::Type;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    AnyMesh mesh =
        in_space(test::make_grid(test::unit_grid(2, 1)), axis, [](std::size_t) { return 0.5; });
    flatten(mesh);
    ASSERT_EQ(mesh.dimension, 2);
    // The tensor is 4 1 9 in the axes of the plane, and 100 across it.
    const std::vector<std::vector<double>> tensor_of = {
        {100, 0, 4, 0, 1, 9}, {4, 0, 100, 1, 0, 9}, {4, 1, 9, 0, 1e-12, 100}};
    AnyField field{3, 4, {Type::symmetric}, {}, "a.sol"};
    for (int v = 0; v < 4; ++v)
      field.values.insert(field.values.end(), tensor_of[axis].begin(), tensor_of[axis].end());
    const AnyField metric = metric_of(field, mesh);
    EXPECT_EQ(std::vector<double>(metric.values.begin(), metric.values.begin() + 3),
              (std::vector<double>{4, 1, 9}));
    field.values[axis == 1 ? 4 : 3] = field.values[axis == 0 ? 1 : 4] = 3;
    EXPECT_NE(test::complaint([&] { metric_of(field, mesh); }).find("out of the plane"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::flatten_test
