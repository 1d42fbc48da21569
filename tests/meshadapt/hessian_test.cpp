#include "ductile/meshadapt/hessian_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/error.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::hessian_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;

template <class Dimension>
class HessianIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(HessianIn, Dimensions, );

const Executor executor({.threads = 2});

/// A function with its second derivatives.
template <int Dim>
struct Quadratic {
  double constant;
  Vector<Dim> slope;
  Metric<Dim> hessian;

  explicit Quadratic(Random& random) : constant(uniform(random, -1, 1)) {
    for (double& x : slope.x) x = uniform(random, -1, 1);
    for (double& m : hessian.m) m = uniform(random, -1, 1);
  }
  double operator()(const Vector<Dim>& p) const {
    return constant + dot(slope, p) + dot(p, product(hessian, p)) / 2;
  }
};

template <int Dim, class Function>
std::vector<double> sampled(const FixedMesh<Dim>& mesh, const Function& function) {
  std::vector<double> value_of;
  for (const Vector<Dim>& p : mesh.position_of) value_of.push_back(function(p));
  return value_of;
}

template <int Dim>
double difference(const Metric<Dim>& a, const Metric<Dim>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.m.size(); ++i) most = std::max(most, std::abs(a.m[i] - b.m[i]));
  return most;
}

TYPED_TEST(HessianIn, LeastSquaresAreExactForQuadraticsOnAnyMesh) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  for (const double stretch : {1.0, 1e-4}) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, 5));
    test::jiggle(any, random, 0.4);
    for (std::size_t v = 0; v < any.vertex_count(); ++v) any.coordinates[v * Dim] *= stretch;
    const auto mesh = make_fixed_mesh<Dim>(executor, any);
    const Quadratic<Dim> exact(random);
    // The function is stretched so that it changes as much along the thin direction as along the
    // others.
    const auto function = [&](Vector<Dim> p) {
      p[0] /= stretch;
      return exact(p);
    };
    const auto value_of = sampled<Dim>(mesh, function);
    const auto hessian_of = recover_hessian<Dim>(executor, mesh, value_of);
    const auto gradient_of = recover_gradient<Dim>(executor, mesh, value_of);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      Metric<Dim> seen = hessian_of[v];
      seen.m[0] *= stretch * stretch;
      for (int i = 1; i < Dim; ++i) seen.m[static_cast<std::size_t>(i * (i + 1) / 2)] *= stretch;
      EXPECT_LT(difference(seen, exact.hessian), 1e-8) << "vertex " << v;
      Vector<Dim> p = mesh.position_of[v], slope = gradient_of[v];
      p[0] /= stretch;
      slope[0] *= stretch;
      EXPECT_LT(norm(slope - (exact.slope + product(exact.hessian, p))), 1e-8);
    }
  }
}

TYPED_TEST(HessianIn, ProjectionIsExactForQuadraticsWhereTheMeshIsRegular) {
  constexpr int Dim = TypeParam::value;
  Random random(12);
  const auto mesh = make_fixed_mesh<Dim>(executor, test::make_grid(test::unit_grid(Dim, 6)));
  const Quadratic<Dim> exact(random);
  const auto hessian_of =
      recover_hessian<Dim>(executor, mesh, sampled<Dim>(mesh, exact), Recovery::double_projection);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_LT(difference(hessian_of[v], exact.hessian), 1e-10) << "vertex " << v;
}

/// A smooth function and its second derivatives.
template <int Dim>
double wave(const Vector<Dim>& p) {
  double product = 1;
  for (int i = 0; i < Dim; ++i) product *= std::sin(1.5 * p[i] + i);
  return product;
}
template <int Dim>
Metric<Dim> wave_hessian(const Vector<Dim>& p) {
  Metric<Dim> result;
  for (int column = 0, at = 0; column < Dim; ++column)
    for (int row = 0; row <= column; ++row, ++at) {
      double product = 1.5 * 1.5;
      for (int i = 0; i < Dim; ++i) {
        const bool differentiated = (i == row) != (i == column);
        product *= differentiated ? std::cos(1.5 * p[i] + i) : std::sin(1.5 * p[i] + i);
      }
      result.m[static_cast<std::size_t>(at)] = row == column ? -product : product;
    }
  return result;
}

struct Errors {
  double inside = 0, boundary = 0;  ///< the largest
  double mean = 0;
};

template <int Dim>
Errors errors(int n, double jiggled, Recovery recovery) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  Random random(13);
  if (jiggled > 0) test::jiggle(any, random, jiggled);
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  const auto hessian_of =
      recover_hessian<Dim>(executor, mesh, sampled<Dim>(mesh, wave<Dim>), recovery);
  Errors errors;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double error = difference(hessian_of[v], wave_hessian(mesh.position_of[v]));
    double& worst = mesh.on_boundary[v] != 0 ? errors.boundary : errors.inside;
    worst = std::max(worst, error);
    errors.mean += error * mesh.share_of[v];
  }
  return errors;
}

TYPED_TEST(HessianIn, LeastSquaresConvergeInTheFirstOrderAndInTheSecondOnRegularMeshes) {
  constexpr int Dim = TypeParam::value;
  const int n = Dim == 2 ? 16 : 8;
  const Errors coarse = errors<Dim>(n, 0, Recovery::least_squares);
  const Errors fine = errors<Dim>(2 * n, 0, Recovery::least_squares);
  EXPECT_GT(std::log2(coarse.inside / fine.inside), 1.8);
  EXPECT_GT(std::log2(coarse.boundary / fine.boundary), 0.8);
  const Errors coarse_jiggled = errors<Dim>(n, 0.3, Recovery::least_squares);
  const Errors fine_jiggled = errors<Dim>(2 * n, 0.3, Recovery::least_squares);
  EXPECT_GT(std::log2(coarse_jiggled.mean / fine_jiggled.mean), 0.9);
}

TYPED_TEST(HessianIn, ProjectionConvergesOnRegularMeshes) {
  constexpr int Dim = TypeParam::value;
  const int n = Dim == 2 ? 16 : 8;
  const Errors coarse = errors<Dim>(n, 0, Recovery::double_projection);
  const Errors fine = errors<Dim>(2 * n, 0, Recovery::double_projection);
  EXPECT_GT(std::log2(coarse.inside / fine.inside), 0.8);
  EXPECT_GT(std::log2(coarse.boundary / fine.boundary), 0.8);
}

TYPED_TEST(HessianIn, CopesWithMeshesTooCoarseForAQuadratic) {
  constexpr int Dim = TypeParam::value;
  Random random(14);
  const Quadratic<Dim> exact(random);
  for (const Recovery recovery : {Recovery::least_squares, Recovery::double_projection})
    for (const int n : {1, 2}) {
      const auto mesh = make_fixed_mesh<Dim>(executor, test::make_grid(test::unit_grid(Dim, n)));
      for (const Metric<Dim>& hessian :
           recover_hessian<Dim>(executor, mesh, sampled<Dim>(mesh, exact), recovery))
        for (const double component : hessian.m) EXPECT_LT(std::abs(component), 20);
    }
}

/// A corner whose vertices all lie on the axes, up to `off`, except those of the last layer; a flat
/// field leads to such meshes. Each layer has a vertex on each axis and is a prism.
template <int Dim>
AnyMesh corner_on_axes(Random& random, int layers, double off) {
  AnyMesh any;
  any.dimension = Dim;
  any.coordinates.assign(Dim, 0);
  std::vector<double> at(Dim);
  for (int layer = 0; layer < layers; ++layer)
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      at[axis] += uniform(random, 0.5, 1.5) / layers;
      for (std::size_t i = 0; i < Dim; ++i)
        any.coordinates.push_back(i == axis ? at[axis] : uniform(random, -off, off));
    }
  any.vertex_reference.assign(any.coordinates.size() / Dim, 0);
  auto& elements = elements_in<Dim>(any).vertices;
  const auto add = [&](const auto& vertex) {
    std::array<std::uint32_t, Dim + 1> corners{};
    for (std::size_t i = 0; i <= Dim; ++i) corners[i] = static_cast<std::uint32_t>(vertex(i));
    elements.push_back(corners);
  };
  add([](std::size_t i) { return i; });
  for (std::size_t first = 1; first + 2 * Dim <= any.vertex_count(); first += Dim)
    for (std::size_t skip = 0; skip < Dim; ++skip)  // the corners of one layer, then of the next
      add([&](std::size_t i) { return i < Dim - skip ? first + i : first + i + Dim - 1; });
  elements_in<Dim>(any).reference.assign(elements.size(), 0);
  return any;
}

TYPED_TEST(HessianIn, StaysBoundedWhereVerticesLieOnTheAxes) {
  constexpr int Dim = TypeParam::value;
  Random random(17);
  for (int run = 0; run < 200; ++run) {
    const double off = std::pow(10, uniform(random, -40, -6));
    const int layers = 2 + static_cast<int>(test::below(random, 8));
    const auto mesh = make_fixed_mesh<Dim>(executor, corner_on_axes<Dim>(random, layers, off));
    for (const Metric<Dim>& hessian :
         recover_hessian<Dim>(executor, mesh, sampled<Dim>(mesh, wave<Dim>)))
      for (const double component : hessian.m) EXPECT_LT(std::abs(component), 100) << off;
  }
}

TYPED_TEST(HessianIn, TakesEveryComponentOfAField) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 4));
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  Random random(15);
  const Quadratic<Dim> one(random), two(random);
  AnyField field{
      Dim, any.vertex_count(), {AnyField::Type::scalar, AnyField::Type::scalar}, {}, "f"};
  for (const Vector<Dim>& p : mesh.position_of) {
    field.values.push_back(one(p));
    field.values.push_back(two(p));
  }
  const AnyField hessians = recover_hessian(executor, any, field);
  EXPECT_EQ(hessians.types, std::vector(2, AnyField::Type::symmetric));
  ASSERT_EQ(hessians.values.size(), any.vertex_count() * 2 * Metric<Dim>::size);
  for (std::size_t i = 0; i < hessians.values.size(); ++i) {
    const auto& exact = i / Metric<Dim>::size % 2 == 0 ? one.hessian : two.hessian;
    EXPECT_NEAR(hessians.values[i], exact.m[i % Metric<Dim>::size], 1e-8);
  }
  field.vertex_count -= 1;
  EXPECT_THROW(recover_hessian(executor, any, field), InputError);
}

TYPED_TEST(HessianIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 40 : 10));
  Random random(16);
  test::jiggle(any, random, 0.3);
  for (const Recovery recovery : {Recovery::least_squares, Recovery::double_projection}) {
    const auto run = [&](int threads) {
      const Executor some({.threads = threads});
      const auto mesh = make_fixed_mesh<Dim>(some, any);
      return recover_hessian<Dim>(some, mesh, sampled<Dim>(mesh, wave<Dim>), recovery);
    };
    const auto expected = run(1);
    for (const int threads : {2, 3, 8}) EXPECT_EQ(expected, run(threads)) << threads;
  }
}

}  // namespace
}  // namespace ductile::meshadapt::hessian_test
