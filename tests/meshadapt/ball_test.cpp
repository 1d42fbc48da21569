#include "operators/ball.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/determinant.hpp"
#include "core/orientation.hpp"
#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::ball_test {
namespace {

using test::Random;
using test::uniform;

template <class Dimension>
class BallOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BallOf, Dimensions);

/// A jiggled grid with an unrelated random metric at each vertex.
template <int Dim>
Mesh<Dim> wild_mesh(Random& random) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 4));
  test::jiggle(any, random, 0.3);
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const runtime::Executor executor({.threads = 1});
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (Site<Dim>& site : mesh.site_of) {
    std::array<double, Dim> sizes;
    for (double& h : sizes) h = std::pow(10.0, uniform(random, -1.5, 0));
    site = make_site(site.position, test::random_metric<Dim>(random, sizes));
  }
  update_qualities(executor, mesh);
  return mesh;
}

/// The site of a vertex moved a little, with the metric of another vertex.
template <int Dim>
Site<Dim> moved(const Mesh<Dim>& mesh, VertexId vertex, Random& random, double furthest) {
  Site<Dim> site = mesh.site_of[test::below(random, mesh.vertex_slots())];
  site.position = mesh.site_of[vertex].position;
  for (double& x : site.position.x) x += furthest * uniform(random, -1, 1);
  return site;
}

/// The qualities of the elements around a vertex, by the definition.
template <int Dim>
std::vector<double> qualities_by_definition(const Mesh<Dim>& mesh, VertexId vertex,
                                            const Site<Dim>& apex) {
  std::vector<double> result;
  for (const ElementId e : mesh.elements_of.of(vertex)) {
    auto sites = mesh.sites(mesh.corners_of[e]);
    sites[static_cast<std::size_t>(corner_of(mesh.corners_of[e], vertex))] = &apex;
    result.push_back(quality<Dim>(sites));
  }
  return result;
}

TYPED_TEST(BallOf, GivesTheQualitiesOfTheElementsAround) {
  constexpr int Dim = TypeParam::value;
  Random random(31);
  std::size_t positive = 0, inverted = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Mesh<Dim> mesh = wild_mesh<Dim>(random);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      const VertexBall<Dim> ball(mesh, v);
      const Site<Dim> apex = moved(mesh, v, random, v % 2 == 0 ? 0.03 : 0.4);
      const auto expected = qualities_by_definition(mesh, v, apex);
      ASSERT_EQ(ball.size(), expected.size());
      const double worst = *std::min_element(expected.begin(), expected.end());
      const auto score = ball.score(apex, 0);
      if (!(worst > 0)) {
        EXPECT_LT(score.worst, 0);
        ++inverted;
        continue;
      }
      ++positive;
      EXPECT_NEAR(score.worst, worst, 1e-6 * worst);
      EXPECT_NEAR(score.sum, std::accumulate(expected.begin(), expected.end(), 0.0), 1e-5);
      EXPECT_LT(ball.score(apex, worst * 1.01).worst, 0);
      typename VertexBall<Dim>::Qualities qualities;
      ball.score(apex, 0, qualities);
      for (std::size_t i = 0; i < std::min(expected.size(), qualities.most); ++i)
        EXPECT_NEAR(qualities[i], expected[i], 1e-6 * expected[i]);
    }
  }
  EXPECT_GT(positive, 50U);
  EXPECT_GT(inverted, 50U);
}

TYPED_TEST(BallOf, KnowsTheQualitiesThatThereAre) {
  constexpr int Dim = TypeParam::value;
  Random random(35);
  const Mesh<Dim> mesh = wild_mesh<Dim>(random);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    double worst = 1, sum = 0;
    for (const ElementId e : mesh.elements_of.of(v)) {
      worst = std::min<double>(worst, mesh.quality_of[e]);
      sum += mesh.quality_of[e];
    }
    const auto present = VertexBall<Dim>(mesh, v).present();
    EXPECT_EQ(present.worst, worst);
    EXPECT_NEAR(present.sum, sum, 1e-5);
  }
}

/// A mesh compressed along its last axis and rotated, so that determinants lose digits.
template <int Dim>
Mesh<Dim> squeezed(Mesh<Dim> mesh, double factor) {
  for (Site<Dim>& site : mesh.site_of) {
    Vector<Dim>& p = site.position;
    p[Dim - 1] *= factor;
    p = p + Vector<Dim>{{0.6 * p[0] - 0.8 * p[Dim - 1] - p[0]}};
    p[Dim - 1] += 0.8 * p[0];
    site = make_site(p, isotropic<Dim>(1));
  }
  return mesh;
}

/// Near the facet of one of its elements, or of one in line with it, a vertex gives volumes that
/// are no larger than rounding errors.
TYPED_TEST(BallOf, IsCertainOnlyOfVolumesThatArePositive) {
  constexpr int Dim = TypeParam::value;
  Random random(36);
  std::size_t certain = 0, doubtful = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Mesh<Dim> mesh =
        squeezed(wild_mesh<Dim>(random), std::pow(10.0, uniform(random, -12, 0)));
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      const auto elements = mesh.elements_of.of(v);
      const ElementId near = elements[test::below(random, elements.size())];
      const Facet<Dim> facet = facet_opposite<Dim>(mesh.corners_of[near], v);
      Site<Dim> apex = mesh.site_of[v];
      const double share = 1 - std::pow(10.0, uniform(random, -17, 0));
      for (const VertexId corner : facet)
        apex.position += (share / Dim) * (mesh.site_of[corner].position - mesh.site_of[v].position);
      const VertexBall<Dim> ball(mesh, v);
      const auto score = ball.score(apex, 0);
      if (!(score.worst > 0)) continue;
      if (!ball.is_certain(score.volume, apex.position)) {
        ++doubtful;
        continue;
      }
      ++certain;
      for (const ElementId e : elements) {
        std::array<Vector<Dim>, Dim + 1> p;
        for (std::size_t i = 0; i <= Dim; ++i) {
          const VertexId corner = mesh.corners_of[e][i];
          p[i] = corner == v ? apex.position : mesh.site_of[corner].position;
        }
        EXPECT_EQ(orientation<Dim>(p), 1);
      }
    }
  }
  EXPECT_GT(certain, 200U);
  EXPECT_GT(doubtful, 20U);
}

TYPED_TEST(BallOf, RefusesAnApexThatIsNowhere) {
  constexpr int Dim = TypeParam::value;
  Random random(33);
  const Mesh<Dim> mesh = wild_mesh<Dim>(random);
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const Site<Dim>& here = mesh.site_of[0];
  Site<Dim> nowhere = here, undecided = here, dense = here;
  nowhere.position[0] = nothing;
  undecided.metric.m.fill(nothing);
  undecided.scale = dense.scale = nothing;
  for (const Site<Dim>& apex : {nowhere, undecided, dense})
    EXPECT_LT(VertexBall<Dim>(mesh, 0).score(apex, 0).worst, 0);
}

TYPED_TEST(BallOf, GivesTheGradientsOfQualities) {
  constexpr int Dim = TypeParam::value;
  constexpr double step = 1e-6;
  Random random(32);
  const Mesh<Dim> mesh = wild_mesh<Dim>(random);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    const VertexBall<Dim> ball(mesh, v);
    const Site<Dim>& here = mesh.site_of[v];
    const auto qualities = qualities_by_definition(mesh, v, here);
    for (int axis = 0; axis < Dim; ++axis) {
      Site<Dim> up = here, down = here;
      up.position[axis] += step;
      down.position[axis] -= step;
      const auto above = qualities_by_definition(mesh, v, up),
                 below = qualities_by_definition(mesh, v, down);
      for (std::size_t i = 0; i < qualities.size(); ++i) {
        const double slope = (above[i] - below[i]) / (2 * step);
        EXPECT_NEAR(ball.gradient(i, here, qualities[i])[axis], slope,
                    1e-3 + 1e-3 * std::abs(slope));
      }
    }
  }
}

/// Regular elements with edges of length 1 pull the moved vertex back to its old position.
TEST(Ball, PullsToWhereElementsAreRegular) {
  AnyMesh any = test::make_grid(test::unit_grid(2, 2));
  Neighbours<2> neighbours;
  std::vector<std::string> warnings;
  Mesh<2> mesh = make_mesh<2>(runtime::Executor({.threads = 1}), any, {}, neighbours, warnings);
  const double root = std::sqrt(0.75);
  for (Site<2>& site : mesh.site_of) {  // shear the squares to pairs of regular triangles
    const Vector<2> p = site.position;
    site = make_site(Vector<2>{{p[0] * 2 - p[1], p[1] * 2 * root}}, isotropic<2>(1));
  }
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    if (mesh.elements_of.of(v).size() != 6) continue;
    const Vector<2> off{{0.1, -0.05}};
    mesh.site_of[v].position += off;
    const Vector<2> pull = VertexBall<2>(mesh, v).mean_pull(mesh.site_of[v]);
    EXPECT_NEAR(pull[0], -off[0], 1e-6);
    EXPECT_NEAR(pull[1], -off[1], 1e-6);
    return;
  }
  FAIL() << "no vertex with six triangles";
}

}  // namespace
}  // namespace ductile::meshadapt::ball_test
