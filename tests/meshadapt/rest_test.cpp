/// @file
/// Adapts random meshes again and again: by the third call hardly any element may change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"
#include "support/random_case.hpp"
#include "support/rest_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::rest_test {
namespace {

using runtime::Executor;

/// Positions of the corners of each element, sorted.
template <int Dim>
std::vector<std::vector<double>> places_in(const AnyMesh& mesh) {
  std::vector<std::vector<double>> places;
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    std::array<std::array<double, Dim>, Dim + 1> points;
    for (std::size_t c = 0; c <= Dim; ++c) points[c] = position_in<Dim>(mesh, corners[c]).x;
    std::sort(points.begin(), points.end());
    std::vector<double>& place = places.emplace_back();
    for (const auto& point : points) place.insert(place.end(), point.begin(), point.end());
  }
  std::sort(places.begin(), places.end());
  return places;
}
std::vector<std::vector<double>> places(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? places_in<2>(mesh) : places_in<3>(mesh);
}

/// Share of the larger mesh's elements that the other mesh does not have.
double share_changed(const AnyMesh& before, const AnyMesh& after) {
  const auto one = places(before), other = places(after);
  std::vector<std::vector<double>> both;
  std::set_intersection(one.begin(), one.end(), other.begin(), other.end(),
                        std::back_inserter(both));
  const auto most = static_cast<double>(std::max(one.size(), other.size()));
  return 1 - static_cast<double>(both.size()) / most;
}

/// Relative change of the number of elements by the last call, and share of elements changed.
struct Change {
  double count, share;
};

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

/// Adapts `calls` times, each time the previous result, with its metric or a newly evaluated one.
/// Returns the change by the last call.
Change change_by_call(int calls, const AnyMesh& mesh, const AnyField& metric,
                      const AdaptOptions& options, auto&& metric_on) {
  const Executor executor({.threads = 1});
  AdaptedMesh last = adapt(executor, mesh, metric, options);
  for (int call = 2; call < calls; ++call)
    last = adapt(executor, last.mesh, metric_on(last), options);
  const AdaptedMesh next = adapt(executor, last.mesh, metric_on(last), options);
  const auto before = static_cast<double>(element_count(last.mesh));
  const auto after = static_cast<double>(element_count(next.mesh));
  return {std::abs(after / before - 1), share_changed(last.mesh, next.mesh)};
}

/// Counts cases that are not at rest; one in twenty is accepted.
class Unrest {
 public:
  void note(std::uint64_t seed, const std::string& what, double changed) {
    ++all_;
    if (changed < 0.02) return;
    ++count_;
    said_ += "seed " + std::to_string(seed) + ", " + std::to_string(100 * changed) +
             " % changed: " + what + "\n";
  }
  void expect_little() const { EXPECT_LE(count_, std::max<std::size_t>(1, all_ / 20)) << said_; }

 private:
  std::size_t all_ = 0, count_ = 0;
  std::string said_;
};

void expect_rest(std::uint64_t usual_count, auto&& changed_in) {
  Unrest unrest;
  for (auto seed = test::first_trial(); seed < test::end_of_trials(usual_count); ++seed)
    changed_in(seed, unrest);
  unrest.expect_little();
}

TEST(Rest, ComesByTheThirdCallWithTheMetricThatIsLeft) {
  expect_rest(40, [](std::uint64_t seed, Unrest& unrest) {
    const test::RestCase made = test::rest_case(seed);
    const Change changed = change_by_call(3, made.mesh, made.metric_on(made.mesh), made.options,
                                          [](const AdaptedMesh& last) { return last.metric; });
    unrest.note(seed, made.what, changed.share);
  });
}

/// The first calls approach a metric that the first mesh does not resolve.
TEST(Rest, ComesByTheSixthCallWithAMetricThatIsMadeAnew) {
  expect_rest(20, [](std::uint64_t seed, Unrest& unrest) {
    const test::RestCase made = test::rest_case(seed);
    const Change changed =
        change_by_call(6, made.mesh, made.metric_on(made.mesh), made.options,
                       [&](const AdaptedMesh& last) { return made.metric_on(last.mesh); });
    unrest.note(seed, made.what, changed.count);
  });
}

TEST(Rest, ComesByTheThirdCallInNastyMeshesToo) {
  expect_rest(60, [](std::uint64_t seed, Unrest& unrest) {
    const test::RandomCase made = test::random_case(seed);
    const Change changed = change_by_call(3, made.mesh, made.metric, made.options,
                                          [](const AdaptedMesh& last) { return last.metric; });
    unrest.note(seed, made.what, changed.share);
  });
}

/// In a mesh at rest the metric changes in a small spot: the spot is adapted, however small it is.
TEST(Rest, IsNotForWhatIsNew) {
  const Executor executor({.threads = 1});
  test::Random random(5);
  for (const int dimension : {2, 3}) {
    const AnyMesh start = test::make_grid(test::unit_grid(dimension, dimension == 2 ? 40 : 8));
    AdaptedMesh last =
        adapt(executor, start, constant_metric(start, dimension == 2 ? 0.03 : 0.1), {});
    last = adapt(executor, last.mesh, last.metric, {});
    const auto axes = static_cast<std::size_t>(dimension), size = stride_of(last.metric);
    for (std::uint64_t trial = 0; trial < test::trials(20); ++trial) {
      const double x = test::uniform(random, 0.2, 0.8), y = test::uniform(random, 0.2, 0.8);
      const double radius = test::uniform(random, 0.03, 0.15) * (dimension == 2 ? 1 : 2);
      AnyField metric = last.metric;
      for (std::size_t v = 0; v < last.mesh.vertex_count(); ++v) {
        const double* at = &last.mesh.coordinates[axes * v];
        const double z = dimension == 2 ? 0 : at[2] - 0.5;
        if (std::hypot(at[0] - x, at[1] - y, z) < radius)  // sizes a third of what they were
          for (std::size_t i = 0; i < size; ++i) metric.values[size * v + i] *= 9;
      }
      const double before = measure(executor, last.mesh, &metric).edge_length.max;
      const AdaptedMesh next = adapt(executor, last.mesh, metric, {});
      SCOPED_TRACE(std::to_string(dimension) + "D, radius " + std::to_string(radius));
      const double longest = measure(executor, next.mesh, &next.metric).edge_length.max;
      EXPECT_LT(longest, std::max(1.6, 0.95 * before));
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::rest_test
