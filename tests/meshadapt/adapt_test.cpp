#include "ductile/meshadapt/adapt.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::adapt_test {
namespace {

using runtime::Executor;
using test::bits;
using test::Random;

/// Every test runs for both dimensions.
class Adapt : public testing::TestWithParam<int> {
 protected:
  int dimension() const { return GetParam(); }
  std::size_t element_count(const AnyMesh& mesh) const {
    return dimension() == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  }
  /// Two regions with a listed interface, ridges, and some of everything required.
  AnyMesh rich_mesh() const {
    test::Grid grid = test::unit_grid(dimension(), 6);
    grid.region = test::two_halves(6);
    AnyMesh mesh = test::make_grid(grid);
    if (dimension() == 3) test::list_ridges(mesh);
    Random random(7);
    test::jiggle(mesh, random, 0.2);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      mesh.vertex_reference[v] = static_cast<std::int32_t>(v % 3);
    mesh.required_vertices = {3, 40};
    mesh.required_edges = {1, 5};
    mesh.required_triangles = {2, 9};
    if (dimension() == 3) mesh.required_tetrahedra = {4, 77};
    return mesh;
  }
  AnyField layered(const AnyMesh& mesh, double complexity) const {
    Random random(3);
    AnyField field = test::layer_field(mesh, random, 0.05);
    test::scale_to(field, mesh, complexity);
    return field;
  }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, Adapt, testing::Values(2, 3),
                         [](const auto& at) { return std::to_string(at.param) + "D"; });

void expect_identical(const AdaptedMesh& a, const AdaptedMesh& b) {
  EXPECT_EQ(bits(a.mesh.coordinates), bits(b.mesh.coordinates));
  EXPECT_EQ(bits(a.metric.values), bits(b.metric.values));
  EXPECT_EQ(a.mesh.vertex_reference, b.mesh.vertex_reference);
  EXPECT_EQ(a.mesh.edges.vertices, b.mesh.edges.vertices);
  EXPECT_EQ(a.mesh.edges.reference, b.mesh.edges.reference);
  EXPECT_EQ(a.mesh.triangles.vertices, b.mesh.triangles.vertices);
  EXPECT_EQ(a.mesh.triangles.reference, b.mesh.triangles.reference);
  EXPECT_EQ(a.mesh.tetrahedra.vertices, b.mesh.tetrahedra.vertices);
  EXPECT_EQ(a.mesh.tetrahedra.reference, b.mesh.tetrahedra.reference);
  EXPECT_EQ(a.mesh.corners, b.mesh.corners);
  EXPECT_EQ(a.mesh.ridges, b.mesh.ridges);
  EXPECT_EQ(a.mesh.required_vertices, b.mesh.required_vertices);
  EXPECT_EQ(a.mesh.required_edges, b.mesh.required_edges);
  EXPECT_EQ(a.mesh.required_triangles, b.mesh.required_triangles);
  EXPECT_EQ(a.mesh.required_tetrahedra, b.mesh.required_tetrahedra);
}

TEST_P(Adapt, TellsWhereItsTimeWent) {
  const AnyMesh mesh = rich_mesh();
  const AdaptReport report = adapt(Executor({.threads = 2}), mesh, layered(mesh, 400)).report;
  double kernels = 0;
  for (const KernelReport& kernel : {report.coarsen, report.refine, report.swap, report.smooth}) {
    const double rounds = kernel.conflict_seconds + kernel.plan_seconds + kernel.apply_seconds +
                          kernel.commit_seconds + kernel.wake_seconds;
    EXPECT_GT(rounds, 0);
    EXPECT_LE(rounds, kernel.seconds);
    kernels += kernel.seconds;
  }
  EXPECT_LE(kernels + report.setup_seconds + report.renumber_seconds, report.total_seconds);
}

TEST_P(Adapt, KeepsRegionsInterfacesReferencesAndWhatIsRequired) {
  const AnyMesh mesh = rich_mesh();
  for (const double complexity : {20.0, 600.0}) {
    const Executor executor({.threads = 2});
    const AdaptedMesh result = adapt(executor, mesh, layered(mesh, complexity));
    const auto faults = test::faults_of(executor, mesh, result);
    EXPECT_TRUE(faults.empty()) << test::joined(faults);
  }
}

TEST_P(Adapt, GivesTheSameBytesAtEachThreadCountAndInEachRun) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = layered(mesh, dimension() == 2 ? 2000 : 500);
  const AdaptedMesh first = adapt(Executor({.threads = 1}), mesh, metric);
  EXPECT_GT(element_count(first.mesh), element_count(mesh));
  for (const int threads : {1, 2, 2, 3, 4, 8}) {
    SCOPED_TRACE(threads);
    expect_identical(first, adapt(Executor({.threads = threads}), mesh, metric));
  }
}

TEST_P(Adapt, GivesTheSameBytesByColours) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = layered(mesh, 500);
  const AdaptOptions options{.by_colours = true};
  const AdaptedMesh first = adapt(Executor({.threads = 1}), mesh, metric, options);
  const auto faults = test::faults_of(Executor(), mesh, first);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  for (const int threads : test::thread_counts) {
    SCOPED_TRACE(threads);
    expect_identical(first, adapt(Executor({.threads = threads}), mesh, metric, options));
  }
}

TEST_P(Adapt, IsValidInArrivalOrder) {
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = layered(mesh, 500);
  for (const int threads : {1, 2, 4, 8}) {
    const Executor executor({.threads = threads, .deterministic = false});
    const AdaptedMesh result = adapt(executor, mesh, metric);
    const auto faults = test::faults_of(executor, mesh, result);
    EXPECT_TRUE(faults.empty()) << test::joined(faults);
  }
}

TEST_P(Adapt, MeetsAUniformSize) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 3));
  AnyField metric = constant_metric(mesh, dimension() == 2 ? 0.02 : 0.06);
  const Executor executor({.threads = 2});
  const AdaptedMesh result = adapt(executor, mesh, metric);
  const MeshStatistics statistics = measure(executor, result.mesh, &result.metric);
  EXPECT_GT(statistics.share_in_range(), dimension() == 2 ? 0.97 : 0.9);
  EXPECT_GT(statistics.quality.mean, dimension() == 2 ? 0.93 : 0.78);
  EXPECT_GT(statistics.quality.min, dimension() == 2 ? 0.3 : 0.05);
}

/// Asks for edges of length `along`, and `across` in one direction, oblique to the mesh.
AnyField sheets(const AnyMesh& mesh, double along, double across) {
  const std::array<double, 3> normal =
      mesh.dimension == 2 ? std::array{0.8, 0.6, 0.0} : std::array{2. / 3, 1. / 3, 2. / 3};
  AnyField field = constant_metric(mesh, along);
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t at = 0; at < field.values.size();)
    for (std::size_t column = 0; column < dimension; ++column)
      for (std::size_t row = 0; row <= column; ++row, ++at)
        field.values[at] +=
            (1 / (across * across) - 1 / (along * along)) * normal[row] * normal[column];
  return field;
}

/// A mesh with a closed crack inside, whose sides share their rim and have reference 9.
AnyMesh cracked(int dimension) {
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension, 4));
  const auto axes = static_cast<std::size_t>(dimension);
  const auto on_crack = [&](std::uint32_t v, double margin) {
    const double* at = &mesh.coordinates[v * axes];
    return at[axes - 1] == 0.5 && std::all_of(at, at + axes - 1, [&](double x) {
             return std::abs(x - 0.5) < 0.25 + margin;
           });
  };
  std::vector<std::uint32_t> twin(mesh.vertex_count());
  for (std::uint32_t v = 0; v < twin.size(); ++v) {
    twin[v] = v;
    if (!on_crack(v, -0.01)) continue;
    twin[v] = static_cast<std::uint32_t>(mesh.vertex_count());
    for (std::size_t i = 0; i < axes; ++i)
      mesh.coordinates.push_back(mesh.coordinates[v * axes + i]);
    mesh.vertex_reference.push_back(0);
  }
  const auto split = [&](auto& elements, auto& facets) {
    for (auto& corners : elements.vertices) {
      const auto is_above = [&](std::uint32_t v) {
        return mesh.coordinates[v * axes + axes - 1] > 0.5;
      };
      const bool above = std::any_of(corners.begin(), corners.end(), is_above);
      typename std::decay_t<decltype(facets)>::value_type facet;
      std::size_t count = 0, inside = 0;
      for (const std::uint32_t v : corners) {
        if (!on_crack(v, 0.01)) continue;
        inside += twin[v] != v;
        facet[count++ % axes] = above ? twin[v] : v;
      }
      if (above)
        for (std::uint32_t& v : corners) v = v < twin.size() ? twin[v] : v;
      if (count == axes && inside > 0) facets.push_back(facet);
    }
  };
  if (dimension == 2)
    split(mesh.triangles, mesh.edges.vertices);
  else
    split(mesh.tetrahedra, mesh.triangles.vertices);
  mesh.edges.reference.resize(mesh.edges.size(), 9);
  mesh.triangles.reference.resize(mesh.triangles.size(), dimension == 2 ? 1 : 9);
  return mesh;
}

TEST_P(Adapt, LeavesClosedCracksOpen) {
  const AnyMesh mesh = cracked(dimension());
  for (const double size : {0.2, 0.6, 10.0})
    for (const double tolerance : {0.0, 0.01, 0.1}) {
      const auto run = [&](int threads) {
        return adapt(Executor({.threads = threads}), mesh, constant_metric(mesh, size),
                     {.make = {.hausdorff_tolerance = tolerance}});
      };
      const AdaptedMesh adapted = run(2);
      SCOPED_TRACE(testing::Message() << size << " " << tolerance);
      EXPECT_EQ(test::joined(check_mesh(Executor({.threads = 1}), adapted.mesh)), "");
      EXPECT_EQ(test::joined(check_domain(Executor({.threads = 1}), mesh, adapted.mesh)), "");
      EXPECT_EQ(test::joined(check_boundary(Executor({.threads = 1}), adapted.mesh)), "");
      expect_identical(adapted, run(1));
    }
}

/// Nearly all elements of the mesh are slivers in this metric.
TEST_P(Adapt, ComesToAMetricFarFromTheMesh) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), dimension() == 2 ? 10 : 3));
  const AnyField metric = dimension() == 2 ? sheets(mesh, 0.5, 2e-4) : sheets(mesh, 0.7, 0.7 / 200);
  const AdaptedMesh adapted = adapt(Executor({.threads = 1}), mesh, metric);
  EXPECT_EQ(test::joined(check_mesh(Executor({.threads = 1}), adapted.mesh)), "");
  EXPECT_EQ(test::joined(check_domain(Executor({.threads = 1}), mesh, adapted.mesh)), "");
  const MeshStatistics found = measure(Executor({.threads = 1}), adapted.mesh, &adapted.metric);
  EXPECT_GT(found.share_in_range(), dimension() == 2 ? 0.9 : 0.75);
  EXPECT_GT(found.quality.mean, dimension() == 2 ? 0.85 : 0.7);
  expect_identical(adapted, adapt(Executor({.threads = 3}), mesh, metric));
}

/// In a mesh of flat and of large elements, a metric between the mesh's own and a coarse one may
/// ask for a hundred thousand elements; here it would in 3D.
TEST_P(Adapt, MakesNoDetourByManyElements) {
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 4));
  for (double& x : mesh.coordinates)  // all but the last layers are thin
    if (x < 0.9) x *= 1e-6;
  const AdaptOptions options{.progress = [](const AdaptProgress& now) {
    if (std::string_view(now.step) == "refine" && now.changes > 5000)
      throw std::runtime_error(std::to_string(now.changes) + " edges are split");
    return true;
  }};
  AdaptedMesh adapted;
  ASSERT_NO_THROW(adapted =
                      adapt(Executor({.threads = 2}), mesh, constant_metric(mesh, 0.5), options));
  EXPECT_EQ(test::joined(check_domain(Executor({.threads = 1}), mesh, adapted.mesh)), "");
}

/// Sizes at a plane of vertices jump to large ones at the next. The first call may not make many
/// times the elements of the last, which knows the metric at the vertices of the previous mesh.
TEST_P(Adapt, MakesAThinLayerInACoarseMeshAtOnce) {
  if (test::address_sanitized && GetParam() == 3) GTEST_SKIP();
  const int axis = dimension() - 1;
  const double thin = dimension() == 2 ? 1e-5 : 1e-4;
  const auto metric_of = [&](const AnyMesh& mesh) {
    AnyField metric = constant_metric(mesh, 0.2);
    const auto stride = static_cast<std::size_t>(dimension() * (dimension() + 1) / 2);
    for (std::size_t v = 0; v < metric.vertex_count; ++v) {
      const double x = mesh.coordinates[v * static_cast<std::size_t>(dimension()) +
                                        static_cast<std::size_t>(axis)];
      const double size = std::min(0.2, thin + 0.3 * std::abs(x - 0.5));
      metric.values[v * stride + (dimension() == 2 ? 2 : 5)] = 1 / (size * size);
    }
    return metric;
  };
  const Executor executor({.threads = 2});
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 4));
  const auto elements = [&] {
    return static_cast<double>(dimension() == 2 ? mesh.triangles.size() : mesh.tetrahedra.size());
  };
  double first = 0;
  for (int call = 0; call < 3; ++call) {
    mesh = adapt(executor, mesh, metric_of(mesh)).mesh;
    if (call == 0) first = elements();
  }
  EXPECT_LT(first, 3 * elements());
  const AnyField metric = metric_of(mesh);
  EXPECT_GT(measure(executor, mesh, &metric).share_in_range(), 0.9);
}

TEST_P(Adapt, RefusesToMakeMoreElementsThanCanBeCounted) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 3));
  for (const double size : {1e-6, 1e-70})
    EXPECT_THROW(adapt(Executor({.threads = 2}), mesh, constant_metric(mesh, size)), InputError)
        << size;
}

/// The elements in the layer remain slivers, whatever kernels do.
TEST_P(Adapt, SplitsTheSidesOfAThinLayer) {
  test::Grid grid = test::unit_grid(dimension(), dimension() == 2 ? 4 : 3);
  grid.lines[dimension() - 1] = {0, 0.25, 0.49995, 0.50005, 0.75, 1};
  grid.region = [layer_axis = dimension() - 1](const test::Cell& cell) {
    return cell[layer_axis] == 2 ? 2 : 1;
  };
  const AnyMesh mesh = test::make_grid(grid);
  const AnyField metric = constant_metric(mesh, dimension() == 2 ? 0.02 : 0.08);
  const Executor executor({.threads = 2});
  const AdaptedMesh result = adapt(executor, mesh, metric);
  const auto faults = test::faults_of(executor, mesh, result);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  const MeshStatistics statistics = measure(executor, result.mesh, &result.metric);
  EXPECT_GT(statistics.share_in_range(), dimension() == 2 ? 0.98 : 0.9);
  EXPECT_LT(statistics.edge_length.max, dimension() == 2 ? 4 : 6);
}

TEST_P(Adapt, CoarsensABoxToLittleMoreThanItsCorners) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), dimension() == 2 ? 20 : 8));
  const Executor executor({.threads = 2});
  const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, 10));
  EXPECT_LE(element_count(result.mesh), dimension() == 2 ? 2U : 12U);
  const auto faults = test::faults_of(executor, mesh, result);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
}

/// The elements as sets of positions, which do not depend on numbering.
std::set<std::vector<std::vector<double>>> places(const AnyMesh& mesh) {
  std::set<std::vector<std::vector<double>>> result;
  const auto d = static_cast<std::size_t>(mesh.dimension);
  const auto add = [&](const auto& cells) {
    for (const auto& corners : cells.vertices) {
      std::vector<std::vector<double>> element;
      for (const std::uint32_t v : corners) {
        const double* at = &mesh.coordinates[v * d];
        element.emplace_back(at, at + d);
      }
      std::sort(element.begin(), element.end());
      result.insert(std::move(element));
    }
  };
  if (mesh.dimension == 2)
    add(mesh.triangles);
  else
    add(mesh.tetrahedra);
  return result;
}

TEST_P(Adapt, ChangesLittleTheSecondTime) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 4));
  const Executor executor({.threads = 2});
  const AdaptedMesh once = adapt(executor, mesh, layered(mesh, dimension() == 2 ? 3000 : 800));
  const AdaptedMesh again = adapt(executor, once.mesh, once.metric);
  const auto before = places(once.mesh), after = places(again.mesh);
  std::vector<std::vector<std::vector<double>>> kept;
  std::set_intersection(before.begin(), before.end(), after.begin(), after.end(),
                        std::back_inserter(kept));
  EXPECT_GT(static_cast<double>(kept.size()), 0.98 * static_cast<double>(before.size()));
  const double quality = measure(executor, once.mesh, &once.metric).quality.mean;
  EXPECT_GT(measure(executor, again.mesh, &again.metric).quality.mean, quality - 5e-4);
}

TEST_P(Adapt, MendsAnAdaptedMeshWhereItMust) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 4));
  const Executor executor({.threads = 2});
  const AdaptedMesh once = adapt(executor, mesh, layered(mesh, dimension() == 2 ? 3000 : 800));
  AnyField metric = once.metric;
  const std::size_t components = stride_of(metric), vertex = once.mesh.vertex_count() / 2;
  for (std::size_t c = 0; c < components; ++c) metric.values[vertex * components + c] *= 16;
  const AdaptedMesh again = adapt(executor, once.mesh, metric);
  EXPECT_EQ(again.report.iterations, 0);
  EXPECT_GT(again.report.refine.applied, 0U);
  const auto faults = test::faults_of(executor, once.mesh, again);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
}

TEST_P(Adapt, LeavesALockedBoundaryAsItIs) {
  AnyMesh mesh = rich_mesh();
  AdaptOptions options;
  options.make.lock_boundary = true;
  const Executor executor({.threads = 2});
  const AdaptedMesh result = adapt(executor, mesh, layered(mesh, 100), options);
  test::require_facets(mesh);
  const auto faults = test::faults_of(executor, mesh, result);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
}

TEST_P(Adapt, OnlyDoesWhatItMay) {
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = layered(mesh, 300);
  AdaptOptions options;
  options.move = options.swap = options.insert = false;
  const AdaptedMesh result = adapt(Executor({.threads = 2}), mesh, metric, options);
  EXPECT_EQ(result.report.coarsen.applied + result.report.refine.applied +
                result.report.swap.applied + result.report.smooth.applied,
            0U);
  EXPECT_EQ(element_count(result.mesh), element_count(mesh));
  options.swap = true;
  const AdaptedMesh swapped = adapt(Executor({.threads = 2}), mesh, metric, options);
  EXPECT_EQ(swapped.mesh.vertex_count(), mesh.vertex_count());
}

TEST_P(Adapt, MakesBetterElementsIfThorough) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 8));
  const AnyField metric = layered(mesh, dimension() == 2 ? 10000 : 3000);
  const Executor executor({.threads = 2});
  const auto quality = [&](bool thorough) {
    AdaptOptions options;
    options.thorough = thorough;
    const AdaptedMesh result = adapt(executor, mesh, metric, options);
    const auto faults = test::faults_of(executor, mesh, result);
    EXPECT_TRUE(faults.empty()) << test::joined(faults);
    return measure(executor, result.mesh, &result.metric).quality.mean;
  };
  EXPECT_GT(quality(true), quality(false));
}

TEST_P(Adapt, RefusesAMetricOfTheWrongShape) {
  const AnyMesh mesh = rich_mesh();
  AnyField metric = constant_metric(mesh, 0.1);
  --metric.vertex_count;
  EXPECT_THROW(adapt(Executor({.threads = 1}), mesh, metric), InputError);
}

TEST_P(Adapt, RefusesArraysThatDoNotFitAndValuesThatAreNoMetric) {
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = constant_metric(mesh, 0.1);
  const auto expect_refused = [](const AnyMesh& of, const AnyField& by) {
    EXPECT_THROW(adapt(Executor({.threads = 2}), of, by), InputError);
  };
  for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    AnyField bad = metric;
    bad.values[stride_of(metric) * 5] = value;
    expect_refused(mesh, bad);
  }
  AnyField cut = metric;
  cut.values.pop_back();
  expect_refused(mesh, cut);
  AnyMesh odd = mesh;
  odd.vertex_reference.push_back(0);
  expect_refused(odd, metric);
  odd = mesh;
  odd.triangles.reference.pop_back();
  expect_refused(odd, metric);
  odd = mesh;
  odd.vertex_reference.clear();
  try {
    adapt(Executor({.threads = 1}), odd, metric);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("vertex_reference"), std::string::npos);
  }
}

TEST_P(Adapt, RefusesOptionsThatMakeNoSense) {
  const AnyMesh mesh = rich_mesh();
  const AnyField metric = constant_metric(mesh, 0.5);
  const auto expect_refused = [&](const AdaptOptions& options) {
    EXPECT_THROW(adapt(Executor({.threads = 1}), mesh, metric, options), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  expect_refused({.iterations = -1});
  for (const double size : {-0.1, nan, infinity}) {
    expect_refused({.smallest_size = size});
    expect_refused({.largest_size = size});
  }
  expect_refused({.smallest_size = 0.2, .largest_size = 0.1});
  for (const double gradation : {0.5, nan, infinity}) expect_refused({.gradation = gradation});
  EXPECT_NO_THROW(adapt(Executor({.threads = 1}), mesh, metric, {.gradation = -1}));
}

}  // namespace
}  // namespace ductile::meshadapt::adapt_test
