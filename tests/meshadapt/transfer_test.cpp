#include "ductile/meshadapt/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::transfer_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;

template <class Dimension>
class TransferIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TransferIn, Dimensions, );

const Executor executor({.threads = 2});

/// A jiggled grid over the unit square or cube with a hole in it, the same hole for every n that
/// is a multiple of 3.
template <int Dim>
AnyMesh holed_grid(int n, std::uint64_t seed) {
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = [n](const test::Cell& cell) {
    bool middle = true;
    for (int axis = 0; axis < Dim; ++axis)
      middle = middle && 3 * cell[static_cast<std::size_t>(axis)] >= n &&
               3 * cell[static_cast<std::size_t>(axis)] < 2 * n;
    return middle ? 0 : 1;
  };
  grid.seed = seed;
  AnyMesh any = test::make_grid(grid);
  Random random(seed);
  test::jiggle(any, random, 0.3);
  return any;
}

template <int Dim>
Vector<Dim> position(const AnyMesh& any, std::size_t vertex) {
  return test::point<Dim>(any, static_cast<std::uint32_t>(vertex));
}

/// A scalar and a vector field; component k is function(k, position).
template <int Dim>
AnyField field_on(const AnyMesh& any,
                  const std::function<double(std::size_t, const Vector<Dim>&)>& function) {
  AnyField field{
      Dim, any.vertex_count(), {AnyField::Type::scalar, AnyField::Type::vector}, {}, "f"};
  for (std::size_t v = 0; v < any.vertex_count(); ++v)
    for (std::size_t k = 0; k <= Dim; ++k)
      field.values.push_back(function(k, position<Dim>(any, v)));
  return field;
}

template <int Dim>
double linear(std::size_t component, const Vector<Dim>& p) {
  double value = 1 + static_cast<double>(component);
  for (int i = 0; i < Dim; ++i) value += (i + 1.5 - 2.0 * static_cast<double>(component)) * p[i];
  return value;
}

/// 0 or 1, with a front between that is as steep as the mesh allows.
template <int Dim>
double front(std::size_t component, const Vector<Dim>& p) {
  return p[0] + 0.3 * std::sin(9 * p[1]) > 0.3 + 0.1 * static_cast<double>(component) ? 1 : 0;
}

/// [component] Integral
template <int Dim>
std::vector<double> integrals(const AnyMesh& any, const AnyField& field) {
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  std::vector<double> result;
  for (std::size_t k = 0; k <= Dim; ++k) {
    std::vector<double> value_of;
    for (std::size_t v = 0; v < any.vertex_count(); ++v)
      value_of.push_back(field.values[v * (Dim + 1) + k]);
    result.push_back(integral<Dim>(executor, mesh, value_of));
  }
  return result;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return a.size() == b.size() ? most : HUGE_VAL;
}

template <int Dim>
void scale_about_the_centre(AnyMesh& any, double factor) {
  for (double& x : any.coordinates) x = 0.5 + factor * (x - 0.5);
}

TYPED_TEST(TransferIn, IsExactForLinearFieldsAlways) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh old_mesh = holed_grid<Dim>(6, 1);
  const AnyField field = field_on<Dim>(old_mesh, linear<Dim>);
  for (const int n : {3, 9}) {
    const AnyMesh new_mesh = holed_grid<Dim>(n, 2);
    const auto expected = field_on<Dim>(new_mesh, linear<Dim>).values;
    const auto values = [&](const TransferredField& result) {
      EXPECT_EQ(result.field.types, field.types);
      EXPECT_EQ(result.report.vertices_outside, 0U);
      EXPECT_EQ(result.report.volume_outside, 0);
      EXPECT_EQ(result.report.volume_left_out, 0);
      return result.field.values;
    };
    EXPECT_LT(
        difference(values(interpolate_field(executor, {old_mesh, field}, new_mesh)), expected),
        1e-12);
    for (const bool keep_bounds : {true, false})
      EXPECT_LT(difference(values(project_field(executor, {old_mesh, field}, new_mesh,
                                                {.keep_bounds = keep_bounds})),
                           expected),
                1e-11);
  }
}

TYPED_TEST(TransferIn, ProjectionKeepsIntegrals) {
  if (test::address_sanitized) GTEST_SKIP() << test::takes_long;
  constexpr int Dim = TypeParam::value;
  const AnyMesh old_mesh = holed_grid<Dim>(6, 3);
  const AnyField field = field_on<Dim>(old_mesh, front<Dim>);
  const auto expected = integrals<Dim>(old_mesh, field);
  for (const int n : {3, 6, 12})
    for (const bool keep_bounds : {true, false}) {
      const AnyMesh new_mesh = holed_grid<Dim>(n, 4);
      const auto result =
          project_field(executor, {old_mesh, field}, new_mesh, {.keep_bounds = keep_bounds});
      EXPECT_LT(difference(integrals<Dim>(new_mesh, result.field), expected), 2e-14);
    }
}

TYPED_TEST(TransferIn, KeepsBounds) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh old_mesh = holed_grid<Dim>(9, 5), new_mesh = holed_grid<Dim>(6, 6);
  const AnyField field = field_on<Dim>(old_mesh, front<Dim>);
  const auto interpolated = interpolate_field(executor, {old_mesh, field}, new_mesh).field.values;
  const auto projected = project_field(executor, {old_mesh, field}, new_mesh).field.values;
  const auto closest =
      project_field(executor, {old_mesh, field}, new_mesh, {.keep_bounds = false}).field.values;
  for (const auto& values : {interpolated, projected}) {
    EXPECT_GE(*std::min_element(values.begin(), values.end()), 0);
    EXPECT_LE(*std::max_element(values.begin(), values.end()), 1);
  }
  EXPECT_GT(*std::max_element(closest.begin(), closest.end()), 1.01);  // so there was work to do
}

TYPED_TEST(TransferIn, CopesWithSliversAndStretchedMeshes) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 0; seed < (Dim == 2 ? 10 : 4); ++seed) {
    std::array<AnyMesh, 2> mesh;
    for (std::size_t i = 0; i < 2; ++i) {
      Random random(seed + 100 * i), same(seed);
      mesh[i] = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 8 : 5));
      test::jiggle(mesh[i], random, 0.4);
      test::make_slivers(mesh[i], random, 5, 1e-6);
      for (std::size_t v = 0; v < mesh[i].vertex_count(); ++v) mesh[i].coordinates[v * Dim] *= 1e-3;
      test::place(mesh[i], same, 1000, 0);
    }
    const auto scaled = [](std::size_t k, const Vector<Dim>& p) { return linear(k, 1e-3 * p); };
    const auto sign = [](std::size_t k, const Vector<Dim>& p) {
      return p[0] + p[1] > 100 * static_cast<double>(k) ? 1.0 : 0.0;
    };
    const AnyField steep = field_on<Dim>(mesh[0], sign), smooth = field_on<Dim>(mesh[0], scaled);
    const auto carried = project_field(executor, {mesh[0], steep}, mesh[1]).field;
    const double volume = std::pow(1000, Dim) * 1e-3;
    EXPECT_LT(difference(integrals<Dim>(mesh[1], carried), integrals<Dim>(mesh[0], steep)),
              1e-12 * volume);
    EXPECT_GE(*std::min_element(carried.values.begin(), carried.values.end()), 0);
    EXPECT_LE(*std::max_element(carried.values.begin(), carried.values.end()), 1);
    EXPECT_LT(difference(project_field(executor, {mesh[0], smooth}, mesh[1]).field.values,
                         field_on<Dim>(mesh[1], scaled).values),
              1e-8);
  }
}

TYPED_TEST(TransferIn, LeavesAFieldOnTheSameMeshAsItIs) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = holed_grid<Dim>(6, 7);
  Random random(8);
  const AnyField field =
      field_on<Dim>(mesh, [&](std::size_t, const Vector<Dim>&) { return uniform(random, -1, 1); });
  EXPECT_LT(difference(interpolate_field(executor, {mesh, field}, mesh).field.values, field.values),
            1e-12);
  for (const bool keep_bounds : {true, false})
    EXPECT_LT(
        difference(
            project_field(executor, {mesh, field}, mesh, {.keep_bounds = keep_bounds}).field.values,
            field.values),
        1e-11);
}

TYPED_TEST(TransferIn, ExtendsTheFieldWhereTheNewMeshReachesBeyond) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh old_mesh = test::make_grid(test::unit_grid(Dim, 5));
  AnyMesh new_mesh = test::make_grid(test::unit_grid(Dim, 6));
  scale_about_the_centre<Dim>(new_mesh, 1.1);
  const auto constant = [](std::size_t k, const Vector<Dim>&) { return static_cast<double>(k); };
  const auto inwards = [](std::size_t, const Vector<Dim>& p) { return p[0]; };
  for (const bool keep_bounds : {true, false}) {
    const auto same = project_field(executor, {old_mesh, field_on<Dim>(old_mesh, constant)},
                                    new_mesh, {.keep_bounds = keep_bounds});
    EXPECT_LT(difference(same.field.values, field_on<Dim>(new_mesh, constant).values), 1e-12);
    EXPECT_NEAR(same.report.volume_outside, std::pow(1.1, Dim) - 1, 1e-10);
    EXPECT_EQ(same.report.volume_left_out, 0);
    EXPECT_EQ(same.report.vertices_outside, std::size_t{Dim == 2 ? 49 - 25 : 343 - 125});
  }
  const auto values =
      interpolate_field(executor, {old_mesh, field_on<Dim>(old_mesh, inwards)}, new_mesh)
          .field.values;
  for (std::size_t v = 0; v < new_mesh.vertex_count(); ++v)
    EXPECT_NEAR(values[v * (Dim + 1)], std::clamp(position<Dim>(new_mesh, v)[0], 0.0, 1.0), 1e-12);
}

TYPED_TEST(TransferIn, TellsWhatTheNewMeshLeavesOut) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh old_mesh = test::make_grid(test::unit_grid(Dim, 5));
  AnyMesh new_mesh = test::make_grid(test::unit_grid(Dim, 4));
  scale_about_the_centre<Dim>(new_mesh, 0.8);
  const auto result =
      project_field(executor, {old_mesh, field_on<Dim>(old_mesh, linear<Dim>)}, new_mesh);
  EXPECT_NEAR(result.report.volume_left_out, 1 - std::pow(0.8, Dim), 1e-10);
  EXPECT_EQ(result.report.volume_outside, 0);
  EXPECT_LT(difference(result.field.values, field_on<Dim>(new_mesh, linear<Dim>).values), 1e-11);
}

TYPED_TEST(TransferIn, ConvergesInTheSecondOrder) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  constexpr int Dim = TypeParam::value;
  const auto wave = [](std::size_t k, const Vector<Dim>& p) {
    return std::sin(3 * p[0] + static_cast<double>(k)) * std::cos(2 * p[1]);
  };
  const auto error = [&](int n) {
    const AnyMesh old_mesh = holed_grid<Dim>(n, 9), new_mesh = holed_grid<Dim>(n, 10);
    const auto result =
        project_field(executor, {old_mesh, field_on<Dim>(old_mesh, wave)}, new_mesh);
    const auto exact = field_on<Dim>(new_mesh, wave).values;
    double sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i)
      sum += std::abs(exact[i] - result.field.values[i]);
    return sum / static_cast<double>(exact.size());
  };
  const int n = Dim == 2 ? 12 : 6;
  EXPECT_GT(std::log2(error(n) / error(2 * n)), Dim == 2 ? 1.7 : 1.4);  // 3D: 1.9 from 12 to 24
}

TYPED_TEST(TransferIn, InterpolatesAtAnyPoints) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = holed_grid<Dim>(6, 14);
  const AnyField field = field_on<Dim>(mesh, linear<Dim>);
  Random random(15);
  std::uniform_real_distribution<double> share(0.01, 1);
  std::vector<double> coordinates;
  std::vector<Vector<Dim>> points(100);
  for (Vector<Dim>& p : points)  // below the hole
    for (std::size_t axis = 0; axis < Dim; ++axis)
      coordinates.push_back(p[axis] = share(random) * (axis == 0 ? 0.3 : 0.99));
  const auto [at, report] = interpolate_at(executor, {mesh, field}, coordinates);
  EXPECT_EQ(report.vertices_outside, 0U);
  ASSERT_EQ(at.values.size(), points.size() * (Dim + 1));
  for (std::size_t i = 0; i < at.values.size(); ++i)
    EXPECT_NEAR(at.values[i], linear<Dim>(i % (Dim + 1), points[i / (Dim + 1)]), 1e-12);
  const auto vertices = interpolate_at(executor, {mesh, field}, mesh.coordinates).field;
  EXPECT_LT(difference(vertices.values, field.values), 1e-14);

  coordinates.assign(Dim, 0.5);  // in the hole
  EXPECT_EQ(interpolate_at(executor, {mesh, field}, coordinates).report.vertices_outside, 1U);
  EXPECT_EQ(interpolate_at(executor, {mesh, field}, {}).field.values.size(), 0U);
  coordinates[0] = std::nan("");
  EXPECT_THROW(interpolate_at(executor, {mesh, field}, coordinates), InputError);
  EXPECT_THROW(interpolate_at(executor, {mesh, field}, std::vector<double>(Dim + 1)), InputError);
}

TYPED_TEST(TransferIn, DoesNotDependOnThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  constexpr int Dim = TypeParam::value;
  const int n = Dim == 2 ? 30 : 6;
  const AnyMesh old_mesh = holed_grid<Dim>(n, 11), new_mesh = holed_grid<Dim>(n, 12);
  const AnyField field = field_on<Dim>(old_mesh, front<Dim>);
  const auto run = [&](int threads) {
    const Executor some({.threads = threads});
    return std::tuple(interpolate_field(some, {old_mesh, field}, new_mesh).field.values,
                      interpolate_at(some, {old_mesh, field}, new_mesh.coordinates).field.values,
                      project_field(some, {old_mesh, field}, new_mesh).field.values);
  };
  const auto expected = run(1);
  for (const int threads : test::thread_counts) EXPECT_EQ(expected, run(threads)) << threads;
}

/// The message of the InputError, "" if there is none.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TYPED_TEST(TransferIn, RefusesPlacesBeyondReasonEvenWhereNoElementIs) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = holed_grid<Dim>(3, 13);
  const AnyField field = field_on<Dim>(mesh, linear<Dim>);
  const std::string which = "new vertex " + std::to_string(mesh.vertex_count());
  for (const double x : {std::nan(""), 1e155, -HUGE_VAL}) {
    AnyMesh other = mesh;
    other.vertex_reference.push_back(0);
    other.coordinates.insert(other.coordinates.end(), Dim, x);
    EXPECT_NE(refusal([&] {
                interpolate_field(executor, {mesh, field}, other);
              }).find(which),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                project_field(executor, {mesh, field}, other);
              }).find(which),
              std::string::npos);
    AnyField longer = field;
    longer.vertex_count++;
    longer.values.resize(longer.vertex_count * (Dim + 1));
    EXPECT_THROW(interpolate_field(executor, {other, longer}, mesh), InputError);
  }
}

TYPED_TEST(TransferIn, RefusesToProjectWhatIsNoNumber) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = holed_grid<Dim>(3, 13), other = holed_grid<Dim>(6, 13);
  for (const double value : {std::nan(""), HUGE_VAL}) {
    AnyField field = field_on<Dim>(mesh, linear<Dim>);
    field.values[5 * (Dim + 1) + 1] = field.values[9 * (Dim + 1)] = value;
    EXPECT_NE(refusal([&] {
                project_field(executor, {mesh, field}, other);
              }).find("vertex 5;"),
              std::string::npos);
  }
}

TYPED_TEST(TransferIn, RefusesAFieldOfAnotherMesh) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = holed_grid<Dim>(3, 13), other = holed_grid<Dim>(6, 13);
  const AnyField field = field_on<Dim>(mesh, linear<Dim>);
  EXPECT_THROW(interpolate_field(executor, {other, field}, mesh), InputError);
  EXPECT_THROW(project_field(executor, {other, field}, mesh), InputError);
  EXPECT_THROW(project_field(executor, {mesh, field}, test::make_grid(test::unit_grid(5 - Dim, 2))),
               InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::transfer_test
