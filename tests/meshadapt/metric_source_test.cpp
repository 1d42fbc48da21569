/// @file
/// adapt() driven by sources of metrics: which meshes they see, how often they are asked, what
/// their mistakes and exceptions do, and that the result does not depend on threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/random_case.hpp"
#include "support/thin_cases.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::metric_source_test {
namespace {

using runtime::Executor;

/// Gives what a function returns; a field without vertices means that the mesh is final.
class Source : public MetricSource {
 public:
  using Next = std::function<AnyField(const AdaptState&)>;
  explicit Source(Next next) : next_(std::move(next)) {}

  const AnyField* next(const AdaptState& state) override {
    passes.push_back(state.pass);
    metric_ = next_(state);
    return metric_.vertex_count == 0 ? nullptr : &metric_;
  }

  std::vector<int> passes;  ///< in which it was asked

 private:
  Next next_;
  AnyField metric_;
};

AnyField even(const AnyMesh& mesh, double size) { return constant_metric(mesh, size); }

/// A source of three even sizes, each half of the one before.
Source halving(double size) {
  return Source([size](const AdaptState& state) {
    return state.pass < 3 ? even(state.mesh(), std::ldexp(size, -state.pass)) : AnyField{};
  });
}

/// Interpolation of logarithms rounds.
void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-9 * std::abs(expected[0]));
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

AnyMesh random_grid(std::uint64_t seed) {
  test::Random random(seed);
  const int dimension = seed % 2 == 0 ? 2 : 3, n = dimension == 2 ? 6 : 3;
  test::Grid grid = test::unit_grid(dimension, n);
  if (test::chance(random, 0.5)) grid.region = test::two_halves(n);
  AnyMesh mesh = test::make_grid(grid);
  test::jiggle(mesh, random, 0.2);
  mesh.name = "grid";
  return mesh;
}

TEST(MetricSources, GiveWhatAdaptIsGivenIfTheyGiveOneMetric) {
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = 0; seed < test::trials(16); ++seed) {
    const test::RandomCase random = test::random_case(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
    Source source(
        [&](const AdaptState& state) { return state.pass == 0 ? random.metric : AnyField{}; });
    const AdaptedMesh expected = adapt(executor, random.mesh, random.metric, random.options);
    const AdaptedMesh adapted = adapt(executor, random.mesh, source, random.options);
    EXPECT_EQ(adapted.mesh, expected.mesh);
    EXPECT_EQ(adapted.metric.values, expected.metric.values);
    EXPECT_EQ(adapted.report.warnings, expected.report.warnings);
  }
}

TEST(MetricSources, SeeTheInputAndThenEachAdaptedMesh) {
  for (std::uint64_t seed = 0; seed < test::trials(8); ++seed) {
    SCOPED_TRACE(seed);
    const AnyMesh mesh = random_grid(seed);
    const double size = 0.5;
    std::vector<AnyMesh> seen;
    const Executor one({.threads = 1}), three({.threads = 3});
    Source source([&](const AdaptState& state) {
      EXPECT_EQ(&state.input, &mesh);
      if (state.pass == 0) {
        EXPECT_EQ(&state.mesh(), &mesh);
      } else {
        EXPECT_EQ(test::joined(check_adapted(one, mesh, state.mesh())), "");
        const AnyField& metric = state.adapted().metric;
        const AnyField expected = even(state.mesh(), std::ldexp(size, 1 - state.pass));
        EXPECT_EQ(metric.vertex_count, state.mesh().vertex_count());
        expect_near(metric.values, expected.values);
      }
      seen.push_back(state.mesh());
      return state.pass < 3 ? even(state.mesh(), std::ldexp(size, -state.pass)) : AnyField{};
    });
    AdaptedMesh adapted = adapt(one, mesh, source);
    EXPECT_EQ(source.passes, (std::vector{0, 1, 2, 3}));
    ASSERT_EQ(seen.size(), 4U);
    for (std::size_t i = 2; i < seen.size(); ++i)
      EXPECT_GT(seen[i].vertex_count(), 1.5 * seen[i - 1].vertex_count());
    adapted.mesh.name = mesh.name;
    EXPECT_EQ(adapted.mesh, seen.back());
    Source same = halving(size);
    const AdaptedMesh again = adapt(three, mesh, same);
    adapted.mesh.name = again.mesh.name;
    EXPECT_EQ(again.mesh, adapted.mesh);
    EXPECT_EQ(again.metric.values, adapted.metric.values);
  }
}

/// A source as for level sets: fine where a function is near 0 on the mesh as it stands.
TEST(MetricSources, RefineNearAFunctionThatTheInputDoesNotShow) {
  const Executor executor({.threads = 2});
  constexpr double radius = 0.11, fine = 0.02, coarse = 0.3;
  for (const int dimension : {2, 3}) {
    const AnyMesh mesh = test::make_grid(test::unit_grid(dimension, 3));
    const auto distance = [&](const AnyMesh& now, std::size_t v) {
      double sum = 0;
      for (int axis = 0; axis < dimension; ++axis) {
        const auto at = v * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(axis);
        sum += std::pow(now.coordinates[at] - 0.52, 2);
      }
      return std::abs(std::sqrt(sum) - radius);
    };
    std::vector<std::size_t> near;  // [pass], vertices near the surface
    Source source([&](const AdaptState& state) {
      const AnyMesh& now = state.mesh();
      std::vector<double> size_of(now.vertex_count());
      near.push_back(0);
      for (std::size_t v = 0; v < size_of.size(); ++v) {
        near.back() += distance(now, v) < fine ? 1U : 0U;
        size_of[v] = std::min(coarse, fine + 0.3 * distance(now, v));
      }
      if (state.pass == 4) return AnyField{};
      return metric_of(scalar_field(dimension, size_of), now);
    });
    const AdaptedMesh adapted = adapt(executor, mesh, source);
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, adapted.mesh)), "");
    ASSERT_EQ(near.size(), 5U);
    const double ideal =
        dimension == 2 ? 2 * 3.14 * radius / fine : 4 * 3.14 * radius * radius / (fine * fine);
    EXPECT_LT(near[1], 0.5 * ideal) << "one pass misses it";
    EXPECT_GT(near[4], 0.8 * ideal);
  }
}

/// A source as for meshes that move: the metric of the input is carried to each mesh.
TEST(MetricSources, MayCarryTheirMetricAlong) {
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = 0; seed < test::trials(6); ++seed) {
    const AnyMesh mesh = random_grid(seed);
    std::vector<double> size_of;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
      size_of.push_back(0.1 + 0.2 * mesh.coordinates[v * static_cast<std::size_t>(mesh.dimension)]);
    const AnyField sizes = scalar_field(mesh.dimension, size_of);
    Source source([&](const AdaptState& state) {
      if (state.pass == 2) return AnyField{};
      if (state.pass == 0) return metric_of(sizes, mesh);
      return metric_of(interpolate_field(executor, {state.input, sizes}, state.mesh()).field,
                       state.mesh());
    });
    const AdaptedMesh adapted = adapt(executor, mesh, source);
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, adapted.mesh)), "");
    EXPECT_EQ(source.passes.size(), 3U);
  }
}

struct Theirs : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST(MetricSources, ThrowToTheCallerAndLeaveTheInput) {
  const Executor executor({.threads = 3});
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (int wanted = 0; wanted < 4; ++wanted) {
      const AnyMesh mesh = random_grid(seed), before = mesh;
      Source source([&](const AdaptState& state) -> AnyField {
        if (state.pass == wanted) throw Theirs("theirs");
        return even(state.mesh(), 0.3);
      });
      EXPECT_THROW(adapt(executor, mesh, source), Theirs);
      EXPECT_EQ(source.passes.size(), static_cast<std::size_t>(wanted) + 1);
      EXPECT_EQ(mesh, before);
      Source good = halving(0.5);
      EXPECT_NO_THROW(adapt(executor, mesh, good)) << "nothing is left behind";
    }
}

/// What adapt() says of a source that gives a bad metric, made from a good one, in a pass.
std::string refusal(int pass, const std::function<void(AnyField&)>& spoil) {
  const AnyMesh mesh = random_grid(0);
  Source source([&](const AdaptState& state) {
    AnyField metric = even(state.mesh(), 0.3);
    metric.name = "theirs";
    if (state.pass == pass) spoil(metric);
    return metric;
  });
  try {
    adapt(Executor({.threads = 2}), mesh, source);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(MetricSources, AreToldOfMetricsThatAreNone) {
  for (const int pass : {0, 1, 2}) {
    SCOPED_TRACE(pass);
    expect_says(refusal(pass, [](AnyField& metric) { metric.values[3] = -1; }),
                "theirs: expected a positive definite tensor");
    expect_says(refusal(pass, [](AnyField& metric) { metric.values[0] = std::nan(""); }),
                "theirs: expected a positive definite tensor");
    const auto shorter = [](AnyField& metric) {
      --metric.vertex_count;
      metric.values.resize(metric.values.size() - 3);
    };
    expect_says(refusal(pass, shorter), "theirs: expected one symmetric tensor for each");
  }
  const AnyMesh mesh = random_grid(1);
  Source none([](const AdaptState&) { return AnyField{}; });
  EXPECT_THROW(adapt(Executor(), mesh, none), InputError);
}

TEST(MetricSources, EndAfterTheMostPassesWithAWarning) {
  for (const int dimension : {2, 3}) {
    const AnyMesh mesh = test::make_grid(test::unit_grid(dimension, 1));
    Source source([&](const AdaptState& state) {
      AnyField metric = even(state.mesh(), 0.8);
      metric.name = "endless";
      return metric;
    });
    const AdaptedMesh adapted = adapt(Executor({.threads = 1}), mesh, source);
    EXPECT_EQ(source.passes.size(), static_cast<std::size_t>(most_passes) + 1);
    ASSERT_EQ(adapted.report.warnings.size(), 1U);
    expect_says(adapted.report.warnings[0], "endless: ");
  }
}

/// Thin across a direction that turns with the first axis by so much, which edges hardly show.
AnyField turning(const AnyMesh& mesh, double turn) {
  const auto stride = static_cast<std::size_t>(mesh.dimension);
  constexpr double across = 1 / (0.02 * 0.02), along = 1 / (0.25 * 0.25);
  AnyField metric = constant_metric(mesh, 0.25);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double angle = turn * mesh.coordinates[v * stride];
    const double c = std::cos(angle), s = std::sin(angle);
    double* const tensor = &metric.values[v * (stride == 2 ? 3 : 6)];  // m11 m12 m22 ...
    tensor[0] = across * c * c + along * s * s;
    tensor[1] = (across - along) * c * s;
    tensor[2] = across * s * s + along * c * c;
  }
  return metric;
}

/// Passes that limit growth lie between those of the source, and end.
TEST(MetricSources, AreAskedWhenGrowthIsLimited) {
  const Executor executor({.threads = 2});
  int grown = 0;
  for (std::uint64_t seed = 15; seed < 15 + test::trials(3); ++seed) {
    const AnyMesh mesh = random_grid(seed);
    const AnyField metric = turning(mesh, 2 + 0.5 * static_cast<double>(seed));
    Source source([&](const AdaptState& state) { return state.pass == 0 ? metric : AnyField{}; });
    const AdaptedMesh adapted = adapt(executor, mesh, source, {.gradation = 1.2});
    ASSERT_EQ(source.passes.size(), 2U);
    EXPECT_LE(source.passes[1], 6);
    grown += source.passes[1] > 1 ? 1 : 0;
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, adapted.mesh)), "");
  }
  if (test::trials(3) >= 3) {
    EXPECT_GT(grown, 0) << "the adapted mesh shows more growth";
  }
}

/// Where boundaries met the input is adapted again: the source is asked for pass 0 again.
TEST(MetricSources, AreAskedAgainWhereTheInputIsAdaptedAgain) {
  const Executor executor({.threads = 2});
  int again = 0;
  for (std::uint64_t seed = 0; seed < test::trials(120); ++seed) {
    const test::ThinCase thin = test::plate_with_voids(seed % 2 == 0 ? 2 : 3, seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + thin.what);
    Source source([&](const AdaptState& state) {
      return state.pass < 2 ? even(state.mesh(), thin.size) : AnyField{};
    });
    AdaptOptions options;
    options.make.hausdorff_tolerance = thin.tolerance;
    const AdaptedMesh adapted = adapt(executor, thin.mesh, source, options);
    EXPECT_EQ(test::joined(check_adapted(executor, thin.mesh, adapted.mesh, thin.tolerance)), "");
    const auto starts = std::count(source.passes.begin(), source.passes.end(), 0);
    EXPECT_GE(starts, adapted.report.attempts);
    again += adapted.report.attempts > 1 ? 1 : 0;
  }
  if (test::trials(120) >= 120) {
    EXPECT_GT(again, 0) << "some boundaries meet";
  }
}

}  // namespace
}  // namespace ductile::meshadapt::metric_source_test
