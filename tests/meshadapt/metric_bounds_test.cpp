// Values of a field that are no metric by themselves, because they stand for "no limit": bounds on
// sizes are applied before validation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io_support.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::metric_bounds_test {
namespace {

using runtime::Executor;
using test::chance;
using test::Random;
using test::uniform;
using Type = AnyField::Type;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int Dim>
PrincipalAxes<Dim> random_axes(Random& random) {
  Metric<Dim> any;
  for (double& m : any.m) m = uniform(random, -1, 1);
  return principal_axes(any);
}

/// The value rounded to this number of digits.
double rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::atof(text);
}

/// A tensor with sizes from 0.05 to 0.5, some of whose eigenvalues are replaced by 0 or nearly 0.
template <int Dim>
Metric<Dim> random_singular(Random& random) {
  auto axes = random_axes<Dim>(random);
  for (double& value : axes.value) value = std::pow(uniform(random, 0.05, 0.5), -2);
  const std::size_t zeros = 1 + random() % Dim;
  const double next_to_zero = chance(random, 0.5) ? 0 : std::pow(10, uniform(random, -300, -20));
  for (std::size_t i = 0; i < zeros; ++i) axes.value[i] = next_to_zero;
  if (chance(random, 0.3))  // axis-parallel
    for (std::size_t i = 0; i < Dim; ++i) {
      axes.vector[i] = {};
      axes.vector[i].x[i] = 1;
    }
  Metric<Dim> tensor = compose(axes);
  const int digits = 7 + static_cast<int>(random() % 11);
  for (double& m : tensor.m) m = rounded(m, digits);
  return tensor;
}

double random_endless(Random& random) {
  const double sizes[] = {infinity, 1e300, 1e76, std::numeric_limits<double>::max()};
  return sizes[random() % 4];
}

template <int Dim>
AnyField random_field(Random& random, std::size_t vertices, std::vector<bool>& endless) {
  AnyField field{
      Dim, vertices, {chance(random, 0.4) ? Type::scalar : Type::symmetric}, {}, "a.sol"};
  for (std::size_t v = 0; v < vertices; ++v) {
    endless.push_back(chance(random, 0.3) || v == 0);
    const double size = uniform(random, 0.2, 0.4);
    if (field.types[0] == Type::scalar) {
      field.values.push_back(endless[v] ? random_endless(random) : size);
    } else {
      const auto tensor = endless[v] ? random_singular<Dim>(random) : isotropic<Dim>(size);
      field.values.insert(field.values.end(), tensor.m.begin(), tensor.m.end());
    }
  }
  return field;
}

/// Is the value at a vertex a metric without bounds?
bool is_metric_by_itself(const AnyField& field, std::size_t vertex) {
  const std::size_t stride = stride_of(field);
  AnyMesh point;
  point.dimension = field.dimension;
  point.coordinates.assign(static_cast<std::size_t>(field.dimension), 0);
  point.vertex_reference = {0};
  const double* first = &field.values[vertex * stride];
  try {
    metric_of({field.dimension, 1, field.types, {first, first + stride}, "a.sol"}, point);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

template <int Dim>
void bound(unsigned seed) {
  Random random(seed);
  AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 2));
  mesh.name = "a.mesh";
  std::vector<bool> endless;
  const AnyField field = random_field<Dim>(random, mesh.vertex_count(), endless);
  const SizeBounds bounds{chance(random, 0.5) ? 0.01 : 0, uniform(random, 0.2, 2)};
  std::size_t odd = 0;
  while (odd < mesh.vertex_count() && is_metric_by_itself(field, odd)) ++odd;
  if (odd < mesh.vertex_count()) {
    const std::string text = test::complaint([&] { metric_of(field, mesh); });
    EXPECT_NE(text.find("vertex " + std::to_string(odd) + ", found"), std::string::npos);
  }
  const AnyField metric = metric_of(field, mesh, bounds);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    Metric<Dim> tensor;
    std::copy_n(&metric.values[v * tensor.m.size()], tensor.m.size(), tensor.m.begin());
    if (is_metric_by_itself(field, v)) {
      if (field.types[0] == Type::symmetric) {
        EXPECT_TRUE(
            std::equal(tensor.m.begin(), tensor.m.end(), &field.values[v * tensor.m.size()]));
      }
      continue;
    }
    EXPECT_TRUE(endless[v]);
    const auto sizes = principal_axes(tensor).value;
    const double longest = 1 / std::sqrt(*std::min_element(sizes.begin(), sizes.end()));
    EXPECT_NEAR(longest, bounds.largest, 1e-4 * bounds.largest);
  }
  EXPECT_NO_THROW(metric_of(metric, mesh));
  if (field.types[0] == Type::scalar) return;
  const Executor executor({.threads = 2});
  const AdaptOptions options{.smallest_size = bounds.smallest, .largest_size = bounds.largest};
  const AdaptedMesh adapted = adapt(executor, mesh, field, options);
  EXPECT_EQ(adapted.mesh, adapt(executor, mesh, metric, options).mesh);
  EXPECT_TRUE(check_mesh(executor, adapted.mesh).empty());
}

TEST(MetricBounds, HoldWhereNoLimitIsGiven) {
  for (unsigned seed = 0; seed < test::trials(200); ++seed) {
    SCOPED_TRACE(seed);
    seed % 2 == 0 ? bound<2>(seed) : bound<3>(seed);
  }
}

TEST(MetricBounds, MakeNoMetricOfWhatIsNone) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(2, 1));
  const SizeBounds bounds{0.01, 1};
  const auto field = [](Type type, const std::vector<double>& first) {
    AnyField all{2, 4, {type}, {}, "a.sol"};
    for (int v = 0; v < 4; ++v) all.values.insert(all.values.end(), first.begin(), first.end());
    return all;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double size : {0.0, -1.0, -infinity, nan})
    EXPECT_NE(test::complaint([&] {
                metric_of(field(Type::scalar, {size}), mesh, bounds);
              }).find("a size from 1e-75 to 1e75 at values[0]"),
              std::string::npos);
  for (const std::vector<double>& tensor : std::vector<std::vector<double>>{
           {1, 2, 1}, {-1, 0, -1}, {4, 0, -1e-3}, {nan, 0, 1}, {infinity, 0, 1}, {1, infinity, 1}})
    EXPECT_NE(test::complaint([&] {
                metric_of(field(Type::symmetric, tensor), mesh, bounds);
              }).find("at values[0]"),
              std::string::npos);
  EXPECT_EQ(metric_of(field(Type::symmetric, {0, 0, 0}), mesh, bounds).values[0], 1);
  EXPECT_THROW(metric_of(field(Type::symmetric, {0, 0, 0}), mesh, {.smallest = 0.1}), InputError);
  EXPECT_NO_THROW(metric_of(field(Type::symmetric, {4, 0, 0}), mesh, {.anisotropy = 10}));
  EXPECT_NO_THROW(metric_of(field(Type::symmetric, {1e300, 0, 1}), mesh, bounds));
}

TEST(MetricBounds, FieldsAreInfiniteOnlyIfTheyMayBe) {
  const test::TemporaryFolder folder;
  const std::string text =
      "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n4\n1 1\ninf\n0.5\nInfinity 1e400\nEnd\n";
  test::put_bytes(folder / "a.sol", text);
  EXPECT_NE(test::complaint([&] { read_field(folder / "a.sol"); }).find("a.sol:6: "),
            std::string::npos);
  EXPECT_EQ(read_field(folder / "a.sol", nullptr, {.infinite = true}).values,
            (std::vector<double>{infinity, 0.5, infinity, infinity}));
  test::put_bytes(folder / "b.sol", text.substr(0, text.find("0.5")) + "nan\n1 1\nEnd\n");
  EXPECT_NE(test::complaint([&] {
              read_field(folder / "b.sol", nullptr, {.infinite = true});
            }).find("b.sol:7: expected a number"),
            std::string::npos);
}

}  // namespace
}  // namespace ductile::meshadapt::metric_bounds_test
