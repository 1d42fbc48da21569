// Layers thinner than the requested size: edges along them get that size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::thin_layers_test {
namespace {

using runtime::Executor;

/// Layers, one element thick along the last axis, with edges of 1.5 to 3 sizes along them; half of
/// them lie between two blocks.
struct Layers {
  int dimension;
  double size, thickness;
  AnyMesh mesh;
};

Layers random_layers(int dimension, std::uint64_t seed) {
  test::Random random(seed);
  Layers layers{dimension, test::uniform(random, 0.04, 0.1), 0, {}};
  layers.thickness = layers.size * std::pow(10, test::uniform(random, -2, -0.3));
  const int count = 1 + static_cast<int>(seed % 4);
  const double spacing = layers.size * test::uniform(random, 1.5, 3);
  const bool between_blocks = seed % 2 == 1;
  test::Grid grid;
  grid.dimension = dimension;
  for (int axis = 0; axis + 1 < dimension; ++axis)
    for (int i = 0; i <= 6; ++i) grid.lines[static_cast<std::size_t>(axis)].push_back(i * spacing);
  auto& heights = grid.lines[static_cast<std::size_t>(dimension - 1)];
  if (between_blocks) heights = {-2 * spacing, -spacing};
  for (int i = 0; i <= count; ++i) heights.push_back(i * layers.thickness);
  if (between_blocks) heights.push_back(count * layers.thickness + spacing);
  grid.region = [dimension](const test::Cell& cell) {
    return 1 + cell[static_cast<std::size_t>(dimension - 1)];
  };
  layers.mesh = test::make_grid(grid);
  return layers;
}

AnyField constant(const Layers& layers) {
  const auto make = [&]<int Dim>() {
    return test::metric_field<Dim>(layers.mesh,
                                   [&](std::uint32_t) { return isotropic<Dim>(layers.size); });
  };
  return layers.dimension == 2 ? make.operator()<2>() : make.operator()<3>();
}

double longest_edge(const Layers& layers, const AnyMesh& mesh) {
  double longest = 0;
  const auto look = [&](const auto& cells) {
    for (const auto& corners : cells.vertices)
      for (const auto a : corners)
        for (const auto b : corners) {
          double square = 0;
          for (int i = 0; i < mesh.dimension; ++i) {
            const auto at = [&](auto v) {
              return mesh.coordinates[static_cast<std::size_t>(v) *
                                          static_cast<std::size_t>(mesh.dimension) +
                                      static_cast<std::size_t>(i)];
            };
            square += (at(a) - at(b)) * (at(a) - at(b));
          }
          longest = std::max(longest, std::sqrt(square) / layers.size);
        }
  };
  if (mesh.dimension == 2)
    look(mesh.triangles);
  else
    look(mesh.tetrahedra);
  return longest;
}

/// In 2D the sides of the thinnest layers between blocks keep some longer edges (decision 51).
double most_allowed(const Layers& layers) {
  if (layers.dimension == 3) return 1.9;
  return layers.thickness < 0.025 * layers.size ? 2 : 1.6;
}

class ThinLayers : public testing::TestWithParam<int> {};

TEST_P(ThinLayers, HaveNoLongEdges) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Layers layers = random_layers(GetParam(), seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", thickness " +
                 std::to_string(layers.thickness / layers.size) + " of the size");
    const AnyField metric = constant(layers);
    const AdaptedMesh first = adapt(Executor({.threads = 1}), layers.mesh, metric);
    EXPECT_EQ(test::joined(test::faults_of(Executor({.threads = 1}), layers.mesh, first)), "");
    EXPECT_LT(longest_edge(layers, first.mesh), most_allowed(layers));
    const AdaptedMesh again = adapt(Executor({.threads = 8}), layers.mesh, metric);
    EXPECT_EQ(test::bits(again.mesh.coordinates), test::bits(first.mesh.coordinates));
    EXPECT_EQ(again.mesh.triangles.vertices, first.mesh.triangles.vertices);
    EXPECT_EQ(again.mesh.tetrahedra.vertices, first.mesh.tetrahedra.vertices);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ThinLayers, testing::Values(2, 3));

}  // namespace
}  // namespace ductile::meshadapt::thin_layers_test
