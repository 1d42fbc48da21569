#include "core/quality.hpp"

#include <gtest/gtest.h>

#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::quality_test {
namespace {

using test::Random;
using test::uniform;

template <int Dim>
using Sites = std::array<Site<Dim>, Dim + 1>;

template <int Dim>
double quality_of(const Sites<Dim>& sites) {
  std::array<const Site<Dim>*, Dim + 1> corner;
  for (std::size_t i = 0; i < corner.size(); ++i) corner[i] = &sites[i];
  return quality<Dim>(corner);
}

Sites<2> triangle(double height) {
  const auto unit = isotropic<2>(1);
  return {make_site<2>({{0, 0}}, unit), make_site<2>({{1, 0}}, unit),
          make_site<2>({{0.5, height}}, unit)};
}
Sites<3> tetrahedron(double height) {
  const auto unit = isotropic<3>(1);
  const double h = std::sqrt(3.0) / 2;
  return {make_site<3>({{0, 0, 0}}, unit), make_site<3>({{1, 0, 0}}, unit),
          make_site<3>({{0.5, h, 0}}, unit), make_site<3>({{0.5, h / 3, height}}, unit)};
}

TEST(Quality, IsOneForRegularElementsAndFallsToZeroOrLess) {
  EXPECT_NEAR(quality_of<2>(triangle(std::sqrt(3.0) / 2)), 1, 1e-14);
  EXPECT_NEAR(quality_of<3>(tetrahedron(std::sqrt(2.0 / 3))), 1, 1e-14);
  EXPECT_EQ(quality_of<2>(triangle(0)), 0);
  EXPECT_EQ(quality_of<3>(tetrahedron(0)), 0);
  EXPECT_LT(quality_of<2>(triangle(-1)), 0);
  EXPECT_LT(quality_of<3>(tetrahedron(-1)), 0);
  // Right isosceles triangle: 4 sqrt(3) / 2 / (1 + 1 + 2); corner of a cube: 12 sqrt(3) / 9^(3/2).
  const auto unit2 = isotropic<2>(1);
  EXPECT_NEAR(quality_of<2>({make_site<2>({{0, 0}}, unit2), make_site<2>({{1, 0}}, unit2),
                             make_site<2>({{0, 1}}, unit2)}),
              std::sqrt(3.0) / 2, 1e-14);
  const auto unit3 = isotropic<3>(1);
  const double corner =
      quality_of<3>({make_site<3>({{0, 0, 0}}, unit3), make_site<3>({{1, 0, 0}}, unit3),
                     make_site<3>({{0, 1, 0}}, unit3), make_site<3>({{0, 0, 1}}, unit3)});
  EXPECT_NEAR(corner, 12 * std::sqrt(3.0) / 27, 1e-14);
  EXPECT_NEAR(mean_ratio<3>(corner), 12 * std::pow(0.5, 2.0 / 3) / 9, 1e-14);
  EXPECT_NEAR(quality_of_mean_ratio<3>(mean_ratio<3>(corner)), corner, 1e-14);
}

/// An element that is regular after the metric's stretch is regular in the metric.
template <int Dim>
void expect_regular_in(const Sites<Dim>& regular, double anisotropy) {
  Random random(9);
  for (int trial = 0; trial < 50; ++trial) {
    std::array<double, Dim> sizes;
    for (double& h : sizes) h = std::pow(anisotropy, uniform(random, 0, 1));
    const auto metric = test::random_metric<Dim>(random, sizes);
    const auto axes = principal_axes(metric);
    Sites<Dim> sites;
    for (std::size_t i = 0; i <= Dim; ++i) {
      Vector<Dim> p;
      for (std::size_t k = 0; k < Dim; ++k)
        p += (regular[i].position.x[k] / std::sqrt(axes.value[k])) * axes.vector[k];
      sites[i] = make_site(p, metric);
    }
    EXPECT_NEAR(std::abs(quality_of<Dim>(sites)), 1, 1e-6);
    EXPECT_NEAR(edge_length(sites[0], sites[1]), 1, 1e-6);
  }
}

TEST(Quality, IsMeasuredInTheMetric) {
  expect_regular_in<2>(triangle(std::sqrt(3.0) / 2), 1e3);
  expect_regular_in<3>(tetrahedron(std::sqrt(2.0 / 3)), 1e3);
}

TEST(Quality, IsJudgedInTheDensestMetricWhereOneIsMuchDenser) {
  Sites<2> sites = triangle(std::sqrt(3.0) / 2);
  Metric<2> stretched = isotropic<2>(0.1);
  stretched.m[0] *= 100;
  sites[2] = make_site(sites[2].position, stretched);
  const double judged = quality_of<2>(sites);
  for (auto& site : sites) site = make_site(site.position, stretched);
  EXPECT_NEAR(judged, quality_of<2>(sites), 1e-8);
}

template <int Dim>
Metric<Dim> random_stretched(Random& random, double anisotropy) {
  std::array<double, Dim> sizes;
  for (double& h : sizes) h = std::pow(anisotropy, uniform(random, 0, 1));
  return test::random_metric<Dim>(random, sizes);
}
template <int Dim>
Sites<Dim> random_sites(Random& random, double anisotropy) {
  Sites<Dim> sites;
  for (Site<Dim>& site : sites) {
    Vector<Dim> position;
    for (int axis = 0; axis < Dim; ++axis) position[axis] = uniform(random, 0, 1);
    site = make_site(position, random_stretched<Dim>(random, anisotropy));
  }
  return sites;
}

template <int Dim>
void expect_no_more_than_one(Random& random) {
  for (int trial = 0; trial < 5000; ++trial) {
    Sites<Dim> sites = random_sites<Dim>(random, std::pow(10.0, uniform(random, 0, 3)));
    EXPECT_LE(std::abs(quality_of<Dim>(sites)), 1 + 1e-9);
  }
}

TEST(Quality, IsNoMoreThanOneWhateverTheMetricsAre) {
  Random random(21);
  expect_no_more_than_one<2>(random);
  expect_no_more_than_one<3>(random);
}

template <int Dim>
void expect_one_if_metrics_differ_by_factors(Random& random, const Sites<Dim>& regular) {
  for (int trial = 0; trial < 200; ++trial) {
    Sites<Dim> sites = regular;
    for (Site<Dim>& site : sites)
      site = make_site(site.position, isotropic<Dim>(std::pow(10.0, uniform(random, -3, 3))));
    EXPECT_NEAR(std::abs(quality_of<Dim>(sites)), 1, 1e-9);
  }
}

TEST(Quality, OfARegularElementIsOneHoweverSizesGrow) {
  Random random(22);
  expect_one_if_metrics_differ_by_factors<2>(random, triangle(std::sqrt(3.0) / 2));
  expect_one_if_metrics_differ_by_factors<3>(random, tetrahedron(std::sqrt(2.0 / 3)));
}

/// All corners have nearly the same density and random axes, so rounding alone decides which is the
/// densest.
template <int Dim>
void expect_little_from_little(Random& random) {
  constexpr double little = 1e-6;
  for (int trial = 0; trial < 2000; ++trial) {
    Sites<Dim> sites = random_sites<Dim>(random, 1e3), other;
    for (Site<Dim>& site : sites) site = make_site(site.position, (1 / site.scale) * site.metric);
    for (std::size_t i = 0; i < sites.size(); ++i)
      other[i] =
          make_site(sites[i].position, (1 + uniform(random, -little, little)) * sites[i].metric);
    const double before = quality_of<Dim>(sites);
    EXPECT_NEAR(quality_of<Dim>(other), before, 20 * little * std::abs(before));
  }
}

TEST(Quality, HardlyDependsOnWhichCornerIsDensest) {
  Random random(23);
  expect_little_from_little<2>(random);
  expect_little_from_little<3>(random);
}

template <int Dim>
void expect_qualities_if_above(Random& random) {
  int above = 0;
  for (int i = 0; i < 2000; ++i) {
    Sites<Dim> sites;
    std::array<const Site<Dim>*, Dim + 1> corner;
    for (std::size_t k = 0; k < sites.size(); ++k) {
      Vector<Dim> position;
      for (int axis = 0; axis < Dim; ++axis) position[axis] = uniform(random, 0, 1);
      sites[k] = make_site(position, isotropic<Dim>(uniform(random, 0.1, 1)));
      corner[k] = &sites[k];
    }
    const double value = quality<Dim>(corner), bar = uniform(random, 0, 1);
    EXPECT_EQ(quality_above<Dim>(corner, bar), value > bar);
    EXPECT_DOUBLE_EQ(quality_if_above<Dim>(corner, bar), value > bar ? value : 0);
    above += value > bar;
  }
  EXPECT_GT(above, 20);
}

TEST(QualityIfAbove, SaysWhatTheQualitySays) {
  Random random(17);
  expect_qualities_if_above<2>(random);
  expect_qualities_if_above<3>(random);
}

TEST(ShorterThan, SaysWhatTheLengthSays) {
  Random random(11);
  for (int trial = 0; trial < 20000; ++trial) {
    const auto at = [&] {
      std::array<double, 3> sizes;
      for (double& h : sizes) h = std::pow(10.0, uniform(random, -1, 1));
      Vector<3> p{{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)}};
      return make_site(p, test::random_metric<3>(random, sizes));
    };
    const auto a = at(), b = at();
    const double length = edge_length(a, b), limit = length * uniform(random, 0.7, 1.3);
    if (std::abs(length / limit - 1) < 1e-9) continue;
    ASSERT_EQ(shorter_than(a, b, limit), length < limit);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::quality_test
