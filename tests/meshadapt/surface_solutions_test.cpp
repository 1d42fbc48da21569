/// @file
/// Solutions on surfaces alone: their metrics, their transfer to an adapted surface, and origins.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "support/bits.hpp"
#include "support/trials.hpp"
#include "surface_support.hpp"

namespace ductile::meshadapt::surface_solutions_test {
namespace {

using namespace surface_support;
using runtime::Executor;
using Function = std::function<double(const Vector<3>&)>;

AnyField sampled(const AnyMesh& mesh, const Function& f) {
  std::vector<double> values;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) values.push_back(f(at(mesh, v)));
  return scalar_field(3, std::move(values), "f");
}

SolutionMetricOptions for_elements(double count) { return {.goal = {.elements = count}}; }

/// Adapts a few times, each time to the solution on the mesh at hand.
AnyMesh adapted_to(AnyMesh mesh, const Function& f, double elements, const AdaptOptions& options) {
  for (int round = 0; round < 3; ++round) {
    const auto made = solution_metric(two(), mesh, sampled(mesh, f), for_elements(elements));
    mesh = adapt(two(), mesh, made.metric, options).mesh;
  }
  return mesh;
}

/// A layer around a plane, the same along each ray from the origin.
double layer(const Vector<3>& p) {
  const Vector<3> q = (1 / norm(p)) * p;
  return std::tanh((q[2] - 0.3 * q[0]) / 0.1);
}
/// The same around the middle of the unit box.
double layer_in_box(const Vector<3>& p) { return layer(p - Vector<3>{{0.5, 0.5, 0.5}}); }

/// The L2 norm of the error of linear interpolation, by values at the middles of edges.
double interpolation_error(const AnyMesh& mesh, const Function& f) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector<3> a = at(mesh, mesh.triangles.vertices[t][i]),
                      b = at(mesh, mesh.triangles.vertices[t][(i + 1) % 3]);
      const double error = f(0.5 * (a + b)) - (f(a) + f(b)) / 2;
      sum += error * error * norm(normal(mesh, t)) / 6;
    }
  return std::sqrt(sum);
}

TEST(SurfaceSolutions, ErrorsFallAtTheOptimalRate) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const Function front = [](const Vector<3>& p) {
    return std::tanh((p[1] - 0.3 * p[0] - 0.35) / 0.05);
  };
  const AnyMesh bent = sheet(40, 40, [](double u, double v) {
    return Vector<3>{{u, v, 0.1 * std::sin(2 * u + v)}};
  });
  std::vector<double> errors, counts;
  for (const double elements : {3000.0, 9000.0}) {
    const AnyMesh mesh = adapted_to(bent, front, elements, within(0.01));
    counts.push_back(static_cast<double>(mesh.triangles.size()));
    EXPECT_NEAR(counts.back() / elements, 1, 0.12);
    errors.push_back(interpolation_error(mesh, front));
  }
  EXPECT_GT(std::log(errors[0] / errors[1]) / std::log(counts[1] / counts[0]), 0.9);
  EXPECT_GT(interpolation_error(bent, front), 3 * errors[0]);  // of 3,200 triangles
}

/// In a plane of space metrics are those of the plane.
TEST(SurfaceSolutions, AreAsInThePlane) {
  const std::array<Vector<3>, 2> axes{{{{0.6, 0.64, 0.48}}, {{-0.8, 0.48, 0.36}}}};
  const auto place = [&](double u, double v) { return u * axes[0] + v * axes[1]; };
  AnyMesh mesh = sheet(12, 12, place), flat = mesh;
  std::mt19937 random(5);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::size_t column = v % 13, row = v / 13;
    const auto inner = [](std::size_t i) { return i > 0 && i < 12; };
    const double shift = inner(column) && inner(row) ? 0.02 : 0;
    std::uniform_real_distribution<double> uniform(-shift, shift);
    const double u = static_cast<double>(column) / 12 + uniform(random),
                 w = static_cast<double>(row) / 12 + uniform(random);
    std::ranges::copy(place(u, w).x, &mesh.coordinates[3 * v]);
    flat.coordinates[2 * v] = u;
    flat.coordinates[2 * v + 1] = w;
  }
  flat.dimension = 2;
  flat.coordinates.resize(2 * flat.vertex_count());
  AnyField here = sampled(mesh, [](const Vector<3>&p) { return std::exp(p[0] + 2 * p[1]); }),
           there = here;
  there.dimension = 2;
  const SolutionMetricOptions options{.goal = {.complexity = 500}};
  const SolutionMetric in_space = solution_metric(two(), mesh, here, options),
                       in_plane = solution_metric(two(), flat, there, options);
  EXPECT_NEAR(in_space.fit.complexity, in_plane.fit.complexity, 1e-4);
  EXPECT_NEAR(in_space.fit.error / in_plane.fit.error, 1, 1e-4);
  const auto tensors = tensors_of<3>(two(), in_space.metric);
  const auto expected = tensors_of<2>(two(), in_plane.metric);
  for (std::size_t v = 0; v < tensors.size(); ++v)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j <= i; ++j)
        EXPECT_NEAR(dot(axes[static_cast<std::size_t>(i)],
                        product(tensors[v], axes[static_cast<std::size_t>(j)])),
                    expected[v](j, i), 1e-4 * (expected[v](0, 0) + expected[v](1, 1)));
}

/// The sides of a box, of six references, with the ridges between them.
AnyMesh box(int n) {
  std::vector<AnyMesh> sides;
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, 1})
      sides.push_back(sheet(
          n, n,
          [=](double u, double v) {
            Vector<3> p;
            p[axis] = end;
            p[(axis + 1) % 3] = end == 1 ? u : v;
            p[(axis + 2) % 3] = end == 1 ? v : u;
            return p;
          },
          false, 2 * axis + end + 1));
  return welded(sides);
}

/// Derivatives on one side of a ridge say nothing about the other side.
TEST(SurfaceSolutions, RidgesBelongToBothSides) {
  // It bends on one side of the box only, linear on all others.
  const auto bends_on_top = [](const Vector<3>& p) {
    return p[2] < 1 ? 0.0 : std::sin(6 * p[0]) * p[1] * (1 - p[1]) * p[0] * (1 - p[0]);
  };
  const AnyMesh mesh = box(20);
  const auto made = solution_metric(two(), mesh, sampled(mesh, bends_on_top), for_elements(4000));
  EXPECT_TRUE(made.fit.reached);
  const auto tensors = tensors_of<3>(two(), made.metric);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    if (at(mesh, v)[2] < 0.99) {
      EXPECT_GT(1 / std::sqrt(tensors[v](2, 2)), 0.3) << v;
    }
  for (const auto& f : std::vector<Function>{bends_on_top, layer_in_box}) {
    const AnyMesh adapted = adapted_to(mesh, f, 4000, {});
    EXPECT_NEAR(static_cast<double>(adapted.triangles.size()) / 4000, 1, 0.12);
    for (const auto& [reference, area] : areas(adapted)) EXPECT_NEAR(area, 1, 1e-9) << reference;
  }
}

TEST(SurfaceSolutions, AreTheSameAtAnyNumberOfThreads) {
  const AnyMesh mesh = box(9);
  const AnyField field = sampled(mesh, layer_in_box);
  SolutionMetricOptions options = for_elements(1000);
  options.gradation = 1.3;
  const auto on = [&](int threads) {
    return solution_metric(Executor({.threads = threads}), mesh, field, options).metric.values;
  };
  const auto first = on(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(test::bits(on(threads)), test::bits(first));
}

TEST(SurfaceSolutions, AreRefusedInWords) {
  const AnyMesh mesh = sphere(8);
  SolutionMetricOptions options = for_elements(100);
  options.recovery = Recovery::double_projection;
  EXPECT_THROW(solution_metric(two(), mesh, sampled(mesh, layer), options), InputError);
  EXPECT_THROW(project_field(two(), {mesh, sampled(mesh, layer)}, mesh), InputError);
  AnyMesh folded = mesh;
  folded.triangles.vertices[3][1] = folded.triangles.vertices[3][0];
  EXPECT_THROW(solution_metric(two(), folded, sampled(mesh, layer), for_elements(100)), InputError);
}

TEST(SurfaceSolutions, AMeshHasTheComplexityOfItsOwnMetric) {
  const AnyMesh mesh =
      adapt(two(), cylinder(40, true), constant_metric(cylinder(40, true), 0.05), within(0.002))
          .mesh;
  const auto fixed = make_fixed_mesh<2, 3>(two(), mesh);
  const auto implied = tensors_of<3>(two(), implied_tensors(two(), mesh));
  EXPECT_NEAR(complexity(two(), fixed, implied) * 2.31 / static_cast<double>(fixed.element_count()),
              1, 0.05);
}

// ---- Origins and transfer ----

struct Adapted {
  AnyMesh before, after;
};

/// Surfaces of all kinds, with required entities and references.
std::vector<Adapted> adapted_surfaces() {
  std::vector<Adapted> all;
  for (AnyMesh mesh :
       {sphere(12), hemisphere(9), cylinder(24, true), cylinder(24, false), three_sheets(6)}) {
    std::mt19937 random(static_cast<unsigned>(mesh.vertex_count()));
    for (std::uint32_t t = 3; t < mesh.triangles.size(); t += 9) {
      mesh.required_triangles.push_back(t);
      mesh.required_vertices.push_back(mesh.triangles.vertices[t - 1][random() % 3]);
    }
    const AnyField metric = constant_metric(mesh, random() % 2 == 0 ? 0.12 : 0.5);
    all.push_back({mesh, adapt(two(), mesh, metric, within(0.01)).mesh});
  }
  return all;
}

TEST(SurfaceOrigins, AreAtTheSamePlaces) {
  for (const auto& [before, after] : adapted_surfaces()) {
    const Origins found = origins(two(), before, after);
    EXPECT_EQ(found, origins(Executor({.threads = 3}), before, after));
    ASSERT_EQ(found.weight.size(), 3 * after.vertex_count());
    std::set<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < after.vertex_count(); ++v) {
      if (found.vertex[v] != none) {
        EXPECT_EQ(at(after, v), at(before, found.vertex[v]));
        EXPECT_TRUE(kept.insert(found.vertex[v]).second);
      }
      Vector<3> place;
      for (std::size_t i = 0; i < 3; ++i)
        place += found.weight[3 * v + i] * at(before, before.triangles.vertices[found.host[v]][i]);
      EXPECT_LT(norm(place - at(after, v)), 0.03);
    }
    for (const std::uint32_t v : before.required_vertices) EXPECT_TRUE(kept.contains(v));
    std::set<std::uint32_t> elements(found.element.begin(), found.element.end());
    for (const std::uint32_t t : before.required_triangles) EXPECT_TRUE(elements.contains(t));
    for (std::size_t t = 0; t < after.triangles.size(); ++t) {
      if (found.element[t] == none) continue;
      std::set<std::uint32_t> old(before.triangles.vertices[found.element[t]].begin(),
                                  before.triangles.vertices[found.element[t]].end());
      for (const std::uint32_t v : after.triangles.vertices[t])
        EXPECT_TRUE(old.contains(found.vertex[v]));
    }
  }
}

TEST(SurfaceTransfer, ReproducesWhatIsLinear) {
  const Function linear = [](const Vector<3>& p) { return 1 + 2 * p[0] - 3 * p[1] + p[2]; };
  for (const auto& [before, after] : adapted_surfaces()) {
    const TransferredField carried =
        interpolate_field(two(), {before, sampled(before, linear)}, after);
    EXPECT_EQ(carried.report.vertices_outside, 0U);
    for (std::uint32_t v = 0; v < after.vertex_count(); ++v)
      EXPECT_NEAR(carried.field.values[v], linear(at(after, v)), 0.1);
  }
}

/// Two squares side by side whose vertices are not joined: each keeps its own values, wherever its
/// vertices come to lie.
TEST(SurfaceTransfer, TellsSheetsApartThatTouch) {
  AnyMesh mesh = sheet(8, 8, [](double u, double v) { return Vector<3>{{u, v, 0.1 * u}}; });
  const AnyMesh other = sheet(
      8, 8,
      [](double u, double v) {
        return Vector<3>{{1 + u, v, 0.1 * (1 + u)}};
      },
      false, 2);
  const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
  mesh.coordinates.insert(mesh.coordinates.end(), other.coordinates.begin(),
                          other.coordinates.end());
  mesh.vertex_reference.resize(mesh.coordinates.size() / 3);
  for (auto corners : other.triangles.vertices) {
    for (std::uint32_t& v : corners) v += first;
    mesh.triangles.add(corners, 2);
  }
  std::vector<double> values(mesh.vertex_count(), 1);
  std::fill(values.begin() + first, values.end(), 2);
  const AnyMesh after = adapt(two(), mesh, constant_metric(mesh, 0.05)).mesh;
  const auto carried =
      interpolate_field(two(), {mesh, scalar_field(3, std::move(values), "f")}, after).field.values;
  for (std::size_t t = 0; t < after.triangles.size(); ++t)
    for (const std::uint32_t v : after.triangles.vertices[t])
      EXPECT_EQ(carried[v], after.triangles.reference[t]);
}

}  // namespace
}  // namespace ductile::meshadapt::surface_solutions_test
