/// @file
/// Tests of cut(): meshes of many kinds are cut along functions of many kinds.
#include "ductile/meshadapt/level_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cut_support.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::cut_test {
namespace {

template <class Dimension>
class Cut : public testing::Test {};
template <class Dimension>
class CutRandom : public testing::Test {};
template <int Dim>
using Dimension = std::integral_constant<int, Dim>;
using Dimensions = testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(Cut, Dimensions);
TYPED_TEST_SUITE(CutRandom, Dimensions);

TYPED_TEST(CutRandom, MeshesWithFlatElementsAreCut) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  int tried = 0;
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Case c;
    const int n = Dim == 2 ? 9 : 5;
    c.mesh = random_mesh<Dim>(random, n, test::whole);
    test::make_slivers(c.mesh, random, 20, std::pow(10, -test::uniform(random, 2, 12)));
    if (test::chance(random, 0.3)) test::place(c.mesh, random, 10, 3);
    c.values = random_values<Dim>(c.mesh, random, static_cast<int>(seed % 7), 1.0 / n);
    if (!is_valid<Dim>(c.mesh)) continue;
    ++tried;
    expect_good<Dim>(c, cut(executor, c.mesh, c.values, c.options));
  }
  EXPECT_GT(tried, 0);
}

TYPED_TEST(CutRandom, FunctionsOfAllKindsGiveManifoldsOfTheInterpolantsTopology) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_case<Dim>(seed);
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    if (testing::Test::HasFailure()) break;
  }
}

TYPED_TEST(CutRandom, UnstructuredMeshesAreCutAndAdapted) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(7); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Case c;
    c.mesh = random_mesh<Dim>(random, Dim == 2 ? 9 : 4, test::two_halves(Dim == 2 ? 9 : 4));
    const double size = Dim == 2 ? 0.07 : 0.2;
    c.mesh = adapt(executor, c.mesh, constant_metric(c.mesh, size)).mesh;
    c.values = random_values<Dim>(c.mesh, random, static_cast<int>(seed % 7), size);
    c.options.materials = {{1, true, 11, 12}, {2, seed % 2 == 0, 21, 22}};
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    AdaptOptions options;
    options.make.hausdorff_tolerance = 0.05 * size;
    const AdaptedMesh after = adapt(executor, made.mesh, constant_metric(made.mesh, size), options);
    EXPECT_EQ(test::joined(check_mesh(executor, after.mesh)), "");
  }
}

TYPED_TEST(Cut, TheSameBytesAtAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  Case c = ball_case<Dim>(Dim == 2 ? 60 : 16);
  c.options.least_component = 0.001;
  for (const bool keeps_volume : {false, true}) {
    if (keeps_volume) c.options.keep_volume = 0.2;
    const CutMesh expected = cut(Executor({.threads = 1}), c.mesh, c.values, c.options);
    EXPECT_GT(expected.report.moved_vertices, 10U);
    for (const int threads : test::thread_counts) {
      const CutMesh made = cut(Executor({.threads = threads}), c.mesh, c.values, c.options);
      expect_same_bytes(made, expected);
      EXPECT_EQ(made.report.level, expected.report.level);
      EXPECT_EQ(made.report.minus_volume, expected.report.minus_volume);
    }
  }
}

TYPED_TEST(Cut, PlanesAreExact) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  double farthest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    Case c;
    c.mesh = random_mesh<Dim>(random, Dim == 2 ? 12 : 6, test::whole);
    Vector<Dim> normal;
    for (int i = 0; i < Dim; ++i) normal[i] = test::uniform(random, -0.2, 0.2);
    normal[static_cast<int>(seed % Dim)] = 1;
    normal *= 1 / norm(normal);
    const double offset = dot(normal, test::uniform(random, 0.4, 0.6) * all_ones<Dim>());
    const auto height = [&](const AnyMesh& mesh, std::size_t v) {
      return dot(normal, position_in<Dim>(mesh, v)) - offset;
    };
    for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) c.values.push_back(height(c.mesh, v));
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    double most = 0;
    for (std::size_t v = 0; v < made.mesh.vertex_count(); ++v)
      if (made.value[v] == 0) most = std::max(most, std::abs(height(made.mesh, v)));
    farthest = std::max(farthest, most);
  }
  EXPECT_LE(farthest, 1e-12);
}

TYPED_TEST(Cut, ZerosOfQuadraticFunctionsAreExact) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(Dim == 2 ? 20 : 9);
  for (double& x : c.values) x = (x + 0.3) * (x + 0.3) - 0.09;
  for (const bool curved : {false, true}) {
    c.options.curved = curved;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    double sum = 0, most = 0, count = 0;
    for (std::size_t v = 0; v < made.mesh.vertex_count(); ++v) {
      if (made.value[v] != 0) continue;
      Vector<Dim> p = position_in<Dim>(made.mesh, v);
      for (int i = 0; i < Dim; ++i) p[i] -= 0.47 + 0.02 * i;
      sum += std::abs(norm(p) - 0.3);
      most = std::max(most, std::abs(norm(p) - 0.3));
      ++count;
    }
    EXPECT_EQ(most < 1e-8, curved) << most;
    EXPECT_EQ(sum / count < 1e-4, curved) << sum / count;
  }
}

TYPED_TEST(Cut, MaterialsKeepTheirInterfaceAndTheirReferences) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = Dim == 2 ? 16 : 8;
  Case c = ball_case<Dim>(n);
  Random random(3);
  c.mesh = random_mesh<Dim>(random, n, test::two_halves(n));
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v)
    c.values[v] = norm(position_in<Dim>(c.mesh, v) - 0.49 * all_ones<Dim>()) - 0.3;
  for (const bool split : {true, false}) {
    c.options.materials = {{1, true, 11, 12}, {2, split, 21, 22}};
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    for (const std::int32_t side : {21, 22}) EXPECT_EQ(volume_of<Dim>(made.mesh, side) > 0, split);
    EXPECT_EQ(volume_of<Dim>(made.mesh, 2) > 0, !split);
    // The interface is a plane across an axis, and its facets have the reference 11 or more.
    const auto& facets = facets_in<Dim>(made.mesh);
    std::array<std::set<double>, Dim> places;
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (std::size_t i = 0; made.facet_origin[f] != none && facets.reference[f] > 10 && i < Dim;
           ++i)
        for (int k = 0; k < Dim; ++k)
          places[static_cast<std::size_t>(k)].insert(
              position_in<Dim>(made.mesh, facets.vertices[f][i])[k]);
    EXPECT_TRUE(std::ranges::any_of(places, [](const auto& p) { return p.size() == 1; }));
  }
}

/// Cuts again and again: what is left of earlier surfaces is gone, and sides become one domain.
TYPED_TEST(Cut, EarlierSurfacesAreForgotten) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = Dim == 2 ? 16 : 8;
  Random random(5);
  AnyMesh mesh = random_mesh<Dim>(random, n, test::two_halves(n));
  const std::size_t listed = facets_in<Dim>(mesh).size();
  for (const bool has_materials : {false, true})
    for (int step = 0; step < 4; ++step) {
      Case c{mesh, {}, {}};
      if (has_materials) c.options.materials = {{1, true, 11, 12}, {2, true, 21, 22}};
      for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        c.values.push_back(norm(position_in<Dim>(mesh, v) - (0.4 + 0.05 * step) * all_ones<Dim>()) -
                           0.3);
      const CutMesh made = cut(executor, mesh, c.values, c.options);
      EXPECT_EQ(test::joined(check_mesh(executor, made.mesh)), "");
      const auto& references = facets_in<Dim>(made.mesh).reference;
      EXPECT_EQ(std::ranges::count(references, 10),
                std::ssize(made.facet_origin) -
                    std::ranges::count_if(made.facet_origin, [](auto f) { return f != none; }));
      EXPECT_GE(std::ssize(references) - std::ranges::count(references, 10),
                static_cast<std::ptrdiff_t>(listed));
      const std::set<std::int32_t> found(elements_in<Dim>(made.mesh).reference.begin(),
                                         elements_in<Dim>(made.mesh).reference.end());
      EXPECT_EQ(found, has_materials ? (std::set<std::int32_t>{11, 12, 21, 22})
                                     : (std::set<std::int32_t>{2, 3}));
      const Topology sphere{Dim == 2 ? 0 : 2, 1};
      if (!has_materials) {
        EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(made.mesh, 2, 3)), sphere);
      }
      mesh = made.mesh;
      if (has_materials && step == 3) break;
      if (!has_materials && step == 3) mesh = random_mesh<Dim>(random, n, test::two_halves(n));
    }
}

TYPED_TEST(Cut, SmallComponentsGoOnBothSides) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(Dim == 2 ? 24 : 12);
  std::size_t small = 0;
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) {
    const Vector<Dim> p = position_in<Dim>(c.mesh, v);
    const double bubble = norm(p - 0.48 * all_ones<Dim>()) - 0.1;
    const double drop = norm(p - 0.9 * all_ones<Dim>()) - 0.1;
    small += bubble < 0 || drop < 0;
    c.values[v] = std::min(std::max(c.values[v], -bubble), drop);
  }
  ASSERT_GT(small, 4U);
  const CutMesh all = cut(executor, c.mesh, c.values, c.options);
  expect_good<Dim>(c, all);
  EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(all.mesh, 2, 3)).parts, 3U);
  c.options.least_component = 0.05;
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  EXPECT_EQ(made.report.removed_components, 2U);
  EXPECT_GT(made.report.removed_volume, 0);
  EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(made.mesh, 2, 3)), (Topology{Dim == 2 ? 0 : 2, 1}));
}

/// Any volume on any mesh, or a warning that says what stands in the way.
TYPED_TEST(CutRandom, KeepVolumes) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  int kept = 0, all = 0;
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    Case c = random_case<Dim>(seed);
    double whole = 0;
    for (std::size_t e = 0; e < elements_in<Dim>(c.mesh).size(); ++e)
      if (c.options.materials.empty() ||
          c.options.materials[elements_in<Dim>(c.mesh).reference[e] - 1].split)
        whole += volume<Dim>(c.mesh, e) / (Dim == 2 ? 2 : 6);
    Random random(seed);
    const double wanted = whole * test::uniform(random, 0.05, 0.95);
    c.options.keep_volume = wanted;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    // At a level that vertices have, the surface may lie on the border of a material.
    if (std::ranges::find(c.values, made.report.level) == c.values.end()) expect_good<Dim>(c, made);
    double minus = 0;
    if (c.options.materials.empty()) minus = volume_of<Dim>(made.mesh, 3);
    for (const CutMaterial& m : c.options.materials)
      if (m.split) minus += volume_of<Dim>(made.mesh, m.minus);
    EXPECT_NEAR(minus / made.report.minus_volume, 1, 1e-12);
    const bool is_kept = std::abs(made.report.minus_volume / wanted - 1) <= 1e-6;
    EXPECT_EQ(is_kept, made.report.warnings.empty()) << test::joined(made.report.warnings);
    const bool has_levels = seed % 7 != 5 && seed % 7 != 6;  // not -1 and 1 alone
    all += has_levels;
    kept += has_levels && is_kept;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_LE(all - kept, 2 + 0.1 * all);  // there are few trials under sanitizers
}

TYPED_TEST(Cut, VolumesOfBallsAreKept) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  for (const int n : {8, 10, 24}) {
    if (Dim == 3 && n == 24) continue;
    Case c = ball_case<Dim>(n);
    for (const double wanted : {0.03, 0.1, 0.2, 0.4}) {
      c.options.keep_volume = wanted;
      const CutMesh made = cut(executor, c.mesh, c.values, c.options);
      EXPECT_NEAR(made.report.minus_volume / wanted, 1, 1e-6);
      EXPECT_EQ(test::joined(made.report.warnings), "");
    }
    c.options.keep_volume = 1.5;
    EXPECT_NE(refusal(c).find("keep_volume: expected one between 0 and"), std::string::npos);
  }
}

TYPED_TEST(Cut, ALevelThatIsMetNowhereGivesOneSide) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(6);
  for (const double level : {-5, 5}) {
    c.options.level = level;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    ASSERT_EQ(made.report.warnings.size(), 1U);
    EXPECT_NE(made.report.warnings[0].find("met nowhere"), std::string::npos);
    AnyMesh expected = c.mesh;
    std::ranges::fill(elements_in<Dim>(expected).reference, level < 0 ? 2 : 3);
    EXPECT_TRUE(made.mesh == expected);
  }
}

/// The signed distance of the mesh's own boundary is 0 there, which is no surface inside.
TYPED_TEST(Cut, ZerosOnAllOfTheBoundaryAreNoSurface) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(6);
  for (const double sign : {-1, 1}) {
    for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) {
      double distance = 1;
      for (const double x : position_in<Dim>(c.mesh, v).x)
        distance = std::min({distance, x, 1 - x});
      c.values[v] = sign * distance;
    }
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    EXPECT_EQ(made.report.cut_elements, 0U);
    EXPECT_EQ(elements_in<Dim>(made.mesh).reference[0], sign < 0 ? 3 : 2);
  }
}

/// Values of -1 and 1, and of -1, 0 and 1, without any order. Any numbers give worse elements.
TYPED_TEST(Cut, ElementsOfCheckerboardsHaveAShape) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Case c;
    c.mesh = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 12 : 6));
    const int kind = 4 + static_cast<int>(seed % 3);
    c.values = random_values<Dim>(c.mesh, random, kind, 0.1);
    const double least = (Dim == 2 ? 0.1 : 0.02) * (kind == 4 ? 0.25 : 1);
    EXPECT_GT(worst_quality<Dim>(cut(executor, c.mesh, c.values).mesh), least) << seed;
  }
}

TYPED_TEST(Cut, RequiredEntitiesStayOrAreNamed) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = 6;
  Case c = ball_case<Dim>(n);
  auto& required_elements = Dim == 2 ? c.mesh.required_triangles : c.mesh.required_tetrahedra;
  auto& required_facets = Dim == 2 ? c.mesh.required_edges : c.mesh.required_triangles;
  const AnyMesh plain = c.mesh;
  const CutMesh free = cut(executor, c.mesh, c.values, c.options);
  std::vector<int> pieces(elements_in<Dim>(c.mesh).size());
  for (const ElementId e : free.element_origin) ++pieces[e];
  const auto crossed =
      static_cast<std::uint32_t>(std::ranges::max_element(pieces) - pieces.begin());
  required_elements = {crossed};
  EXPECT_NE(refusal(c).find("[" + std::to_string(crossed) + "], which is required"),
            std::string::npos);
  required_elements.clear();
  for (std::uint32_t e = 0; e < pieces.size(); ++e)
    if (std::ranges::none_of(elements_in<Dim>(c.mesh).vertices[e],
                             [&](VertexId v) { return std::abs(c.values[v]) < 0.25; }))
      required_elements.push_back(e);
  ASSERT_FALSE(required_elements.empty());
  for (std::uint32_t f = 0; f < facets_in<Dim>(c.mesh).size(); ++f)
    if (f % 3 == 0) required_facets.push_back(f);
  for (VertexId v = 0; v < c.mesh.vertex_count(); v += 5) c.mesh.required_vertices.push_back(v);
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  expect_good<Dim>(c, made);
  const auto& now = Dim == 2 ? made.mesh.required_triangles : made.mesh.required_tetrahedra;
  ASSERT_EQ(now.size(), required_elements.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_EQ(made.element_origin[now[i]], required_elements[i]);
    EXPECT_EQ(elements_in<Dim>(made.mesh).vertices[now[i]],
              elements_in<Dim>(c.mesh).vertices[required_elements[i]]);
  }
  const auto& facets = Dim == 2 ? made.mesh.required_edges : made.mesh.required_triangles;
  ASSERT_EQ(facets.size(), required_facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    EXPECT_EQ(made.facet_origin[facets[i]], required_facets[i]);
  for (const VertexId v : c.mesh.required_vertices) EXPECT_EQ(made.vertex_origin[v].b, v);
  c.mesh = plain;
  for (std::size_t v = 0; v < c.values.size(); ++v)
    c.values[v] = position_in<Dim>(c.mesh, v)[0] - 0.43;
  for (std::uint32_t f = 0; f < facets_in<Dim>(c.mesh).size(); ++f) required_facets.push_back(f);
  EXPECT_NE(refusal(c).find("which is required"), std::string::npos);
}

TYPED_TEST(Cut, FieldsAreCarriedAlong) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const Case c = ball_case<Dim>(8);
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  AnyField places{Dim, c.mesh.vertex_count(), {AnyField::Type::vector}, c.mesh.coordinates, ""};
  const AnyField carried = field_at_cut(executor, places, made);
  ASSERT_EQ(carried.values.size(), made.mesh.coordinates.size());
  for (std::size_t i = 0; i < carried.values.size(); ++i)
    ASSERT_NEAR(carried.values[i], made.mesh.coordinates[i], 1e-15);
  std::vector<double> sizes;
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v)
    sizes.push_back(std::exp(position_in<Dim>(c.mesh, v)[0]));
  const AnyField metric = metric_of(scalar_field(Dim, sizes), c.mesh);
  const auto tensors = tensors_of<Dim>(executor, metric_at_cut(executor, metric, made));
  for (std::size_t v = 0; v < tensors.size(); ++v)
    ASSERT_NEAR(1 / std::sqrt(tensors[v].m[0]), std::exp(position_in<Dim>(made.mesh, v)[0]), 1e-12);
  EXPECT_THROW(field_at_cut(executor, carried, made), InputError);
}

TYPED_TEST(Cut, WrongInputIsNamed) {
  constexpr int Dim = TypeParam::value;
  const Case good = ball_case<Dim>(4);
  const auto expect = [&](const std::string& message, auto&& spoil) {
    Case c = good;
    spoil(c);
    EXPECT_NE(refusal(c).find(message), std::string::npos) << refusal(c);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect("values[7]", [&](Case& c) { c.values[7] = nan; });
  expect("values[3]", [&](Case& c) { c.values[3] = std::numeric_limits<double>::infinity(); });
  expect("values: expected one for each", [](Case& c) { c.values.pop_back(); });
  expect("level: expected", [&](Case& c) { c.options.level = nan; });
  expect("least_component: expected", [](Case& c) { c.options.least_component = 1; });
  expect("keep_volume: expected", [&](Case& c) { c.options.keep_volume = nan; });
  expect("for both", [](Case& c) { c.options.plus = c.options.minus; });
  expect("materials[1]", [](Case& c) { c.options.materials = {{1, true, 3, 2}, {1, true, 5, 6}}; });
  expect("materials[0]", [](Case& c) { c.options.materials = {{1, true, 3, 3}}; });
  expect("not in the table", [](Case& c) { c.options.materials = {{5, true, 3, 2}}; });
  expect("several materials", [](Case& c) {
    c.options.materials = {{5, true, 1, 2}, {6, true, 1, 3}};
  });
  expect("expected dimension", [](Case& c) { c.mesh.dimension = 4; });
  expect("vertices[2]", [](Case& c) { elements_in<Dim>(c.mesh).vertices[2][0] = 1U << 30U; });
  expect("required", [](Case& c) { c.mesh.required_edges = {1U << 30U}; });
  expect("", [](Case& c) { c.mesh = {}; });
}

}  // namespace
}  // namespace ductile::meshadapt::cut_test
