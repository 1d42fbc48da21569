/// @file
/// Every public function that takes arrays, with arrays that are broken in random ways: it refuses
/// them by an InputError that names an array and speaks of no file or option, and never crashes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/background.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/complexity.hpp"
#include "ductile/meshadapt/default_metric.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fields.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/gmf.hpp"
#include "ductile/meshadapt/hessian.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/meshadapt/vtu.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt {
namespace {

using test::below;
using test::chance;
using test::Random;
using test::uniform;

const runtime::Executor executor({.threads = 1});
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

template <class Dimension>
class BrokenInputIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BrokenInputIn, Dimensions, );

/// Refused by an InputError that one who has arrays and no files understands.
template <class Call>
void expect_refused(const Call& call, const std::string& what) {
  SCOPED_TRACE(what);
  try {
    call();
    ADD_FAILURE() << "taken";
  } catch (const InputError& error) {
    const std::string text = error.what();
    for (const char* word : {"option", " file", "--", " -h", ".mesh:"})
      EXPECT_EQ(text.find(word), std::string::npos) << text;
    EXPECT_NE(text.front(), ':') << text;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
}

/// Whatever becomes of it, it does not crash, and throws nothing else.
template <class Call>
void expect_survived(const Call& call, const std::string& what) {
  SCOPED_TRACE(what);
  try {
    call();
  } catch (const InputError&) {
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an InputError: " << error.what();
  }
}

// ---- Meshes ----

/// What of a mesh is broken, and so which functions can tell.
enum class Part { vertices, positions, elements, references, facets, lists };

template <int Dim>
AnyMesh small_mesh() {
  AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 2));
  if constexpr (Dim == 3) test::list_ridges(mesh);
  mesh.name.clear();
  return mesh;
}

void change_length(Random& random, auto& array) {
  if (chance(random, 0.3))
    array.clear();
  else if (chance(random, 0.5))
    array.resize(below(random, array.size()));
  else
    array.resize(array.size() + 1 + below(random, 5));
}

double no_number(Random& random) {
  constexpr double values[] = {nan, inf, -inf};
  return values[below(random, 3)];
}

std::uint32_t bad_index(Random& random, std::size_t limit) {
  const std::uint32_t values[] = {none, static_cast<std::uint32_t>(limit), 1U << 31U,
                                  static_cast<std::uint32_t>(limit + below(random, 1000))};
  return values[below(random, 4)];
}

template <class Cells>
void break_index(Random& random, Cells& cells, std::size_t limit) {
  auto& corners = cells.vertices[below(random, cells.size())];
  corners[below(random, corners.size())] = bad_index(random, limit);
}

template <int Dim>
AnyMesh broken_mesh(Random& random, Part part) {
  AnyMesh mesh = small_mesh<Dim>();
  const std::size_t vertices = mesh.vertex_count();
  switch (part) {
    case Part::vertices:
      if (chance(random, 0.2))
        mesh.dimension = static_cast<int>(below(random, 9)) - 3 == Dim ? 7 : 0;
      else if (chance(random, 0.5))
        change_length(random, mesh.coordinates);
      else
        change_length(random, mesh.vertex_reference);
      break;
    case Part::positions:
      mesh.coordinates[below(random, vertices * Dim)] = no_number(random);
      break;
    case Part::elements:
      break_index(random, elements_in<Dim>(mesh), vertices);
      break;
    case Part::references:
      change_length(random, elements_in<Dim>(mesh).reference);
      break;
    case Part::facets:
      if (chance(random, 0.5))
        break_index(random, facets_in<Dim>(mesh), vertices);
      else
        change_length(random, facets_in<Dim>(mesh).reference);
      break;
    case Part::lists: {
      std::vector<std::uint32_t>* const lists[] = {
          &mesh.corners, &mesh.required_vertices, &mesh.required_edges, &mesh.ridges,
          Dim == 2 ? &mesh.required_triangles : &mesh.required_tetrahedra};
      lists[below(random, 5)]->push_back(bad_index(random, 100000));
      break;
    }
  }
  return mesh;
}

/// A function of a mesh and what it looks at.
struct OfMesh {
  const char* name;
  std::function<void(const AnyMesh&)> call;
  std::set<Part> looks_at;
};

template <int Dim>
std::vector<OfMesh> functions_of_meshes(const std::filesystem::path& folder) {
  const std::set<Part> geometry{Part::vertices, Part::positions, Part::elements};
  const std::set<Part> all{Part::vertices,   Part::positions, Part::elements,
                           Part::references, Part::facets,    Part::lists};
  const auto scalars = [](const AnyMesh& mesh) {
    return AnyField{mesh.dimension,
                    mesh.vertex_count(),
                    {AnyField::Type::scalar},
                    std::vector<double>(mesh.vertex_count(), 0.5),
                    ""};
  };
  const auto whole = std::make_shared<AnyMesh>(small_mesh<Dim>());
  const auto metric = std::make_shared<AnyField>(constant_metric(*whole, 0.4));
  return {
      {"adapt", [=](const AnyMesh& m) { adapt(executor, m, *metric); }, all},
      {"constant_metric", [](const AnyMesh& m) { constant_metric(m, 0.1); }, {Part::vertices}},
      {"default_metric",
       [](const AnyMesh& m) { default_metric(executor, m); },
       {Part::vertices, Part::elements}},
      {"implied_metric",
       [](const AnyMesh& m) { implied_metric(m); },
       {Part::vertices, Part::elements}},
      {"implied_tensors", [](const AnyMesh& m) { implied_tensors(executor, m); }, geometry},
      {"make_fixed_mesh", [](const AnyMesh& m) { make_fixed_mesh<Dim>(executor, m); }, geometry},
      {"make_mesh",
       [](const AnyMesh& m) {
         Neighbours<Dim> neighbours;
         Warnings warnings;
         make_mesh<Dim>(executor, m, {}, neighbours, warnings);
       },
       all},
      {"check_domain, before",
       [=](const AnyMesh& m) { check_domain(m, *whole); },
       {Part::vertices, Part::elements, Part::references, Part::facets}},
      {"check_domain, after",
       [=](const AnyMesh& m) { check_domain(*whole, m, 0.1); },
       {Part::vertices, Part::elements, Part::references, Part::facets}},
      {"check_boundary", [](const AnyMesh& m) { check_boundary(executor, m); }, {Part::vertices}},
      {"measure", [](const AnyMesh& m) { measure(executor, m, nullptr); }, geometry},
      {"measure in a metric", [=](const AnyMesh& m) { measure(executor, m, metric.get()); },
       geometry},
      {"element_qualities", [](const AnyMesh& m) { element_qualities(executor, m, nullptr); },
       geometry},
      {"metric_of", [=](const AnyMesh& m) { metric_of(*metric, m); }, {Part::vertices}},
      {"recover_hessian", [=](const AnyMesh& m) { recover_hessian(executor, m, scalars(m)); },
       geometry},
      {"solution_metric",
       [=](const AnyMesh& m) {
         solution_metric(executor, m, scalars(m), {.goal = {.complexity = 10}});
       },
       geometry},
      {"interpolate_field, from",
       [=](const AnyMesh& m) {
         interpolate_field(executor, {m, scalars(m)}, *whole);
       },
       geometry},
      {"interpolate_field, to",
       [=](const AnyMesh& m) {
         interpolate_field(executor, {*whole, scalars(*whole)}, m);
       },
       geometry},
      {"project_field, to",
       [=](const AnyMesh& m) {
         project_field(executor, {*whole, scalars(*whole)}, m);
       },
       geometry},
      {"write_mesh", [=](const AnyMesh& m) { write_mesh(folder / "m.meshb", m); }, all},
      {"write_vtu",
       [=](const AnyMesh& m) { write_vtu(folder / "m.vtu", m); },
       {Part::vertices, Part::positions, Part::elements, Part::references, Part::facets}},
  };
}

/// A folder that goes away.
struct Folder {
  std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      ("broken_input_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
       testing::UnitTest::GetInstance()->current_test_info()->test_suite_name()[14]);
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

TYPED_TEST(BrokenInputIn, MeshesAreRefused) {
  constexpr int Dim = TypeParam::value;
  const Folder folder;
  for (const auto& [name, call, looks_at] : functions_of_meshes<Dim>(folder.path)) {
    Random random(1);
    for (int i = 0; i < 120; ++i) {
      const auto part = static_cast<Part>(i % 6);
      const AnyMesh mesh = broken_mesh<Dim>(random, part);
      const std::string what = std::string(name) + ", part " + std::to_string(i % 6);
      if (looks_at.contains(part))
        expect_refused([&, &call = call] { call(mesh); }, what);
      else
        expect_survived([&, &call = call] { call(mesh); }, what);
    }
  }
}

TYPED_TEST(BrokenInputIn, CheckMeshSaysThatAMeshIsBroken) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const auto part = static_cast<Part>(i % 6);
    const AnyMesh mesh = broken_mesh<Dim>(random, part);
    expect_survived([&] { EXPECT_FALSE(check_mesh(executor, mesh).empty()) << i % 6; },
                    "check_mesh");
  }
}

// ---- Fields ----

enum class Fault { length, types, vertices, dimension, no_number, no_metric };

template <int Dim>
Metric<Dim> no_metric(Random& random) {
  std::array<double, Dim> sizes;
  for (double& size : sizes) size = uniform(random, 0.1, 1);
  PrincipalAxes<Dim> axes = principal_axes(test::random_metric<Dim>(random, sizes));
  switch (below(random, 5)) {
    case 0:
      return {};
    case 1:
      axes.value.fill(-1);
      break;
    case 2:
      axes.value[0] *= -1;
      break;
    case 3: {  // along axes of the space, as rounding would else make another of it
      Metric<Dim> stretched = isotropic<Dim>(1);
      stretched.m[0] = 1e-20;
      stretched.m[2] = 1e20;
      return stretched;
    }
    default:
      axes.value[Dim - 1] = -1e-3 * axes.value[0];
      break;
  }
  return compose(axes);
}

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
      {"vtu_fields", Type::vector, [](const AnyField& f) { vtu_fields(f, "f"); }, lengths},
  };
}

TYPED_TEST(BrokenInputIn, FieldsAreRefused) {
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

TYPED_TEST(BrokenInputIn, MessagesNameArrayAndIndex) {
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

// ---- Arrays of tensors and of numbers ----

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
    refuses({.make = {.surface_tolerance = bad}});
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

// ---- The background ----

/// Wherever the point is, and wherever the walk starts.
TYPED_TEST(BrokenInputIn, AWalkLeavesNoArray) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = small_mesh<Dim>();
  Neighbours<Dim> neighbours;
  Warnings warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v)
    mesh.site_of[v] = make_site(mesh.site_of[v].position, isotropic<Dim>(0.4));
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    Vector<Dim> point;
    for (double& x : point.x)
      x = chance(random, 0.3) ? no_number(random)
                              : uniform(random, -2, 2) * std::pow(10, uniform(random, -300, 300));
    const auto near = chance(random, 0.3)
                          ? bad_index(random, background.element_count())
                          : static_cast<ElementId>(below(random, background.element_count()));
    EXPECT_LT(background.sample(point, near).host, background.element_count());
  }
}

}  // namespace
}  // namespace ductile::meshadapt
