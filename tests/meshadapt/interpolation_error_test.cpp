#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "support/meshes.hpp"

// A whole loop as a simulation runs it: a function is sampled, its Hessian recovered, the metric
// fitted, the mesh adapted, and again. The interpolation error must fall as N^(-2/d).

namespace ductile::meshadapt::interpolation_error_test {
namespace {

using runtime::Executor;

const Executor executor({.threads = 2});

/// Smooth, but steep across a bent layer that is a hundred times thinner than the domain is wide.
template <int Dim>
double smooth_layer(const Vector<Dim>& p) {
  double middle = 0.5 + 0.2 * std::sin(5 * p[0]);
  if constexpr (Dim == 3) middle += 0.1 * std::sin(4 * p[2]);
  return std::tanh(30 * (p[1] - middle));
}

template <int Dim>
std::vector<double> sampled(const FixedMesh<Dim>& mesh) {
  std::vector<double> value_of;
  for (const Vector<Dim>& p : mesh.position_of) value_of.push_back(smooth_layer(p));
  return value_of;
}

/// The L^2 norm of the error of linear interpolation, by a quadrature with the midpoints of all
/// edges and the centre.
template <int Dim>
double interpolation_error(const FixedMesh<Dim>& mesh) {
  const auto value_of = sampled(mesh);
  const auto squared = [&](ElementId e, const std::vector<std::size_t>& at) {
    Vector<Dim> p;
    double linear = 0;
    for (const std::size_t i : at) {
      p += 1.0 / static_cast<double>(at.size()) * mesh.position_of[mesh.corners_of[e][i]];
      linear += value_of[mesh.corners_of[e][i]] / static_cast<double>(at.size());
    }
    return std::pow(smooth_layer(p) - linear, 2);
  };
  double sum = 0;
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    double mean = 0;
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t j = 0; j < i; ++j) mean += squared(e, {i, j}) / Simplex<Dim>::edges;
    sum += mean * mesh.volume_of[e];
  }
  return std::sqrt(sum);
}

struct Result {
  double elements = 0, error = 0, estimate = 0;
};

template <int Dim>
Result adapted_to(double elements, Recovery recovery) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 20));
  Result result;
  for (int round = 0; round < 4; ++round) {
    const auto mesh = make_fixed_mesh<Dim>(executor, any);
    const AnyField field{Dim, any.vertex_count(), {AnyField::Type::scalar}, sampled(mesh), "f"};
    const auto metric = solution_metric(
        executor, any, field,
        {.goal = {.complexity = complexity_of_elements(Dim, elements)}, .recovery = recovery});
    result.estimate = metric.fit.error;
    any = adapt(executor, any, metric.metric).mesh;
  }
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  result.elements = static_cast<double>(mesh.element_count());
  result.error = interpolation_error(mesh);
  return result;
}

double order(const Result& coarse, const Result& fine) {
  return std::log(coarse.error / fine.error) / std::log(fine.elements / coarse.elements);
}

// In 3D the error falls as N^(-2/3), along a layer that is bent in all directions.
TEST(InterpolationError, FallsAtTheOptimalRateInSpace) {
  const Result coarse = adapted_to<3>(8000, Recovery::least_squares);
  const Result fine = adapted_to<3>(32000, Recovery::least_squares);
  EXPECT_GT(order(coarse, fine), 0.95 * 2 / 3);
}

TEST(InterpolationError, FallsAtTheOptimalRate) {
  const double uniform = interpolation_error(
      make_fixed_mesh<2>(executor, test::make_grid(test::unit_grid(2, 89))));  // 15,842 triangles
  for (const Recovery recovery : {Recovery::least_squares, Recovery::double_projection}) {
    std::vector<Result> results;
    for (const double elements : {1000, 4000, 16000}) {
      results.push_back(adapted_to<2>(elements, recovery));
      EXPECT_NEAR(results.back().elements, elements, 0.1 * elements);
      EXPECT_NEAR(results.back().estimate / results.back().error, 1, 0.1);
    }
    EXPECT_GT(order(results[0], results[1]), 0.95);
    EXPECT_GT(order(results[1], results[2]), 0.95);
    EXPECT_GT(uniform, 20 * results[2].error);
  }
}

// ---- Loops of calls ----

/// A random function: a plane or bent layer, a wave, a bump or a ball.
template <int Dim>
class RandomField {
 public:
  explicit RandomField(test::Random& random)
      : kind_(test::below(random, 5)), steep_(std::exp(test::uniform(random, 1.6, 4.3))) {
    for (double& x : across_.x) x = test::uniform(random, -1, 1);
    across_ *= 1 / norm(across_);
    for (double& x : centre_.x) x = test::uniform(random, 0, 1);
  }
  double operator()(const Vector<Dim>& p) const {
    const Vector<Dim> d = p - centre_;
    const double along = d[0] * across_[1] - d[1] * across_[0];
    if (kind_ == 0) return std::tanh(steep_ * dot(across_, d));
    if (kind_ == 1) return std::tanh(steep_ * (dot(across_, d) + 0.1 * std::sin(5 * along)));
    if (kind_ == 2) return std::sin((3 + steep_ / 8) * dot(across_, d)) * std::cos(4 * along);
    if (kind_ == 3) return std::exp(-steep_ * dot(d, d));
    return std::tanh(steep_ * (norm(d) - 0.4));
  }

 private:
  std::size_t kind_;
  double steep_;
  Vector<Dim> across_, centre_;
};

/// Root mean square of the interpolation error at the midpoints of edges.
template <int Dim>
double missed(const FixedMesh<Dim>& mesh, const RandomField<Dim>& f) {
  double sum = 0;
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    const auto p = mesh.points(e);
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t j = 0; j < i; ++j)
        sum += mesh.volume_of[e] * std::pow(f(0.5 * (p[i] + p[j])) - 0.5 * (f(p[i]) + f(p[j])), 2) /
               Simplex<Dim>::edges;
  }
  return std::sqrt(sum);
}

struct Loop {
  double elements = 0, grown = 1.1, count = 0.15;
  int calls = 0, settled = 0;  ///< counts must be met from call `settled` on
};

template <int Dim>
void expect_steady(std::uint64_t seed, const Loop& loop) {
  test::Random random(seed);
  const RandomField<Dim> field(random);
  AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 20 : 10));
  double least = std::numeric_limits<double>::infinity();
  for (int call = 0; call < loop.calls; ++call) {
    std::vector<double> value_of;
    for (const auto& p : make_fixed_mesh<Dim>(executor, any).position_of)
      value_of.push_back(field(p));
    const auto metric = solution_metric(
        executor, any, {Dim, any.vertex_count(), {AnyField::Type::scalar}, value_of, "f"},
        {.goal = {.elements = loop.elements}});
    any = adapt(executor, any, metric.metric).mesh;
    const auto mesh = make_fixed_mesh<Dim>(executor, any);
    const double count = static_cast<double>(mesh.element_count()), error = missed(mesh, field);
    if (call >= loop.settled) {
      EXPECT_NEAR(count / loop.elements, 1, loop.count) << "seed " << seed << ", call " << call;
      EXPECT_LT(error, loop.grown * least) << "seed " << seed << ", call " << call;
    }
    least = std::min(least, error);
  }
}

TEST(InterpolationError, NeverGrowsInALoopAndCountsAreMet) {
  for (std::uint64_t seed = 0; seed < 30; ++seed)
    expect_steady<2>(seed, {.elements = 2000, .calls = 6, .settled = 3});
}

TEST(InterpolationError, NeverGrowsInALoopInSpaceEither) {
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    expect_steady<3>(seed, {.elements = 6000, .count = 0.12, .calls = 5, .settled = 3});
}

}  // namespace
}  // namespace ductile::meshadapt::interpolation_error_test
