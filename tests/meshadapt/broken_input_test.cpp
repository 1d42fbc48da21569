/// @file
/// Calls every public function that takes tensors, numbers, options or names with randomly wrong
/// ones. It must refuse them by an InputError, and never crash.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "support/broken_input.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::broken_input_test {
namespace {

/// Callers often have their fields in a vector.
void write_vtu(const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields = {}) {
  write_mesh(path, mesh, {.fields = fields});
}

using test::below;
using test::chance;
using test::change_length;
using test::expect_refused;
using test::expect_survived;
using test::Folder;
using test::no_metric;
using test::no_number;
using test::Random;
using test::small_mesh;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

const runtime::Executor executor({.threads = 1});

template <class Dimension>
class BrokenInputIn : public testing::Test {};
TYPED_TEST_SUITE(BrokenInputIn, test::Dimensions, );

TYPED_TEST(BrokenInputIn, TensorsThatAreNoMetricsAreRefused) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = small_mesh<Dim>();
  const FixedMesh<Dim> mesh = make_fixed_mesh<Dim>(executor, any);
  using Metrics = std::vector<Metric<Dim>>;
  const Metrics good(mesh.vertex_count(), isotropic<Dim>(0.4));
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    Metrics bad = good;
    const std::size_t v = below(random, bad.size());
    const int fault = i % 3;
    if (fault == 0) bad[v] = no_metric<Dim>(random);
    if (fault == 1) bad[v].m[below(random, Metric<Dim>::size)] = no_number(random);
    if (fault == 2) bad.resize(chance(random, 0.5) ? bad.size() - 1 - v : bad.size() + 1 + v);
    SCOPED_TRACE(testing::Message() << fault << " at " << v);
    Metrics m = bad;
    if (fault != 2) expect_refused([&] { bound_sizes(executor, m, {}); }, "bound_sizes");
    if (fault != 2)
      expect_refused([&] { bound_sizes(executor, m = bad, {.smallest = 1e-3}); }, "bound_sizes");
    expect_survived([&] { bound_sizes(executor, m = bad, {.largest = 1}); }, "bound_sizes");
    expect_refused([&] { intersect(executor, m = bad, good); }, "intersect");
    expect_refused([&] { intersect(executor, m = good, bad); }, "intersect");
    expect_refused([&] { limit_gradation(executor, m = bad, mesh); }, "limit_gradation");
    expect_refused([&] { complexity<Dim>(executor, mesh, bad); }, "complexity");
    expect_refused([&] { scale_to_complexity<Dim>(executor, m = bad, mesh, {.complexity = 10}); },
                   "scale_to_complexity");
    const auto make = [&] { hessian_metric<Dim>(executor, mesh, bad, {.complexity = 10}); };
    if (fault == 0)
      expect_survived(make, "hessian_metric");
    else
      expect_refused(make, "hessian_metric");
  }
}

TYPED_TEST(BrokenInputIn, NumbersOfAWrongLengthAreRefused) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = small_mesh<Dim>();
  const FixedMesh<Dim> mesh = make_fixed_mesh<Dim>(executor, any);
  const AnyField field = scalar_field(Dim, std::vector<double>(mesh.vertex_count()));
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    std::vector<double> values(mesh.vertex_count(), 0.5);
    change_length(random, values);
    expect_refused([&] { integral<Dim>(executor, mesh, values); }, "integral");
    for (const Recovery how : {Recovery::least_squares, Recovery::double_projection}) {
      expect_refused([&] { recover_gradient<Dim>(executor, mesh, values, how); }, "gradient");
      expect_refused([&] { recover_hessian<Dim>(executor, mesh, values, how); }, "hessian");
    }
    std::vector<double> points(Dim * (1 + below(random, 9)), 0.5);
    points[below(random, points.size())] = chance(random, 0.5) ? no_number(random) : 1e200;
    if (chance(random, 0.5)) points = {0.5, 0.5, 0.5, 0.5, 0.5};
    expect_refused([&] { interpolate_at(executor, {any, field}, points); }, "interpolate_at");
  }
}

TYPED_TEST(BrokenInputIn, OptionsOutOfRangeAreRefused) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = small_mesh<Dim>();
  const AnyField metric = constant_metric(mesh, 0.4);
  for (const double bad : {nan, inf, -inf, -1.0, 1e-300, 1e-76, 1e76, 1e300}) {
    SCOPED_TRACE(bad);
    const auto refuses = [&](const AdaptOptions& options) {
      expect_refused([&] { adapt(executor, mesh, metric, options); }, "adapt");
    };
    refuses({.smallest_size = bad});
    refuses({.largest_size = bad});
    refuses({.make = {.hausdorff_tolerance = bad}});
    refuses({.rules = {.long_edge = bad}});
    if (!(bad > 0 && bad < 90)) refuses({.make = {.ridge_angle = bad}});
    if (!(bad <= 0 || (bad > 1 && bad < inf))) refuses({.gradation = bad});
    expect_refused([&] { constant_metric(mesh, bad); }, "constant_metric");
    std::vector<Metric<Dim>> metrics = tensors_of<Dim>(executor, metric);
    expect_refused([&] { bound_sizes(executor, metrics, {.smallest = bad}); }, "bound_sizes");
    expect_refused([&] { bound_sizes(executor, metrics, {.largest = bad}); }, "bound_sizes");
    if (!(bad >= 1 && bad < inf))
      expect_refused([&] { bound_sizes(executor, metrics, {.anisotropy = bad}); }, "bound_sizes");
  }
  for (const double bad : {nan, inf, -inf, -1.0, 0.0}) {
    const FixedMesh<Dim> fixed = make_fixed_mesh<Dim>(executor, mesh);
    std::vector<Metric<Dim>> metrics = tensors_of<Dim>(executor, metric);
    expect_refused([&] { limit_gradation(executor, metrics, fixed, {.factor = bad}); }, "grade");
    expect_refused([&] { scale_to_complexity<Dim>(executor, metrics, fixed, {.complexity = bad}); },
                   "scale");
    expect_refused([&] { hessian_metric<Dim>(executor, fixed, metrics, {.complexity = bad}); },
                   "make");
    expect_refused([&] { hessian_metric<Dim>(executor, fixed, metrics, {.error = bad}); }, "make");
  }
}

TYPED_TEST(BrokenInputIn, VtuNamesThatAreNoXmlAreRefused) {
  constexpr int Dim = TypeParam::value;
  const Folder folder;
  const AnyMesh mesh = small_mesh<Dim>();
  const std::vector<double> values(mesh.vertex_count(), 0.5);
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    std::string name = "good & <\"name\"> \xC3\xA9";
    const char* const bad[] = {
        "\x01",     "\x1B", "\xFF",     "\xC3(",       "\xED\xA0\x80", "\xF4\x90\x80\x80",
        "\xC0\x80", "\n",   "\xE2\x82", "\xEF\xBF\xBF"};
    name.insert(below(random, 5), bad[i % 10]);
    expect_refused(
        [&] {
          write_vtu(
              folder.path / "m.vtu", mesh,
              {{"first", AnyField::Type::scalar, values}, {name, AnyField::Type::scalar, values}});
        },
        "write_vtu");
  }
  EXPECT_NO_THROW(write_vtu(folder.path / "m.vtu", mesh,
                            {{"good & <\"name\"> \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80",
                              AnyField::Type::scalar, values}}));
  std::vector<double> wrong = values;
  change_length(random, wrong);
  expect_refused(
      [&] {
        write_vtu(folder.path / "m.vtu", mesh, {{"f", AnyField::Type::scalar, wrong}});
      },
      "write_vtu");
}

}  // namespace
}  // namespace ductile::meshadapt::broken_input_test
