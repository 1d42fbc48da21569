#include "ductile/meshadapt/signed_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "mesh/distance.hpp"
#include "support/ball_in_box.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::signed_distance_test {
namespace {

using runtime::Executor;

template <class Dimension>
class SignedDistanceIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SignedDistanceIn, Dimensions, );

constexpr double radius = 0.4;
const SignedDistanceOptions of_ball{.inside = {test::ball_inside}};

/// The largest error for a ball, and for its facets alone.
template <int Dim>
double error(const std::vector<double>& points, const std::vector<double>& distances) {
  double most = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    double square = 0;
    for (std::size_t k = 0; k < Dim; ++k) square += points[Dim * i + k] * points[Dim * i + k];
    most = std::max(most, std::abs(distances[i] - (std::sqrt(square) - radius)));
  }
  return most;
}

TYPED_TEST(SignedDistanceIn, IsThatOfTheBallThatTheFacetsApproximate) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = test::ball_in_box(dim, dim == 2 ? 16 : 12, radius);
  const auto distances = signed_distance(executor, mesh, of_ball);
  // Facets are off by 0.004 and more.
  EXPECT_LT((error<dim>(mesh.coordinates, distances)), dim == 2 ? 1e-3 : 2e-3);
  for (const std::uint32_t v : test::interface_vertices(mesh)) EXPECT_EQ(distances[v], 0);
  EXPECT_EQ(static_cast<std::size_t>(std::count(distances.begin(), distances.end(), 0)),
            test::interface_vertices(mesh).size());
  test::Random random(3);
  std::vector<double> points(2000 * dim);
  for (double& x : points) x = test::uniform(random, -1.2, 1.2);  // some outside of the mesh
  EXPECT_LT((error<dim>(points, signed_distance(executor, mesh, of_ball, points))),
            dim == 2 ? 1e-3 : 2e-3);
  const auto at_vertices = signed_distance(executor, mesh, of_ball, mesh.coordinates);
  for (std::size_t v = 0; v < distances.size(); ++v)
    EXPECT_NEAR(at_vertices[v], distances[v], 1e-12);
}

TYPED_TEST(SignedDistanceIn, HasItsSignByTheSideOfTheCurvedSurface) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = test::ball_in_box(dim, 12, radius);
  test::Random random(4);
  std::vector<double> points;
  for (int i = 0; i < 1000; ++i) {  // between the facets and the ball, for the most part
    Vector<dim> out;
    for (int k = 0; k < dim; ++k) out[k] = test::uniform(random, -1, 1);
    out *= (radius - (dim == 2 ? 0.001 : 0.003)) / norm(out);
    points.insert(points.end(), out.x.begin(), out.x.end());
  }
  for (const double distance : signed_distance(executor, mesh, of_ball, points))
    EXPECT_LT(distance, 0);
}

/// The closest of the facets between regions of a grid, by looking at all.
template <int Dim>
double by_facets(const AnyMesh& mesh, const Vector<Dim>& point,
                 const std::vector<Facet<Dim>>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Facet<Dim>& facet : all) {
    std::array<Vector<Dim>, Dim> corner;
    for (std::size_t i = 0; i < Dim; ++i) corner[i] = test::point<Dim>(mesh, facet[i]);
    least = std::min(least, norm(closest_point(corner, point) - point));
  }
  return least;
}

TYPED_TEST(SignedDistanceIn, IsExactForFlatInterfacesWithCorners) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = 0; seed < test::trials(20); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    test::Grid grid = test::unit_grid(dim, dim == 2 ? 5 : 3);
    const bool grid_has_holes = test::chance(random, 0.3);
    grid.region = test::random_regions(seed, 3, grid_has_holes);
    AnyMesh mesh = test::make_grid(grid);
    std::vector<Facet<dim>> interface;
    const auto& reference_of = elements_in<dim>(mesh).reference;
    const auto is_inside = [&](ElementId e) { return reference_of[e] == 1; };
    for (const auto& [facet, beside] : test::facet_elements<dim>(mesh))
      if (beside.size() == 2 && is_inside(beside[0]) != is_inside(beside[1]))
        interface.push_back(facet);
    if (interface.empty()) continue;
    const auto distances = signed_distance(executor, mesh, {.inside = {1}});
    for (std::size_t e = 0; e < reference_of.size(); ++e)
      for (const VertexId v : elements_in<dim>(mesh).vertices[e]) {
        const auto at = position_in<dim>(mesh, v);
        EXPECT_NEAR(std::abs(distances[v]), by_facets<dim>(mesh, at, interface), 1e-12);
        // Both may touch at a vertex with holes around it.
        if (!grid_has_holes && distances[v] != 0) {
          EXPECT_EQ(distances[v] < 0, is_inside(static_cast<ElementId>(e)));
        }
      }
  }
}

TYPED_TEST(SignedDistanceIn, HasTheSameBytesAtAnyNumberOfThreads) {
  constexpr int dim = TypeParam::value;
  const AnyMesh mesh = test::ball_in_box(dim, 8, radius);
  test::Random random(5);
  std::vector<double> points(3000 * dim);
  for (double& x : points) x = test::uniform(random, -1.1, 1.1);
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 3, 4, 8}) {
    const Executor executor({.threads = threads});
    auto found = test::bits(signed_distance(executor, mesh, of_ball));
    const auto more = test::bits(signed_distance(executor, mesh, of_ball, points));
    found.insert(found.end(), more.begin(), more.end());
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected) << threads << " threads";
  }
}

TYPED_TEST(SignedDistanceIn, SaysWhatIsWrong) {
  const Executor executor({.threads = 1});
  const AnyMesh mesh = test::ball_in_box(TypeParam::value, 4, radius);
  const auto message = [&](const SignedDistanceOptions& options, std::span<const double> points) {
    try {
      signed_distance(executor, mesh, options, points);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::vector<double> few{0.5}, wrong(6, std::nan(""));
  EXPECT_EQ(message({.inside = {3, 8}}, {}),
            "test: no element has the reference 8, which is to be inside");
  EXPECT_EQ(message({}, {}),
            "test: expected facets between elements inside and others, found none");
  EXPECT_EQ(message({.inside = {2, 3}}, {}), message({}, {}));
  EXPECT_NE(message(of_ball, few).find("coordinates for each"), std::string::npos);
  EXPECT_NE(message(of_ball, wrong).find("points[0]"), std::string::npos);
  EXPECT_NE(message({.inside = {3}, .tolerance = -1}, {}).find("tolerance"), std::string::npos);
  EXPECT_NE(message({.inside = {3}, .ridge_angle = 95}, {}).find("ridge_angle"), std::string::npos);
}

}  // namespace
}  // namespace ductile::meshadapt::signed_distance_test
