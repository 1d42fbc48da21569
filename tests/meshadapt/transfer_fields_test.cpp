/// @file
/// Fields by name, at vertices and on elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "mesh/walk.hpp"
#include "support/broken_input.hpp"
#include "support/metrics.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::transfer_fields_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;
using Type = AnyField::Type;
using Place = NamedField::Place;

template <class Dimension>
class TransferFieldsIn : public testing::Test {};
TYPED_TEST_SUITE(TransferFieldsIn, test::Dimensions, );

NamedField random_field(Random& random, const std::string& name, Type type, Place place,
                        const AnyMesh& mesh) {
  const std::size_t count =
      place == Place::vertices
          ? mesh.vertex_count()
          : std::max(mesh.tetrahedra.size(), mesh.dimension == 2 ? mesh.triangles.size() : 0);
  NamedField field{name, type, {}, place};
  for (std::size_t i = 0;
       i < count * static_cast<std::size_t>(component_count(type, mesh.dimension)); ++i)
    field.values.push_back(uniform(random, -1, 3) * std::pow(10.0, uniform(random, -3, 0)));
  return field;
}

/// A mesh of some shape, and another one of the same domain made from it.
struct Pair {
  AnyMesh before, after;
};
template <int Dim>
Pair random_pair(Random& random, std::uint64_t seed) {
  test::Grid grid = test::unit_grid(Dim, Dim == 2 ? 8 : 3);
  grid.region = seed % 3 == 0 ? test::whole : test::random_regions(seed, 2, seed % 3 == 1);
  AnyMesh before = test::make_grid(grid);
  test::jiggle(before, random, 0.3);
  const double scale = seed % 2 == 0 ? 1 : 1e-4;
  test::place(before, random, scale, 2 * scale);
  AnyField metric = test::wild_field(before, random, 1.5, uniform(random, 1, 8));
  test::scale_to(metric, before, (Dim == 2 ? 200 : 40) * uniform(random, 0.2, 1));
  AnyMesh after = adapt(Executor({.threads = 2}), before, metric).mesh;
  return {std::move(before), std::move(after)};
}

/// Sum over elements of value times volume, of one component.
template <int Dim>
double integral_of(const FixedMesh<Dim>& mesh, const NamedField& field, std::size_t stride,
                   std::size_t component, bool absolute = false) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const double value = field.values[e * stride + component];
    sum += mesh.volume_of[e] * (absolute ? std::abs(value) : value);
  }
  return sum;
}

/// The element in which a point lies deepest, found by testing all.
template <int Dim>
ElementId element_at(const FixedMesh<Dim>& mesh, const Vector<Dim>& point, double& depth) {
  ElementId best = none;
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    const auto weight = barycentric<Dim>(mesh.points(e), point);
    const double lowest = *std::min_element(weight.begin(), weight.end());
    if (best == none || lowest > depth) best = e, depth = lowest;
  }
  return best;
}

template <int Dim>
void expect_conserved(const Pair& pair, const NamedField& field, const NamedField& carried) {
  const auto old_mesh = make_fixed_mesh<Dim>(Executor(), pair.before);
  const auto mesh = make_fixed_mesh<Dim>(Executor(), pair.after);
  const auto stride = static_cast<std::size_t>(component_count(field.type, Dim));
  ASSERT_EQ(carried.values.size(), stride * mesh.element_count());
  for (std::size_t k = 0; k < stride; ++k) {
    const double scale = integral_of(old_mesh, field, stride, k, true);
    EXPECT_NEAR(integral_of(mesh, carried, stride, k), integral_of(old_mesh, field, stride, k),
                1e-12 * scale)
        << field.name << ' ' << k;
  }
  const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
  for (const double value : carried.values) EXPECT_TRUE(value >= *low && value <= *high) << value;
}

TYPED_TEST(TransferFieldsIn, KeepIntegralsOnElementsAndTakeValuesAtCentroids) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 0; seed < test::trials(3); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Pair pair = random_pair<Dim>(random, seed);
    NamedField constant =
        random_field(random, "constant", Type::scalar, Place::elements, pair.before);
    std::fill(constant.values.begin(), constant.values.end(), 0.1);
    const std::vector<NamedField> fields{
        random_field(random, "density", Type::scalar, Place::elements, pair.before),
        random_field(random, "material", Type::scalar, Place::elements, pair.before),
        random_field(random, "stress", Type::matrix, Place::elements, pair.before),
        random_field(random, "u", Type::vector, Place::vertices, pair.before),
        constant,
        random_field(random, "T", Type::scalar, Place::vertices, pair.before)};
    constexpr auto by_value = Carrying::by_value, conservatively = Carrying::conservatively;
    const std::vector<Carrying> how{conservatively, by_value,       conservatively,
                                    by_value,       conservatively, conservatively};
    const TransferredFields result =
        transfer_fields(Executor({.threads = 3}), {pair.before, fields}, pair.after, how);
    const auto again =
        transfer_fields(Executor({.threads = 1}), {pair.before, fields}, pair.after, how);
    ASSERT_EQ(result.fields.size(), fields.size());
    for (std::size_t f = 0; f < fields.size(); ++f) {
      EXPECT_EQ(result.fields[f].name, fields[f].name);
      EXPECT_EQ(result.fields[f].type, fields[f].type);
      EXPECT_EQ(result.fields[f].place, fields[f].place);
      EXPECT_EQ(result.fields[f].values, again.fields[f].values) << "differs on one thread";
    }
    EXPECT_EQ(result.report.volume_outside, 0);
    EXPECT_EQ(result.report.volume_left_out, 0);
    EXPECT_EQ(result.report.vertices_outside, 0U);
    for (const std::size_t f : {0, 2, 4}) expect_conserved<Dim>(pair, fields[f], result.fields[f]);
    for (const double value : result.fields[4].values) EXPECT_EQ(value, 0.1);
    // By value: the value of the element that contains the centroid, unless it is close to a side.
    const auto old_mesh = make_fixed_mesh<Dim>(Executor(), pair.before);
    const auto mesh = make_fixed_mesh<Dim>(Executor(), pair.after);
    for (ElementId e = 0; e < mesh.element_count(); e += 5) {
      Vector<Dim> centroid;
      for (const auto& p : mesh.points(e)) centroid += (1.0 / (Dim + 1)) * p;
      double depth = 0;
      const ElementId host = element_at(old_mesh, centroid, depth);
      if (depth > 1e-8) {
        EXPECT_EQ(result.fields[1].values[e], fields[1].values[host]) << e;
      }
    }
    // At vertices: the same as the functions for one field.
    const AnyField u{Dim, pair.before.vertex_count(), {Type::vector}, fields[3].values, "u"};
    const AnyField t{Dim, pair.before.vertex_count(), {Type::scalar}, fields[5].values, "T"};
    EXPECT_EQ(result.fields[3].values,
              interpolate_field(Executor(), {pair.before, u}, pair.after).field.values);
    EXPECT_EQ(result.fields[5].values,
              project_field(Executor(), {pair.before, t}, pair.after).field.values);
  }
}

/// The new box is the old one, shifted by half its length.
TYPED_TEST(TransferFieldsIn, TakeTheClosestValueBeyondTheOldMesh) {
  constexpr int Dim = TypeParam::value;
  std::array<double, Dim> extent;
  std::array<int, Dim> coarse, fine;
  extent.fill(1);
  coarse.fill(3);
  fine.fill(5);
  const AnyMesh before = box_mesh<Dim>(extent, coarse);
  AnyMesh after = box_mesh<Dim>(extent, fine);
  for (std::size_t i = 0; i < after.coordinates.size(); i += Dim) after.coordinates[i] += 0.5;
  std::vector<double> left_to_right;
  const auto fixed = make_fixed_mesh<Dim>(Executor(), before);
  for (ElementId e = 0; e < fixed.element_count(); ++e) {
    double x = 0;
    for (const auto& p : fixed.points(e)) x += p[0] / (Dim + 1);
    left_to_right.push_back(std::floor(3 * x));
  }
  const std::vector<NamedField> fields{{"x", Type::scalar, left_to_right, Place::elements}};
  const auto mean = transfer_fields(Executor({.threads = 2}), {before, fields}, after,
                                    {Carrying::conservatively});
  const auto sampled = transfer_fields(Executor({.threads = 2}), {before, fields}, after);
  EXPECT_NEAR(mean.report.volume_outside, 0.5, 1e-12);
  EXPECT_NEAR(mean.report.volume_left_out, 0.5, 1e-12);
  EXPECT_EQ(sampled.report.volume_outside, 0) << "transfer by value measures no volumes";
  for (std::size_t e = 0; e < mean.fields[0].values.size(); ++e) {
    double x = 0;
    for (const VertexId v : elements_in<Dim>(after).vertices[e])
      x += position_in<Dim>(after, v)[0] / (Dim + 1);
    if (x > 0.75) {
      EXPECT_EQ(mean.fields[0].values[e], 2);
    }
    EXPECT_EQ(sampled.fields[0].values[e], x > 2 / 3.0 ? 2 : 1);
  }
}

TYPED_TEST(TransferFieldsIn, NameTheFieldThatDoesNotFit) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = test::small_mesh<Dim>();
  const std::string count = std::to_string(elements_in<Dim>(mesh).size());
  Random random(1);
  const NamedField good = random_field(random, "p", Type::scalar, Place::elements, mesh);
  const auto message = [&](NamedField bad, std::vector<Carrying> how) -> std::string {
    const std::vector<NamedField> fields{good, std::move(bad)};
    try {
      transfer_fields(Executor({.threads = 1}), {mesh, fields}, mesh, how);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  const std::vector<Carrying> mean{Carrying::conservatively}, value{Carrying::by_value};
  EXPECT_EQ(message(good, mean), "taken");
  NamedField bad = good;
  bad.name = "q";
  bad.values.pop_back();
  EXPECT_EQ(message(bad, value), "fields[1] \"q\": expected 1 numbers in values for each of the " +
                                     count + " elements, found " +
                                     std::to_string(bad.values.size()));
  bad = good;
  bad.name.clear();
  bad.values[3] = 1 / 0.0;
  EXPECT_EQ(message(bad, mean), "fields[1]: expected finite numbers, found inf at values[3]");
  EXPECT_EQ(message(bad, value), "taken");
  bad.type = static_cast<Type>(9);
  EXPECT_EQ(message(bad, value), "fields[1]: expected a type from 1 to 4, found 9");
  EXPECT_EQ(message(good, {}),
            "carrying: expected one entry, or one for each of the 2 fields, found 0");
}

}  // namespace
}  // namespace ductile::meshadapt::transfer_fields_test
