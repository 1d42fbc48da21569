#include "ductile/meshadapt/metric_operations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "metric/mesh_gradation.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::metric_operations_test {
namespace {

using runtime::Executor;
using Random = std::mt19937_64;

template <class T>
class MetricOperations : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MetricOperations, Dimensions, );

double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution(from, to)(random);
}

template <int Dim>
Vector<Dim> random_direction(Random& random) {
  std::normal_distribution<double> normal;
  Vector<Dim> d;
  for (double& x : d.x) x = normal(random);
  return 1 / norm(d) * d;
}

/// A metric with random axes and sizes that differ by up to `anisotropy`.
template <int Dim>
Metric<Dim> random_metric(Random& random, double anisotropy) {
  Metric<Dim> any;
  for (double& component : any.m) component = uniform(random, -1, 1);
  PrincipalAxes<Dim> axes = principal_axes(any);
  const double spread = std::log(anisotropy);
  for (double& value : axes.value) value = std::exp(-2 * uniform(random, 0, spread));
  axes.value[0] = 1;
  return compose(axes);
}

/// Change of d' M d that rounding of the components may cause.
template <int Dim>
double rounding_of(const Metric<Dim>& metric, const Vector<Dim>& d) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) sum += std::abs(d[i] * metric(i, j) * d[j]);
  return 200 * std::numeric_limits<double>::epsilon() * sum;
}

template <int Dim>
void expect_no_coarser(const Metric<Dim>& fine, const Metric<Dim>& coarse, const Vector<Dim>& d) {
  EXPECT_GE(squared_length(fine, d) + rounding_of(fine, d) + rounding_of(coarse, d),
            squared_length(coarse, d) * (1 - 1e-12));
}

template <int Dim>
std::vector<Vector<Dim>> directions(Random& random, const Metric<Dim>& a, const Metric<Dim>& b) {
  std::vector<Vector<Dim>> all(20);
  for (Vector<Dim>& d : all) d = random_direction<Dim>(random);
  for (const Metric<Dim>& metric : {a, b})
    for (const Vector<Dim>& axis : principal_axes(metric).vector) all.push_back(axis);
  return all;
}

TYPED_TEST(MetricOperations, IntersectionIsAsFineAsBothInAllDirections) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (const double anisotropy : {1.0, 10.0, 1e3, 1e6, 1e8}) {
    for (int trial = 0; trial < 300; ++trial) {
      const double scale = std::pow(10.0, uniform(random, -12, 12));
      const Metric<Dim> a = random_metric<Dim>(random, anisotropy);
      const Metric<Dim> b = scale * random_metric<Dim>(random, anisotropy);
      const Metric<Dim> both = intersect(a, b);
      for (const Vector<Dim>& d : directions<Dim>(random, a, b)) {
        expect_no_coarser(both, a, d);
        expect_no_coarser(both, b, d);
      }
    }
  }
}

TYPED_TEST(MetricOperations, IntersectionIsNoFinerThanNeeded) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Metric<Dim> a = random_metric<Dim>(random, 100), b = random_metric<Dim>(random, 100);
    Metric<Dim> sum = a;
    sum += b;
    const Metric<Dim> both = intersect(a, b);
    for (const Vector<Dim>& d : directions<Dim>(random, a, b)) expect_no_coarser(sum, both, d);
    EXPECT_LE(determinant(both), determinant(sum));
  }
}

TYPED_TEST(MetricOperations, IntersectionDoesNotDependOnTheOrder) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  for (const double anisotropy : {1.0, 1e4, 1e8}) {
    for (int trial = 0; trial < 300; ++trial) {
      const Metric<Dim> a = random_metric<Dim>(random, anisotropy);
      const Metric<Dim> b = random_metric<Dim>(random, anisotropy);
      EXPECT_EQ(intersect(a, b), intersect(b, a));
    }
  }
}

TYPED_TEST(MetricOperations, IntersectionReturnsTheFinerOneAsItIs) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  for (const double anisotropy : {1.0, 1e4, 1e8}) {
    for (int trial = 0; trial < 300; ++trial) {
      const Metric<Dim> a = random_metric<Dim>(random, anisotropy);
      EXPECT_EQ(intersect(a, a), a);
      EXPECT_EQ(intersect(a, 0.25 * a), a);
      EXPECT_EQ(intersect(1e-20 * a, a), a);
    }
  }
}

TEST(MetricOperations2D, IntersectionKeepsSmallValuesBesideLargeOnes) {
  const Metric<2> a{{1, 0, 1e16}}, b{{1.5, 0, 1}}, c{{1e16, 0, 1}};
  const auto expect_diagonal = [](const Metric<2>& metric, double first, double second) {
    EXPECT_NEAR(metric.m[0] / first, 1, 1e-13);
    EXPECT_EQ(metric.m[1], 0);
    EXPECT_NEAR(metric.m[2] / second, 1, 1e-13);
  };
  expect_diagonal(intersect(a, b), 1.5, 1e16);
  expect_diagonal(intersect(a, c), 1e16, 1e16);
  expect_diagonal(intersect(a, isotropic<2>(0.5)), 4, 1e16);
}

TYPED_TEST(MetricOperations, BoundsClampSizesAndKeepAxes) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(5);
  std::vector<Metric<Dim>> metrics(500);
  for (Metric<Dim>& metric : metrics) metric = random_metric<Dim>(random, 1e4);
  std::vector<Metric<Dim>> bounded = metrics;
  bound_sizes(executor, bounded, {.smallest = 2, .largest = 50});
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const PrincipalAxes<Dim> before = principal_axes(metrics[i]);
    for (int k = 0; k < Dim; ++k) {
      const Vector<Dim>& axis = before.vector[static_cast<std::size_t>(k)];
      const double size = 1 / std::sqrt(before.value[static_cast<std::size_t>(k)]);
      EXPECT_NEAR(1 / std::sqrt(squared_length(bounded[i], axis)), std::clamp(size, 2.0, 50.0),
                  1e-6);
    }
  }
}

TYPED_TEST(MetricOperations, BoundsLeaveAloneWhatIsWithin) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Random random(6);
  std::vector<Metric<Dim>> metrics(100);
  for (Metric<Dim>& metric : metrics) metric = random_metric<Dim>(random, 10);
  const std::vector<Metric<Dim>> before = metrics;
  bound_sizes(executor, metrics, {.smallest = 0.5, .largest = 20});
  EXPECT_EQ(metrics, before);
  bound_sizes(executor, metrics, {});
  EXPECT_EQ(metrics, before);
}

/// A square or a cube of n^Dim cells, each cut into simplices that share a diagonal (Kuhn).
template <int Dim>
AnyMesh grid(std::uint32_t n) {
  AnyMesh any;
  any.dimension = Dim;
  any.name = "grid";
  std::array<std::uint32_t, Dim> step;  // to the next vertex along an axis
  for (std::size_t i = 0; i < Dim; ++i) step[i] = i == 0 ? 1 : step[i - 1] * (n + 1);
  const std::uint32_t vertices = step[Dim - 1] * (n + 1);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    bool last = false;
    for (const std::uint32_t s : step) {
      any.coordinates.push_back(static_cast<double>(v / s % (n + 1)) / n);
      last = last || v / s % (n + 1) == n;
    }
    any.vertex_reference.push_back(0);
    if (last) continue;
    std::array<std::size_t, Dim> order;
    for (std::size_t i = 0; i < Dim; ++i) order[i] = i;
    do {
      Corners<Dim> corner{v};
      for (std::size_t i = 0; i < Dim; ++i) corner[i + 1] = corner[i] + step[order[i]];
      bool even = true;
      for (std::size_t i = 0; i < Dim; ++i)
        for (std::size_t k = 0; k < i; ++k) even = even == (order[k] < order[i]);
      if (!even) std::swap(corner[0], corner[1]);
      if constexpr (Dim == 2)
        any.triangles.add(corner, 1);
      else
        any.tetrahedra.add(corner, 1);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return any;
}

template <int Dim>
Mesh<Dim> grid_mesh(std::uint32_t n) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  return make_mesh<Dim>(Executor({.threads = 1}), grid<Dim>(n), {.complete_boundary = true},
                        neighbours, warnings);
}

/// Ratio of squared lengths minus 1 where the bound is violated most: over all edges, both ways, in
/// the axes of either metric and in the edge's direction.
template <int Dim>
double worst_excess(const Mesh<Dim>& mesh, const std::vector<Metric<Dim>>& metric_of,
                    double factor) {
  double worst = -1;
  const auto check = [&](VertexId p, VertexId q) {
    const Vector<Dim> edge = mesh.site_of[q].position - mesh.site_of[p].position;
    const double rate = std::log(factor),
                 g = 1 + rate * std::sqrt(squared_length(metric_of[p], edge));
    PrincipalAxes<Dim> axes = principal_axes(metric_of[p]);
    for (double& value : axes.value) {
      const double g_size = 1 + rate * norm(edge) * std::sqrt(value);
      value /= std::pow(g, 7.0 / 4) * std::pow(g_size, 1.0 / 4);
    }
    const Metric<Dim> reaching = compose(axes);
    std::vector<Vector<Dim>> all{edge};
    for (const VertexId v : {p, q})
      for (const Vector<Dim>& axis : principal_axes(metric_of[v]).vector) all.push_back(axis);
    for (const Vector<Dim>& d : all)
      worst = std::max(worst, squared_length(reaching, d) / squared_length(metric_of[q], d) - 1);
  };
  for (const Corners<Dim>& corners : mesh.corners_of)
    for (const VertexId p : corners)
      for (const VertexId q : corners)
        if (p != q) check(p, q);
  return worst;
}

/// A coarse metric, except at a few vertices with random metrics.
template <int Dim>
std::vector<Metric<Dim>> spots(std::size_t vertices, std::uint64_t seed, double anisotropy) {
  Random random(seed);
  std::vector<Metric<Dim>> metric_of(vertices, isotropic<Dim>(1));
  for (std::size_t v = 0; v < vertices; v += 37)
    metric_of[v] = 1e4 * random_metric<Dim>(random, anisotropy);
  return metric_of;
}

template <int Dim>
constexpr std::uint32_t cells = Dim == 2 ? 30 : 8;

TYPED_TEST(MetricOperations, GradationBoundsGrowthAlongEveryEdge) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  for (const double factor : {1.1, 1.3, 2.0}) {
    for (const double anisotropy : {1.0, 20.0, 1e3}) {
      const auto before = spots<Dim>(mesh.vertex_slots(), 7, anisotropy);
      auto metric_of = before;
      const GradationReport report = limit_gradation(executor, metric_of, mesh, {.factor = factor});
      EXPECT_TRUE(report.converged);
      EXPECT_GT(report.raised, 0U);
      EXPECT_GT(worst_excess(mesh, before, factor), 1);
      EXPECT_LT(worst_excess(mesh, metric_of, factor), 1.1e-3);
      Random random(8);
      for (std::size_t v = 0; v < before.size(); ++v)
        expect_no_coarser(metric_of[v], before[v], random_direction<Dim>(random));
    }
  }
}

TYPED_TEST(MetricOperations, GradationIsTheSameOnBothKindsOfMesh) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  const auto fixed =
      make_fixed_mesh<Dim>(executor, take_apart(executor, grid_mesh<Dim>(cells<Dim>)).mesh);
  renumber(executor, mesh);  // the order that results from taking it apart
  auto metric_of = spots<Dim>(mesh.vertex_slots(), 7, 20);
  auto other_of = metric_of;
  limit_gradation(executor, metric_of, mesh, {.factor = 1.3});
  limit_gradation(executor, other_of, fixed, {.factor = 1.3});
  EXPECT_EQ(metric_of, other_of);
  other_of.pop_back();
  EXPECT_THROW(limit_gradation(executor, other_of, fixed), InputError);
}

TYPED_TEST(MetricOperations, IntersectsAtEveryVertex) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 3});
  const auto a = spots<Dim>(2000, 1, 20), b = spots<Dim>(2000, 2, 5);
  auto both = a;
  intersect(executor, both, b);
  for (std::size_t v = 0; v < a.size(); ++v) EXPECT_EQ(both[v], intersect(a[v], b[v]));
  both.pop_back();
  EXPECT_THROW(intersect(executor, both, b), InputError);
}

TYPED_TEST(MetricOperations, GradationOfSizesFollowsTheDistance) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  std::vector<Metric<Dim>> metric_of(mesh.vertex_slots(), isotropic<Dim>(10));
  metric_of[0] = isotropic<Dim>(0.01);
  const double factor = 1.5;
  limit_gradation(Executor({.threads = 1}), metric_of, mesh, {.factor = factor, .tolerance = 0});
  // Along an edge of length |pq| and metric length l = |pq| / h, a size h grows by h l ln(factor).
  for (std::uint32_t i = 0; i <= cells<Dim>; ++i) {
    const double size = 0.01 + std::log(factor) * i / cells<Dim>;
    EXPECT_NEAR(1 / std::sqrt(metric_of[i].m[0]), size, 1e-9);
  }
}

TYPED_TEST(MetricOperations, GradationLeavesASmoothFieldAlone) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  std::vector<Metric<Dim>> metric_of(mesh.vertex_slots());
  for (std::size_t v = 0; v < metric_of.size(); ++v) {
    const Vector<Dim>& x = mesh.site_of[v].position;
    PrincipalAxes<Dim> axes = principal_axes(isotropic<Dim>(0.05 + 0.1 * x[0]));
    axes.value[0] *= 25;
    metric_of[v] = compose(axes);
  }
  const auto before = metric_of;
  const GradationReport report = limit_gradation(Executor({.threads = 1}), metric_of, mesh);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.raised, 0U);
  EXPECT_EQ(metric_of, before);
}

TYPED_TEST(MetricOperations, GradationLeavesAUniformFieldAloneHoweverStretched) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim> / 2);
  Random random(9);
  for (const double anisotropy : {1.0, 1e4, 1e8}) {
    for (int trial = 0; trial < 10; ++trial) {
      std::vector<Metric<Dim>> metric_of(mesh.vertex_slots(),
                                         random_metric<Dim>(random, anisotropy));
      const auto before = metric_of;
      for (const double factor : {1.0, 1.3}) {
        limit_gradation(Executor({.threads = 1}), metric_of, mesh, {.factor = factor});
        EXPECT_EQ(metric_of, before);
      }
    }
  }
}

// Across the short axis both sizes grow by the law, from vertex to vertex.
TYPED_TEST(MetricOperations, GradationOfStretchedSizesFollowsTheMixedLaw) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  for (const double factor : {1.1, 1.3, 2.0}) {
    double across = 0.001, along = 0.1;
    PrincipalAxes<Dim> axes = principal_axes(isotropic<Dim>(along));
    for (std::size_t i = 0; i < Dim; ++i) axes.vector[i] = {}, axes.vector[i].x[i] = 1;
    axes.value[0] = 1 / (across * across);
    std::vector<Metric<Dim>> metric_of(mesh.vertex_slots(), isotropic<Dim>(10));
    metric_of[0] = compose(axes);
    limit_gradation(Executor({.threads = 1}), metric_of, mesh, {.factor = factor, .tolerance = 0});
    const double edge = 1.0 / cells<Dim>, rate = std::log(factor);
    for (std::uint32_t i = 0; i <= cells<Dim>; ++i) {
      EXPECT_NEAR(1 / std::sqrt(metric_of[i](0, 0)), across, 1e-9) << factor << ' ' << i;
      const double found = 1 / std::sqrt(metric_of[i](1, 1));  // less if from another path
      EXPECT_LT(found, along * (1 + 1e-9)) << factor << ' ' << i;
      EXPECT_GT(found, i == 0 ? 0.099 : 1.2 * across)
          << factor << ' ' << i << ": the sizes along have lost their stretch";
      const double g = 1 + edge / across * rate, g_along = 1 + edge / along * rate;
      across *= g;
      along *= std::pow(g, 7.0 / 8) * std::pow(g_along, 1.0 / 8);
    }
  }
}

TYPED_TEST(MetricOperations, GradationIsTheSameAtEachThreadCount) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(Dim == 2 ? 60 : 12);
  const auto start = spots<Dim>(mesh.vertex_slots(), 11, 100);
  auto one = start;
  const GradationReport report = limit_gradation(Executor({.threads = 1}), one, mesh);
  for (const int threads : test::thread_counts) {
    auto many = start;
    const GradationReport again = limit_gradation(Executor({.threads = threads}), many, mesh);
    EXPECT_EQ(many, one);
    EXPECT_EQ(again.sweeps, report.sweeps);
    EXPECT_EQ(again.raised, report.raised);
  }
}

/// Many intersections of anisotropic metrics must not add up to sizes that no metric asked for.
TYPED_TEST(MetricOperations, GradationComesToAnEndOnWildMetrics) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  Random random(12);
  for (const double factor : {1.02, 1.3}) {
    for (const double anisotropy : {10.0, 1e4}) {
      std::vector<Metric<Dim>> metric_of(mesh.vertex_slots());
      for (Metric<Dim>& metric : metric_of) metric = 1e6 * random_metric<Dim>(random, anisotropy);
      const auto report =
          limit_gradation(Executor({.threads = 1}), metric_of, mesh, {.factor = factor});
      EXPECT_TRUE(report.converged);
      EXPECT_LT(worst_excess(mesh, metric_of, factor), 1.1e-3);
      for (const Metric<Dim>& metric : metric_of)
        for (const double value : principal_axes(metric).value) {
          EXPECT_GT(value, 0);
          EXPECT_LT(value, 1.2001e6);
        }
    }
  }
}

TYPED_TEST(MetricOperations, GradationStopsAtTheBoundOnSweeps) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = grid_mesh<Dim>(cells<Dim>);
  auto metric_of = spots<Dim>(mesh.vertex_slots(), 13, 1);
  const GradationReport report =
      limit_gradation(Executor({.threads = 1}), metric_of, mesh, {.factor = 1.1, .sweeps = 1});
  EXPECT_EQ(report.sweeps, 1);
  EXPECT_FALSE(report.converged);
}

TYPED_TEST(MetricOperations, SayWhatIsWrong) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Mesh<Dim> mesh = grid_mesh<Dim>(2);
  std::vector<Metric<Dim>> metric_of(mesh.vertex_slots(), isotropic<Dim>(1));
  EXPECT_THROW(bound_sizes(executor, metric_of, {.smallest = -1}), InputError);
  EXPECT_THROW(bound_sizes(executor, metric_of, {.largest = nan}), InputError);
  EXPECT_THROW(bound_sizes(executor, metric_of, {.smallest = 2, .largest = 1}), InputError);
  EXPECT_THROW(limit_gradation(executor, metric_of, mesh, {.factor = 0.9}), InputError);
  EXPECT_THROW(limit_gradation(executor, metric_of, mesh, {.factor = nan}), InputError);
  metric_of.pop_back();
  EXPECT_THROW(limit_gradation(executor, metric_of, mesh), InputError);
}

/// Fastest growth of sizes per unit of metric length along an edge of an adapted mesh.
double fastest_growth(const AdaptedMesh& adapted) {
  const auto size = [&](std::uint32_t v) { return 1 / std::sqrt(adapted.metric.values[3 * v]); };
  double fastest = 0;
  for (const auto& corners : adapted.mesh.triangles.vertices)
    for (const std::uint32_t p : corners)
      for (const std::uint32_t q : corners) {
        const double* const x = &adapted.mesh.coordinates[2 * p];
        const double* const y = &adapted.mesh.coordinates[2 * q];
        const double distance = std::hypot(x[0] - y[0], x[1] - y[1]);
        if (p != q) fastest = std::max(fastest, (size(q) - size(p)) / distance);
      }
  return std::exp(fastest);
}

TEST(AdaptToMetric, GradationAndBoundsAreThoseOfTheOptions) {
  const Executor executor({.threads = 1});
  const AnyMesh mesh = grid<2>(20);
  AnyField metric{2, mesh.vertex_count(), {AnyField::Type::symmetric}, {}, "sizes"};
  for (std::size_t v = 0; v < metric.vertex_count; ++v) {
    const double size = mesh.coordinates[2 * v] < 0.5 ? 0.01 : 0.2;
    const Metric<2> tensor = isotropic<2>(size);
    metric.values.insert(metric.values.end(), tensor.m.begin(), tensor.m.end());
  }
  AdaptOptions options;
  options.make.complete_boundary = true;
  options.smallest_size = 0.02;
  EXPECT_GT(fastest_growth(adapt(executor, mesh, metric, options)), 5);
  options.gradation = 1.3;
  const AdaptedMesh graded = adapt(executor, mesh, metric, options);
  EXPECT_LT(fastest_growth(graded), 1.6);  // interpolated between the vertices of the input
  for (std::size_t v = 0; v < graded.metric.vertex_count; ++v)
    EXPECT_LT(graded.metric.values[3 * v], 2500 * (1 + 1e-9));
  options.gradation = 0.5;
  EXPECT_THROW(adapt(executor, mesh, metric, options), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::metric_operations_test
