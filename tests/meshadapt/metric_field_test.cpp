#include "ductile/meshadapt/metric_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "io_support.hpp"

namespace ductile::meshadapt::metric_field_test {
namespace {

using Type = AnyField::Type;
using Values = std::vector<double>;

AnyMesh mesh_of(int dimension, std::size_t vertices) {
  AnyMesh mesh;
  mesh.dimension = dimension;
  mesh.vertex_reference.resize(vertices);
  mesh.coordinates.resize(vertices * static_cast<std::size_t>(dimension));
  mesh.name = "a.mesh";
  return mesh;
}

AnyField field_of(int dimension, Type type, Values values) {
  AnyField field{dimension, 0, {type}, std::move(values), "a.sol"};
  field.vertex_count = field.values.size() / stride_of(field);
  return field;
}

TEST(MetricField, MakesTensorsOfSizes) {
  const AnyField metric = metric_of(field_of(2, Type::scalar, {1, 0.5}), mesh_of(2, 2));
  EXPECT_EQ(metric.types, std::vector{Type::symmetric});
  EXPECT_EQ(metric.values, (Values{1, 0, 1, 4, 0, 4}));
  EXPECT_EQ(metric_of(field_of(3, Type::scalar, {0.25}), mesh_of(3, 1)).values,
            (Values{16, 0, 16, 0, 0, 16}));
}

TEST(MetricField, TakesTensorsAsTheyAre) {
  const Values values = {2, 1, 2, 0.5, 0.25, 3};
  EXPECT_EQ(metric_of(field_of(3, Type::symmetric, values), mesh_of(3, 1)).values, values);
}

TEST(MetricField, TakesFullMatricesThatAreSymmetricButForRounding) {
  const double off = 1 + 1e-9;
  EXPECT_EQ(metric_of(field_of(2, Type::matrix, {2, 1, 1, 3}), mesh_of(2, 1)).values,
            (Values{2, 1, 3}));
  const Values space = {2, 1, 0.5, off, 3, 0.25, 0.5, 0.25, 4};
  EXPECT_EQ(metric_of(field_of(3, Type::matrix, space), mesh_of(3, 1)).values,
            (Values{2, 0.5 + 0.5 * off, 3, 0.5, 0.25, 4}));
  EXPECT_EQ(metric_of(field_of(3, Type::matrix, {2, 1, 0, 1, 3, 0, 0, 0, 4}), mesh_of(2, 1)).values,
            (Values{2, 1, 3}));
  const auto says = [](const Values& values) {
    return test::complaint(
        [&] { metric_of(field_of(2, Type::matrix, values), mesh_of(2, values.size() / 4)); });
  };
  EXPECT_EQ(says({1, 0, 0, 1, 2, 1, 1.1, 3}),
            "a.sol: expected a symmetric matrix at values[4], vertex 1, found 1 in row 0, column 1 "
            "and 1.1 opposite; correct the field there");
  EXPECT_NE(says({1, 0, 0, 1, 1, 2, 2, 1}).find("positive definite tensor at values[4], vertex 1"),
            std::string::npos);
  EXPECT_NE(says({0.0 / 0.0, 0, 0, 1}).find("at values[0], vertex 0"), std::string::npos);
}

TEST(MetricField, TakesThePlanePartForAFlatMesh) {
  EXPECT_EQ(metric_of(field_of(3, Type::symmetric, {2, 1, 2, 0, 0, 3}), mesh_of(2, 1)).values,
            (Values{2, 1, 2}));
  EXPECT_EQ(metric_of(field_of(3, Type::scalar, {1}), mesh_of(2, 1)).values, (Values{1, 0, 1}));
  EXPECT_NE(test::complaint([] {
              metric_of(field_of(3, Type::symmetric, {2, 1, 2, 1, 0, 3}), mesh_of(2, 1));
            }).find("out of the plane"),
            std::string::npos);
}

TEST(MetricField, AllowsWhatIsStretchedWithinReason) {
  const double ratio = 0.9 * largest_anisotropy;
  EXPECT_NO_THROW(metric_of(field_of(2, Type::symmetric, {ratio * ratio, 0, 1}), mesh_of(2, 1)));
  EXPECT_NO_THROW(
      metric_of(field_of(3, Type::symmetric, {1, 0, ratio, 0, 0, ratio * ratio}), mesh_of(3, 1)));
  // Rotated by 45 degrees, as exactly as doubles can represent such a tensor.
  const double large = 1e14;
  EXPECT_NO_THROW(
      metric_of(field_of(2, Type::symmetric, {(large + 1) / 2, (large - 1) / 2, (large + 1) / 2}),
                mesh_of(2, 1)));
}

TEST(MetricField, NamesFileVertexAndFault) {
  struct Wrong {
    AnyField field;
    std::string says;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  AnyField several = field_of(2, Type::scalar, {1, 1});
  several.types.push_back(Type::scalar);
  const std::vector<Wrong> wrong = {
      {several, "a.sol: expected one field, the metric, found 2"},
      {field_of(2, Type::vector, {1, 1, 1, 1}), "found type 2"},
      {field_of(2, Type::scalar, {1, 1, 1}), "2 values, one for each vertex of a.mesh, found 3"},
      {field_of(2, Type::scalar, {1, 0}), "a.sol: expected a size from 1e-75 to 1e75 at vertex 2"},
      {field_of(2, Type::scalar, {-1, 1}), "at vertex 1, found -1"},
      {field_of(2, Type::scalar, {1, nan}), "at vertex 2, found"},
      {field_of(2, Type::scalar, {1, 1e200}), "at vertex 2, found 1e+200"},
      {field_of(2, Type::symmetric, {1, 0, 1, 1, 2, 1}),
       "expected a positive definite tensor at vertex 2, found eigenvalues from -1 to 3"},
      {field_of(2, Type::symmetric, {1, 0, 1, -1, 0, -1}), "positive definite tensor at vertex 2"},
      {field_of(2, Type::symmetric, {1, 0, 1, 0, 0, 0}), "positive definite tensor at vertex 2"},
      {field_of(2, Type::symmetric, {1, 0, 1, 1, 0, 1e18}), "differ by at most 1e+08 times"},
      {field_of(2, Type::symmetric, {1, 0, 1, 1e-200, 0, 1e-200}), "sizes from 1e-75"},
  };
  for (const Wrong& fault : wrong) {
    std::string text;
    try {
      metric_of(fault.field, mesh_of(2, 2));
    } catch (const InputError& error) {
      text = error.in_file();
    }
    EXPECT_NE(text.find(fault.says), std::string::npos) << text;
  }
  const std::vector<Values> in_space = {{1, 0, 1, 0, 0, -1},  {1, 2, 1, 0, 0, 1},
                                        {-1, 0, -1, 0, 0, 1}, {1, 0, 1, 0, 0, 1e17},
                                        {nan, 0, 1, 0, 0, 1}, {1, 1, 1, 1, 1, 1}};
  for (const Values& values : in_space)
    EXPECT_NE(test::complaint([&] {
                metric_of(field_of(3, Type::symmetric, values), mesh_of(3, 1));
              }).find("at values[0], vertex 0"),
              std::string::npos);
  EXPECT_THROW(metric_of(field_of(2, Type::scalar, {1}), mesh_of(3, 1)), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::metric_field_test
