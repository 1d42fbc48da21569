#include "mesh/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include "mesh/box_hierarchy.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::box_tree_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;

template <class Dimension>
class BoxTreeIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BoxTreeIn, Dimensions);

template <int Dim>
Vector<Dim> random_point(Random& random, double low, double high) {
  Vector<Dim> point;
  for (double& x : point.x) x = uniform(random, low, high);
  return point;
}

/// Elements of a jiggled grid with a hole.
template <int Dim>
struct Scene {
  std::vector<Corners<Dim>> corners_of;
  std::vector<Vector<Dim>> position_of;

  explicit Scene(Random& random) {
    test::Grid grid = test::unit_grid(Dim, 6);
    grid.region = test::with_hole(6);
    AnyMesh any = test::make_grid(grid);
    test::jiggle(any, random, 0.3);
    const auto& cells = test::elements<Dim>(any);
    corners_of.assign(cells.vertices.begin(), cells.vertices.end());
    for (std::uint32_t v = 0; v < any.vertex_count(); ++v)
      position_of.push_back(test::point<Dim>(any, v));
  }
  Simplices<Dim> simplices() const { return {corners_of, position_of}; }
};

/// Squared distance from the point to the simplex by Gilbert's method, which uses no facets:
/// projects onto segments between the closest point so far and the corner farthest towards
/// the point.
template <int Dim>
double squared_distance_to(const std::array<Vector<Dim>, Dim + 1>& corner,
                           const Vector<Dim>& point) {
  Vector<Dim> at = corner[0] - point;
  for (int step = 0; step < 300; ++step) {
    const auto ahead = *std::min_element(corner.begin(), corner.end(),
                                         [&](const auto& a, const auto& b) {
                                           return dot(a - point, at) < dot(b - point, at);
                                         }) -
                       point;
    const Vector<Dim> along = ahead - at;
    const double gain = -dot(at, along), length = dot(along, along);
    if (gain <= 1e-15 * std::max(1e-30, dot(at, at)) || length == 0) break;
    at += std::min(1.0, gain / length) * along;
  }
  return dot(at, at);
}

TYPED_TEST(BoxTreeIn, FindsTheClosestPointOfAllElements) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  const Scene<Dim> scene(random);
  for (const int threads : {1, 4}) {
    const BoxTree<Dim> tree(Executor({.threads = threads}), scene.simplices());
    for (int trial = 0; trial < 40; ++trial) {
      const auto point = random_point<Dim>(random, -0.5, 1.5);
      double least = std::numeric_limits<double>::infinity();
      for (ElementId e = 0; e < scene.corners_of.size(); ++e)
        least = std::min(least, squared_distance_to<Dim>(scene.simplices().points(e), point));
      const auto found = tree.closest(point);
      EXPECT_NEAR(found.squared_distance, least, 1e-4);
      EXPECT_LE(found.squared_distance, least + 1e-12) << "another element is closer";
    }
  }
}

TYPED_TEST(BoxTreeIn, SaysWhereTheClosestPointLiesInItsElement) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  const Scene<Dim> scene(random);
  const BoxTree<Dim> tree(Executor({.threads = 2}), scene.simplices());
  for (int trial = 0; trial < 2000; ++trial) {
    const auto point = random_point<Dim>(random, -1, 2);
    const auto found = tree.closest(point);
    const auto corner = scene.simplices().points(found.element);
    Vector<Dim> at;
    for (std::size_t i = 0; i <= Dim; ++i) at += found.weight[i] * corner[i];
    EXPECT_GE(*std::min_element(found.weight.begin(), found.weight.end()), 0);
    EXPECT_NEAR(std::accumulate(found.weight.begin(), found.weight.end(), 0.0), 1, 1e-12);
    EXPECT_NEAR(dot(at - point, at - point), found.squared_distance, 1e-12);
  }
}

TYPED_TEST(BoxTreeIn, PointsOfElementsAreAtNoDistance) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  const Scene<Dim> scene(random);
  const BoxTree<Dim> tree(Executor({.threads = 2}), scene.simplices());
  for (ElementId e = 0; e < scene.corners_of.size(); ++e) {
    Vector<Dim> centre;
    for (const auto& p : scene.simplices().points(e)) centre += (1.0 / (Dim + 1)) * p;
    const auto found = tree.closest(centre);
    EXPECT_EQ(found.element, e);
    EXPECT_LT(found.squared_distance, 1e-24);
  }
}

TYPED_TEST(BoxTreeIn, APointThatIsNoNumberGetsAnElement) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  const Scene<Dim> scene(random);
  const BoxTree<Dim> tree(Executor({.threads = 1}), scene.simplices());
  Vector<Dim> point;
  point[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(tree.closest(point).element, scene.corners_of.size());
}

/// The boxes are disjoint, overlap, touch or contain each other.
TYPED_TEST(BoxTreeIn, TheIndexFindsTheBoxesThatMeetAnother) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  for (const std::size_t count : {0, 1, 17, 400}) {
    std::vector<Box<Dim>> boxes(count);
    const auto random_box = [&] {
      const auto low = random_point<Dim>(random, 0, 8);
      Box<Dim> box{low, low + random_point<Dim>(random, 0, 2)};
      for (int i = 0; i < Dim; ++i)  // on a grid, so that some touch
        box.low[i] = std::floor(4 * box.low[i]) / 4, box.high[i] = std::ceil(4 * box.high[i]) / 4;
      return box;
    };
    for (auto& box : boxes) box = random_box();
    const BoxHierarchy<Dim> index(runtime::Executor({.threads = 1}), count,
                                  [&](std::size_t i) { return boxes[i]; });
    for (int trial = 0; trial < 100; ++trial) {
      const auto box = random_box();
      std::multiset<std::size_t> found, expected;
      index.each_meeting(box, [&](std::size_t i) { found.insert(i); });
      for (std::size_t i = 0; i < count; ++i)
        if (meet(boxes[i], box)) expected.insert(i);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::box_tree_test
