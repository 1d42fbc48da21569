// Sizes taken from required entities: the resulting metric, edge by edge, and its benefit for the
// mesh beside frozen interfaces of other sizes than the metric asks for.

#include "metric/required_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/determinant.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::required_sizes_test {
namespace {

using runtime::Executor;
using test::chance;
using test::Random;
using test::uniform;

template <class T>
class RequiredSizes : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RequiredSizes, Dimensions, );

template <int Dim>
Mesh<Dim> made(const AnyMesh& any, const MakeMeshOptions& options = {}) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  return make_mesh<Dim>(Executor({.threads = 1}), any, options, neighbours, warnings);
}

template <int Dim>
std::vector<std::uint32_t>& required_facets(AnyMesh& mesh) {
  return Dim == 2 ? mesh.required_edges : mesh.required_triangles;
}
template <int Dim>
std::vector<std::uint32_t>& required_elements(AnyMesh& mesh) {
  return Dim == 2 ? mesh.required_triangles : mesh.required_tetrahedra;
}

/// A mesh with required entities: the interface between regions, a side of the boundary, or the
/// elements of a region. It is stretched by up to this factor along an axis.
template <int Dim>
AnyMesh frozen_mesh(Random& random, int n, double stretch, std::string& what,
                    double jiggling = 0.3) {
  test::Grid grid = test::unit_grid(Dim, n);
  grid.seed = random();
  const std::size_t kind = test::below(random, 4);
  grid.region = kind == 1   ? test::random_regions(random(), 2, false)
                : kind == 2 ? test::whole
                            : test::two_halves(n);
  for (double& x : grid.lines[1]) x /= stretch;
  AnyMesh mesh = test::make_grid(grid);
  test::jiggle(mesh, random, jiggling);
  auto& facets = required_facets<Dim>(mesh);
  const auto& references = test::facets<Dim>(mesh).reference;
  for (std::uint32_t f = 0; f < references.size(); ++f)
    if (kind == 2 ? references[f] == 1 : kind < 2 && references[f] > 10) facets.push_back(f);
  if (kind == 3)
    for (std::uint32_t e = 0; e < elements_in<Dim>(mesh).size(); ++e)
      if (elements_in<Dim>(mesh).reference[e] == 2) required_elements<Dim>(mesh).push_back(e);
  test::place(mesh, random, chance(random, 0.3) ? 1e-4 : 1, 0);
  what = std::to_string(Dim) + "D, n " + std::to_string(n) + ", kind " + std::to_string(kind);
  return mesh;
}

// ---- The metric ----

/// Sizes carried from the marked vertices along edges of the mesh: the least, or for a negative
/// slope the greatest, size + slope * distance.
template <int Dim>
std::vector<double> carried(const AnyMesh& mesh, const std::vector<double>& size_of,
                            const std::vector<bool>& is_source, double slope) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<double> reached(size_of.size(), far);  // negative sizes where these fall
  const double sign = slope > 0 ? 1 : -1;
  std::vector<std::set<std::uint32_t>> next(size_of.size());
  for (const auto& corners : elements_in<Dim>(mesh).vertices)
    for (const auto a : corners) next[a].insert(corners.begin(), corners.end());
  using Place = std::pair<double, std::uint32_t>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> front;
  for (std::uint32_t v = 0; v < size_of.size(); ++v)
    if (is_source[v]) front.push({reached[v] = sign * size_of[v], v});
  while (!front.empty()) {
    const auto [value, v] = front.top();
    front.pop();
    if (value > reached[v]) continue;
    for (const auto w : next[v]) {
      const double there =
          value + std::abs(slope) * norm(position_in<Dim>(mesh, w) - position_in<Dim>(mesh, v));
      if (there >= reached[w]) continue;
      front.push({reached[w] = there, w});
    }
  }
  for (double& size : reached) size *= sign;
  return reached;
}

template <int Dim>
double size_in(const Metric<Dim>& metric) {
  return std::pow(determinant(metric), -1.0 / (2 * Dim));
}

/// The longest size over the shortest.
template <int Dim>
double stretch_of(const Metric<Dim>& metric) {
  const auto value = principal_axes(metric).value;
  const auto [least, most] = std::minmax_element(value.begin(), value.end());
  return std::sqrt(*most / *least);
}

template <int Dim>
std::vector<bool> vertices_of_required(AnyMesh& mesh) {
  std::vector<bool> found(mesh.vertex_count());
  for (const auto f : required_facets<Dim>(mesh))
    for (const auto v : facets_in<Dim>(mesh).vertices[f]) found[v] = true;
  for (const auto e : required_elements<Dim>(mesh))
    for (const auto v : elements_in<Dim>(mesh).vertices[e]) found[v] = true;
  return found;
}

TYPED_TEST(RequiredSizes, GrowAndFallFromWhatIsRequired) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  int compared = 0, finer = 0, coarser = 0, left = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::string what;
    AnyMesh any = frozen_mesh<Dim>(random, Dim == 2 ? 12 : 6, 1, what, 0.1);
    const std::vector<bool> is_source = vertices_of_required<Dim>(any);
    const double edge = norm(position_in<Dim>(any, elements_in<Dim>(any).vertices[0][0]) -
                             position_in<Dim>(any, elements_in<Dim>(any).vertices[0][1]));
    std::vector<Metric<Dim>> asked;
    for (std::size_t v = 0; v < any.vertex_count(); ++v)
      asked.push_back(isotropic<Dim>(edge * std::pow(10, uniform(random, -0.8, 0.8))));
    const double factor = uniform(random, 1.1, 3), rate = std::log(factor);
    std::vector<Metric<Dim>> metric_of = asked;
    EXPECT_TRUE(take_required_sizes(executor, made<Dim>(any), factor, metric_of).converged);
    std::vector<double> size_of;
    for (const auto& metric : metric_of) size_of.push_back(size_in(metric));
    bool isotropic_sources = true;
    for (std::size_t v = 0; v < size_of.size(); ++v)
      isotropic_sources &= !is_source[v] || stretch_of(metric_of[v]) < 1.02;
    if (!isotropic_sources) continue;
    ++compared;
    const auto most = carried<Dim>(any, size_of, is_source, rate);
    const auto least = carried<Dim>(any, size_of, is_source, -rate);
    for (std::size_t v = 0; v < size_of.size(); ++v) {
      if (is_source[v]) continue;
      const double before = size_in(asked[v]);
      const double expected = std::min(std::max(before, least[v]), most[v]);
      EXPECT_NEAR(size_of[v], expected, 0.01 * expected) << what << ", vertex " << v;
      (expected < before ? finer : expected > before ? coarser : left) += 1;
      if (before < 0.99 * most[v] && before > 1.01 * least[v]) {
        EXPECT_EQ(metric_of[v], asked[v]);
      }
    }
  }
  EXPECT_GT(compared, 10);
  EXPECT_GT(finer, 100);
  EXPECT_GT(coarser, 40);
  EXPECT_GT(left, 100);
}

/// Many intersections of anisotropic metrics, or of squared sizes, must not add up to sizes that
/// neither the metric nor a required entity has.
TYPED_TEST(RequiredSizes, ComeToAnEndOnWildMetrics) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const auto eigenvalues_in = [](const std::vector<Metric<Dim>>& metric_of) {
    std::pair<double, double> range{std::numeric_limits<double>::infinity(), 0};
    for (const auto& metric : metric_of)
      for (const double value : principal_axes(metric).value)
        range = {std::min(range.first, value), std::max(range.second, value)};
    return range;
  };
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 16 : 5));
    const double share = seed % 3 == 0 ? 0.5 : 0.1;
    for (std::uint32_t e = 0; e < elements_in<Dim>(any).size(); ++e)
      if (chance(random, share)) required_elements<Dim>(any).push_back(e);
    const std::vector<bool> is_source = vertices_of_required<Dim>(any);
    std::vector<Metric<Dim>> metric_of, from_required;
    for (std::size_t v = 0; v < any.vertex_count(); ++v) {
      std::array<double, Dim> sizes;
      for (double& size : sizes) size = std::pow(10, uniform(random, seed % 2 == 0 ? -4 : -1, 0));
      metric_of.push_back(test::random_metric<Dim>(random, sizes));
    }
    const auto asked = eigenvalues_in(metric_of);
    const double factor = seed % 4 < 2 ? 1.02 : 2;
    EXPECT_TRUE(take_required_sizes(executor, made<Dim>(any), factor, metric_of).converged);
    for (std::size_t v = 0; v < metric_of.size(); ++v)
      if (is_source[v]) from_required.push_back(metric_of[v]);
    const auto required = eigenvalues_in(from_required), all = eigenvalues_in(metric_of);
    SCOPED_TRACE(seed);
    EXPECT_LT(all.second, 1.2001 * std::max(asked.second, required.second));
    EXPECT_GT(all.first, std::min(asked.first, required.first) / 1.2001);
  }
}

// ---- Benefits ----

/// A metric with sizes like the edges of a frozen mesh, times `ratio`.
template <int Dim>
AnyField metric_for(const AnyMesh& mesh, Random& random, double ratio, double stretch) {
  std::array<double, Dim> sizes;
  double volume = 0;
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    std::array<Vector<Dim>, Dim + 1> p;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = position_in<Dim>(mesh, corners[i]);
    volume += std::abs(plain_determinant(p)) / static_cast<double>(elements_in<Dim>(mesh).size());
  }
  sizes.fill(ratio * std::pow(volume, 1.0 / Dim) * std::pow(stretch, 1.0 / Dim));
  sizes[0] /= stretch;
  const Metric<Dim> metric = test::random_metric<Dim>(random, sizes);
  return test::metric_field<Dim>(mesh, [&](auto) { return metric; });
}

/// The expectations below held for 100 seeds in each dimension.
template <int Dim>
void freeze(std::uint64_t seed) {
  Random random(seed);
  std::string what;
  const bool easy = seed % 3 != 0;  // neither the interface nor the metric is stretched
  const int n = Dim == 2 ? 6 + static_cast<int>(seed % 7) : 3 + static_cast<int>(seed % 3);
  const AnyMesh mesh = frozen_mesh<Dim>(random, n, easy ? 1 : 5, what, easy ? 0 : 0.2);
  const bool crowded = !easy && what.back() == '1';  // stretched edges in all directions meet
  const double ratio = std::pow(10, uniform(random, Dim == 2 ? -1.2 : -0.6, 1));
  const AnyField metric = metric_for<Dim>(mesh, random, ratio, easy ? 1 : 4);
  const Executor executor({.threads = 1});
  const AdaptedMesh as_asked = adapt(executor, mesh, metric);
  const AdaptedMesh taken =
      adapt(executor, mesh, metric, {.required_gradation = seed % 2 == 0 ? 1.5 : 2.3});
  SCOPED_TRACE(what + ", ratio " + std::to_string(ratio));
  EXPECT_EQ(test::joined(test::faults_of(executor, mesh, taken)), "");
  EXPECT_TRUE(taken.report.warnings.empty());
  const auto before = measure(executor, as_asked.mesh, &as_asked.metric).quality;
  const auto after = measure(executor, taken.mesh, &taken.metric).quality;
  EXPECT_GE(after.mean, before.mean - 0.1);
  if (crowded) return;
  EXPECT_GE(after.min, easy ? 0.4 : 0.3);
  EXPECT_GE(after.mean, easy ? 0.7 : 0.65);
}

TYPED_TEST(RequiredSizes, LeaveRoomForGoodElementsBesideWhatIsFrozen) {
  if (test::address_sanitized && TypeParam::value == 3) GTEST_SKIP();
  const std::uint64_t begin = test::first_trial();
  for (std::uint64_t seed = begin; seed < begin + test::trials(10); ++seed) {
    SCOPED_TRACE(seed);
    freeze<TypeParam::value>(seed);
  }
}

/// Slivers, needles and metrics that vary from vertex to vertex: results are valid, and hardly any
/// is worse than without.
TEST(RequiredSizesOfAll, LeaveNastyCasesValid) {
  const Executor executor({.threads = 1});
  double before = 0, after = 0;
  for (std::uint64_t seed = 0, ran = 0; ran < test::trials(16); ++seed) {
    test::RandomCase one = test::random_case(seed);
    if (one.options.make.lock_boundary) test::require_facets(one.mesh);
    if (one.mesh.required_edges.empty() && one.mesh.required_triangles.empty() &&
        one.mesh.required_tetrahedra.empty())
      continue;
    ++ran;
    SCOPED_TRACE(std::to_string(seed) + ": " + one.what);
    const AdaptedMesh as_asked = adapt(executor, one.mesh, one.metric, one.options);
    one.options.required_gradation = 2;
    const AdaptedMesh taken = adapt(executor, one.mesh, one.metric, one.options);
    EXPECT_EQ(test::joined(test::faults_of(executor, one.mesh, taken)), "");
    const auto size = [](const AnyMesh& mesh) {
      return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
    };
    EXPECT_LT(size(taken.mesh), 5 * size(as_asked.mesh) + 20000);
    before += measure(executor, as_asked.mesh, &as_asked.metric).quality.mean;
    after += measure(executor, taken.mesh, &taken.metric).quality.mean;
  }
  EXPECT_GE(after, before);
}

/// Required edges of 0.2 in a metric of 0.02, as between the parts of a mesh that is adapted in
/// parts.
TEST(RequiredSizes3D, LetAnInterfaceBeFrozenThatIsFarTooCoarse) {
  AnyMesh mesh = test::make_grid(test::unit_grid(3, 5));
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    if (mesh.triangles.reference[f] == 2) mesh.required_triangles.push_back(f);
  const AnyField metric = test::metric_field<3>(mesh, [&](std::uint32_t v) {
    return isotropic<3>(0.02 + 0.15 * (1 - position_in<3>(mesh, v)[0]));
  });
  const Executor executor({.threads = 1});
  const AdaptedMesh adapted = adapt(executor, mesh, metric, {.required_gradation = 2.3});
  EXPECT_TRUE(adapted.report.converged);
  const auto quality = measure(executor, adapted.mesh, &adapted.metric).quality;
  EXPECT_GE(quality.min, 0.5);
  EXPECT_GE(quality.mean, 0.8);
  EXPECT_EQ(test::joined(test::faults_of(executor, mesh, adapted)), "");
}

// ---- Entities that count as required ----

/// Sizes at the vertices of a grid with cells of 0.1 or 0.2 where the metric asks for 1.
template <int Dim>
std::vector<Metric<Dim>> taken_from(const AnyMesh& any, const MakeMeshOptions& options = {}) {
  std::vector<Metric<Dim>> metric_of(any.vertex_count(), isotropic<Dim>(1));
  const Executor executor({.threads = 1});
  EXPECT_TRUE(take_required_sizes(executor, made<Dim>(any, options), 1.5, metric_of).converged);
  return metric_of;
}

TYPED_TEST(RequiredSizes, AreTakenFromAllThatIsRequiredAndNothingElse) {
  constexpr int Dim = TypeParam::value;
  const int n = Dim == 2 ? 10 : 5;
  const AnyMesh plain = test::make_grid(test::unit_grid(Dim, n));
  const std::vector<Metric<Dim>> untouched(plain.vertex_count(), isotropic<Dim>(1));
  EXPECT_EQ(taken_from<Dim>(plain), untouched);

  AnyMesh mesh = plain;
  mesh.required_vertices = {0};  // none of its edges is required
  EXPECT_EQ(taken_from<Dim>(mesh), untouched);
  const std::uint32_t other = elements_in<Dim>(mesh).vertices[0][0] == 0
                                  ? elements_in<Dim>(mesh).vertices[0][1]
                                  : elements_in<Dim>(mesh).vertices[0][0];
  mesh.required_vertices = {0, other};
  const double edge = norm(position_in<Dim>(mesh, 0) - position_in<Dim>(mesh, other));
  const auto from_vertices = taken_from<Dim>(mesh);
  for (const std::uint32_t v : mesh.required_vertices)
    EXPECT_NEAR(size_in(from_vertices[v]), edge, 0.01 * edge);

  mesh = plain;
  for (std::uint32_t f = 0; f < test::facets<Dim>(mesh).size(); ++f)
    required_facets<Dim>(mesh).push_back(f);
  const auto from_facets = taken_from<Dim>(mesh);
  EXPECT_EQ(taken_from<Dim>(plain, {.lock_boundary = true}), from_facets);
  for (const std::uint32_t v : facets_in<Dim>(mesh).vertices[0])
    EXPECT_NEAR(size_in(from_facets[v]), 1.0 / n, 0.15 / n);

  mesh = plain;
  required_elements<Dim>(mesh) = {0};
  const auto from_element = taken_from<Dim>(mesh);
  EXPECT_LT(size_in(from_element[elements_in<Dim>(mesh).vertices[0][0]]), 1.3 / n);

  if constexpr (Dim == 3) {
    mesh = plain;
    mesh.edges.add({mesh.triangles.vertices[0][0], mesh.triangles.vertices[0][1]}, 7);
    mesh.required_edges = {0};
    const auto from_edge = taken_from<3>(mesh);
    const auto [a, b] = mesh.edges.vertices[0];
    const double length = norm(position_in<3>(mesh, a) - position_in<3>(mesh, b));
    EXPECT_NEAR(size_in(from_edge[a]), length, 0.01 * length);
  }
}

/// A mesh that is adapted to a stretched metric keeps it where it is frozen.
TYPED_TEST(RequiredSizes, LeaveAloneWhatFitsAlready) {
  constexpr int Dim = TypeParam::value;
  test::Grid grid = test::unit_grid(Dim, Dim == 2 ? 20 : 8);
  for (double& x : grid.lines[0]) x /= 100;
  AnyMesh mesh = test::make_grid(grid);
  test::require_facets(mesh);
  Metric<Dim> metric = isotropic<Dim>(1.1 / (Dim == 2 ? 20 : 8));
  metric.m[0] *= 1e4;
  std::vector<Metric<Dim>> metric_of(mesh.vertex_count(), metric);
  take_required_sizes(Executor({.threads = 1}), made<Dim>(mesh), 2, metric_of);
  for (const Metric<Dim>& taken : metric_of) EXPECT_LT(test::difference(metric, taken), 0.35);
}

TYPED_TEST(RequiredSizes, AreTheSameAtEachThreadCount) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  std::string what;
  const AnyMesh mesh = frozen_mesh<Dim>(random, Dim == 2 ? 30 : 7, 3, what);
  std::vector<Metric<Dim>> asked;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    asked.push_back(test::random_metric<Dim>(random, [&] {
      std::array<double, Dim> sizes;
      for (double& size : sizes) size = std::pow(10, uniform(random, -3, 0));
      return sizes;
    }()));
  std::vector<Metric<Dim>> first;
  for (const int threads : {1, 2, 8}) {
    std::vector<Metric<Dim>> metric_of = asked;
    take_required_sizes(Executor({.threads = threads}), made<Dim>(mesh), 2, metric_of);
    if (first.empty()) first = metric_of;
    EXPECT_EQ(metric_of, first);
  }
  EXPECT_NE(first, asked);
}

TEST(RequiredSizes2D, RefuseAFactorThatMakesNoSense) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(2, 2));
  const AnyField metric = test::metric_field<2>(mesh, [](auto) { return isotropic<2>(0.3); });
  const Executor executor({.threads = 1});
  for (const double factor :
       {0.5, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    try {
      adapt(executor, mesh, metric, {.required_gradation = factor});
      ADD_FAILURE() << factor << " is taken";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string_view(error.what()).substr(0, 19), "required_gradation:");
    }
  EXPECT_NO_THROW(adapt(executor, mesh, metric, {.required_gradation = -1}));
}

}  // namespace
}  // namespace ductile::meshadapt::required_sizes_test
