/// @file
/// Faces that are flat except for noise that the digits of their coordinates do not reveal, as
/// after rounding and scaling: a warning reports them, but not faces that are curved or flat.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::flat_noise_test {
namespace {

using runtime::Executor;
using test::Random;

const Executor executor({.threads = 2});

/// Transforms coordinates as a program might, so that their digits reveal nothing.
AnyMesh moved_on(AnyMesh mesh, Random& random) {
  if (test::chance(random, 0.4)) {
    test::place(mesh, random, 1, 10);
    return mesh;
  }
  const double scale = test::chance(random, 0.5) ? 1e-3 : 25.4 / 7;
  for (double& x : mesh.coordinates) x *= scale;
  return mesh;
}

double extent(const AnyMesh& mesh) {
  const auto size = static_cast<std::size_t>(mesh.dimension);
  double most = 0;
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += size) {
    double square = 0;
    for (std::size_t axis = 0; axis < size; ++axis) {
      const double d = mesh.coordinates[at + axis] - mesh.coordinates[axis];
      square += d * d;
    }
    most = std::max(most, std::sqrt(square));
  }
  return most;
}

/// The tolerance named in the warning about noise; 0 without such a warning.
double tolerance_told(const AdaptedMesh& adapted) {
  for (const std::string& warning : adapted.report.warnings)
    if (const auto at = warning.find("-hausd "); at != std::string::npos)
      return std::strtod(warning.c_str() + at + 7, nullptr);
  return 0;
}

AdaptedMesh coarsened(const AnyMesh& mesh, double size, double tolerance) {
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  return adapt(executor, mesh, constant_metric(mesh, size), options);
}

/// The warning gives the faces' distance from flat; following its advice coarsens them.
TEST(FlatNoise, IsToldWhereDigitsDoNotShowIt) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  int trials = 0, told = 0;
  for (auto seed = test::first_trial(); seed < test::end_of_trials(60); ++seed) {
    Random random(seed);
    const int dimension = 2 + static_cast<int>(seed % 2), n = dimension == 2 ? 24 : 10;
    test::Grid grid = test::unit_grid(dimension, n);
    if (test::chance(random, 0.5)) grid.region = test::l_shape(n);
    AnyMesh exact = test::make_grid(grid);
    test::jiggle(exact, random, 0.1);
    test::place(exact, random, 1, 0);
    AnyMesh mesh = exact;
    const double noise = std::pow(10.0, test::uniform(random, -8, -4));
    for (double& x : mesh.coordinates) x = noise * std::round(x / noise);
    mesh = moved_on(std::move(mesh), random);
    const double scale = extent(mesh) / extent(exact), size = 3.0 / n;
    SCOPED_TRACE("seed " + std::to_string(seed) + ", noise " + std::to_string(1e9 * noise) +
                 "e-9, scale " + std::to_string(scale));
    const double tolerance = tolerance_told(coarsened(mesh, scale * size, 0));
    ++trials;
    if (!(tolerance > 0)) continue;
    ++told;
    EXPECT_LT(tolerance, 8 * scale * noise);
    const AdaptedMesh better = coarsened(mesh, scale * size, tolerance);
    EXPECT_LT(3 * better.mesh.vertex_count(), 4 * coarsened(exact, size, 0).mesh.vertex_count());
    EXPECT_EQ(tolerance_told(better), 0);
  }
  EXPECT_GE(10 * told, 9 * trials);
}

/// The boxes are flat, or bend, some of them only a little.
TEST(FlatNoise, IsNotToldOfWhatBendsOrIsFlat) {
  for (auto seed = test::first_trial(); seed < test::end_of_trials(60); ++seed) {
    Random random(seed);
    const int dimension = 2 + static_cast<int>(seed % 2), n = dimension == 2 ? 40 : 10;
    AnyMesh mesh = test::make_grid(test::unit_grid(dimension, n));
    test::jiggle(mesh, random, 0.1);
    const double rise = std::pow(10.0, test::uniform(random, -9, -2));
    const std::uint64_t kind = test::below(random, 4);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", kind " + std::to_string(kind) + ", rise " +
                 std::to_string(1e9 * rise) + "e-9");
    const auto size = static_cast<std::size_t>(dimension);
    for (std::size_t at = 0; at < mesh.coordinates.size(); at += size) {
      double* const x = &mesh.coordinates[at];
      const double y = x[0] - 0.4, z = dimension == 3 ? x[1] - 0.5 : 0.0;
      const std::array<double, 4> heights{0.0, y * y + z * z, y * y - z * z + y * z,
                                          0.3 * std::sin(6 * y) * (1 + z)};
      for (std::size_t axis = 0; axis < size; ++axis) x[axis] += rise * heights[kind];
    }
    test::place(mesh, random, 1, 0);
    EXPECT_EQ(tolerance_told(coarsened(mesh, 3.0 / n, 0)), 0);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::flat_noise_test
