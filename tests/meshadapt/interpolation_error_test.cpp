#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "support/meshes.hpp"

// Everything together, as a simulation uses it: a function is sampled, its Hessian recovered, the
// metric fitted, the mesh adapted, and again. The interpolation error must fall as N^(-2/d).

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

/// The L^2 norm of the difference between the function and what is linear between its values at
/// the corners, by a rule with the middles of all edges and the centre.
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

// In 3D, too: as N^(-2/3), along a layer that is bent in all directions.
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

}  // namespace
}  // namespace ductile::meshadapt::interpolation_error_test
