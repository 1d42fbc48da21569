/// @file
/// Calls every public function that takes a field with randomly broken fields. It must refuse them
/// by an InputError that names an array and mentions no file or option, and never crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "support/broken_input.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::broken_fields_test {
namespace {

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

const runtime::Executor executor({.threads = 1});

template <class Dimension>
class BrokenFieldsIn : public testing::Test {};
TYPED_TEST_SUITE(BrokenFieldsIn, test::Dimensions, );

enum class Fault { length, types, vertices, dimension, no_number, no_metric };

template <int Dim>
AnyField broken_field(Random& random, const AnyMesh& mesh, AnyField::Type type, Fault fault) {
  AnyField field{Dim, mesh.vertex_count(), {type}, {}, ""};
  if (type == AnyField::Type::symmetric)
    field.values = constant_metric(mesh, 0.4).values;
  else
    field.values.assign(field.vertex_count * stride_of(field), 0.4);
  const std::size_t v = below(random, field.vertex_count);
  switch (fault) {
    case Fault::length:
      change_length(random, field.values);
      break;
    case Fault::types:
      if (chance(random, 0.3))
        field.types.clear();
      else
        field.types[0] = static_cast<AnyField::Type>(chance(random, 0.5) ? 0 : 9);
      break;
    case Fault::vertices:
      field.vertex_count = chance(random, 0.3) ? std::size_t{1} << 62U
                                               : below(random, 3 * field.vertex_count) * 2 + 1;
      if (field.vertex_count == mesh.vertex_count()) ++field.vertex_count;
      break;
    case Fault::dimension:
      field.dimension = chance(random, 0.5) ? 0 : 7;
      break;
    case Fault::no_number:
      field.values[v * stride_of(field) + below(random, stride_of(field))] = no_number(random);
      break;
    case Fault::no_metric: {
      const Metric<Dim> bad = no_metric<Dim>(random);
      if (type == AnyField::Type::symmetric)
        std::copy(bad.m.begin(), bad.m.end(), &field.values[v * bad.m.size()]);
      else
        field.values[v] = -field.values[v];
      break;
    }
  }
  return field;
}

struct OfField {
  const char* name;
  AnyField::Type type;
  std::function<void(const AnyField&)> call;
  std::set<Fault> looks_at;
};

template <int Dim>
std::vector<OfField> functions_of_fields(const AnyMesh& mesh, const std::filesystem::path& folder) {
  using Type = AnyField::Type;
  const std::set<Fault> lengths{Fault::length, Fault::types, Fault::vertices, Fault::dimension};
  std::set<Fault> finite = lengths, all = lengths;
  finite.insert(Fault::no_number);
  all.insert({Fault::no_number, Fault::no_metric});
  const AnyField other = scalar_field(Dim, std::vector<double>(mesh.vertex_count()), "other");
  const std::vector<double> points(4 * Dim, 0.3);
  return {
      {"adapt", Type::symmetric, [=](const AnyField& f) { adapt(executor, mesh, f); }, all},
      {"metric_of", Type::symmetric, [=](const AnyField& f) { metric_of(f, mesh); }, all},
      {"metric_of, sizes", Type::scalar, [=](const AnyField& f) { metric_of(f, mesh); }, all},
      {"measure", Type::symmetric, [=](const AnyField& f) { measure(executor, mesh, &f); }, all},
      {"element_qualities", Type::symmetric,
       [=](const AnyField& f) { element_qualities(executor, mesh, &f); }, all},
      {"tensors_of", Type::symmetric, [](const AnyField& f) { tensors_of<Dim>(executor, f); },
       lengths},
      {"tensors_of, later", Type::symmetric,
       [](const AnyField& f) { tensors_of<Dim>(executor, f, 2); }, lengths},
      {"expect_field_of", Type::scalar, [=](const AnyField& f) { expect_field_of(f, mesh); },
       lengths},
      {"joined", Type::scalar, [=](const AnyField& f) { joined(f, other); }, lengths},
      {"joined, second", Type::scalar, [=](const AnyField& f) { joined(other, f); }, lengths},
      {"scalars_of",
       Type::scalar,
       [](const AnyField& f) { scalars_of(f); },
       {Fault::length, Fault::types, Fault::vertices, Fault::dimension}},
      {"vectors_of",
       Type::vector,
       [](const AnyField& f) { vectors_of<Dim>(f); },
       {Fault::length, Fault::types, Fault::vertices, Fault::dimension}},
      {"recover_hessian", Type::scalar,
       [=](const AnyField& f) { recover_hessian(executor, mesh, f); }, lengths},
      {"solution_metric", Type::vector,
       [=](const AnyField& f) { solution_metric(executor, mesh, f, {.goal = {.complexity = 10}}); },
       finite},
      {"interpolate_field", Type::scalar,
       [=](const AnyField& f) {
         interpolate_field(executor, {mesh, f}, mesh);
       },
       lengths},
      {"interpolate_at", Type::matrix,
       [=](const AnyField& f) {
         interpolate_at(executor, {mesh, f}, points);
       },
       lengths},
      {"project_field", Type::scalar,
       [=](const AnyField& f) {
         project_field(executor, {mesh, f}, mesh);
       },
       finite},
      {"write_field", Type::vector, [=](const AnyField& f) { write_field(folder / "f.solb", f); },
       finite},
      {"named_fields", Type::vector, [](const AnyField& f) { named_fields(f, "f"); }, lengths},
  };
}

TYPED_TEST(BrokenFieldsIn, FieldsAreRefused) {
  constexpr int Dim = TypeParam::value;
  const Folder folder;
  const AnyMesh mesh = small_mesh<Dim>();
  for (const auto& [name, type, call, looks_at] : functions_of_fields<Dim>(mesh, folder.path)) {
    Random random(3);
    for (int i = 0; i < 120; ++i) {
      const auto fault = static_cast<Fault>(i % 6);
      const AnyField field = broken_field<Dim>(random, mesh, type, fault);
      const std::string what = std::string(name) + ", fault " + std::to_string(i % 6);
      if (looks_at.contains(fault) && name != std::string("tensors_of, later"))
        expect_refused([&, &call = call] { call(field); }, what);
      else
        expect_survived([&, &call = call] { call(field); }, what);
    }
  }
}

TYPED_TEST(BrokenFieldsIn, MessagesNameArrayAndIndex) {
  constexpr int Dim = TypeParam::value;
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  AnyMesh mesh = small_mesh<Dim>();
  const AnyField metric = constant_metric(mesh, 0.4);
  AnyField bad = metric;
  const std::size_t stride = stride_of(bad);
  bad.values[5 * stride] = -1;
  const std::string place = "values[" + std::to_string(5 * stride) + "], vertex 5";
  EXPECT_NE(message([&] { adapt(executor, mesh, bad); }).find(place), std::string::npos);
  EXPECT_NE(message([&] { metric_of(bad, mesh); }).find(place), std::string::npos);
  elements_in<Dim>(mesh).vertices[3][1] = 1000;
  const std::string element =
      (Dim == 2 ? "triangles" : "tetrahedra") + std::string(".vertices[3] names vertex 1000");
  EXPECT_NE(message([&] { adapt(executor, mesh, metric); }).find(element), std::string::npos)
      << message([&] { adapt(executor, mesh, metric); });
}

}  // namespace
}  // namespace ductile::meshadapt::broken_fields_test
