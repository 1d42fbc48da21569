#include "ductile/meshadapt/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/broken_input.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::origins_test {
namespace {

using runtime::Executor;

template <int Dim>
double extent(const AnyMesh& mesh) {
  double largest = 0;
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    largest = std::max(largest, std::abs(mesh.coordinates[i] - mesh.coordinates[i % Dim]));
  return largest;
}

/// Positions of a cell's corners, in ascending order.
template <int Dim, std::size_t N>
std::vector<std::array<double, Dim>> places(const AnyMesh& mesh,
                                            const std::array<std::uint32_t, N>& corners) {
  std::vector<std::array<double, Dim>> all;
  for (const VertexId v : corners) all.push_back(position_in<Dim>(mesh, v).x);
  std::sort(all.begin(), all.end());
  return all;
}

/// Compares the origins with those found by position, for meshes without coincident vertices.
template <int Dim>
void expect_by_places(const AnyMesh& before, const AnyMesh& after, const Origins& found) {
  std::map<std::array<double, Dim>, VertexId> vertex_at;
  for (VertexId v = 0; v < before.vertex_count(); ++v) vertex_at[position_in<Dim>(before, v).x] = v;
  for (VertexId v = 0; v < after.vertex_count(); ++v) {
    const auto at = vertex_at.find(position_in<Dim>(after, v).x);
    ASSERT_EQ(found.vertex[v], at == vertex_at.end() ? none : at->second) << v;
  }
  std::map<std::vector<std::array<double, Dim>>, ElementId> element_at;
  const auto& old_elements = elements_in<Dim>(before);
  const auto& elements = elements_in<Dim>(after);
  for (ElementId e = 0; e < old_elements.size(); ++e)
    element_at[places<Dim>(before, old_elements.vertices[e])] = e;
  for (ElementId e = 0; e < elements.size(); ++e) {
    const auto at = element_at.find(places<Dim>(after, elements.vertices[e]));
    const bool same =
        at != element_at.end() && old_elements.reference[at->second] == elements.reference[e];
    ASSERT_EQ(found.element[e], same ? at->second : none) << e;
  }
  std::map<std::vector<std::array<double, Dim>>, std::uint32_t> facet_at;
  const auto& old_facets = facets_in<Dim>(before).vertices;
  const auto& facets = facets_in<Dim>(after).vertices;
  for (std::uint32_t f = 0; f < old_facets.size(); ++f)
    facet_at.try_emplace(places<Dim>(before, old_facets[f]), f);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    const auto at = facet_at.find(places<Dim>(after, facets[f]));
    ASSERT_EQ(found.facet[f], at == facet_at.end() ? none : at->second) << f;
  }
}

/// Expects that each of these entities is an origin.
void expect_all_there(const std::vector<std::uint32_t>& required,
                      const std::vector<std::uint32_t>& origin_of, const char* what) {
  const std::set<std::uint32_t> origins(origin_of.begin(), origin_of.end());
  for (const std::uint32_t i : required) EXPECT_TRUE(origins.contains(i)) << what << ' ' << i;
}

template <int Dim>
void expect_hosts(const AnyMesh& before, const AnyMesh& after, const Origins& found,
                  double tolerance) {
  for (std::size_t v = 0; v < after.vertex_count(); ++v) {
    ASSERT_LT(found.host[v], elements_in<Dim>(before).size());
    Vector<Dim> place;
    double sum = 0;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const double weight = found.weight[(Dim + 1) * v + i];
      EXPECT_GE(weight, 0);
      sum += weight;
      place +=
          weight * position_in<Dim>(before, elements_in<Dim>(before).vertices[found.host[v]][i]);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_LE(norm(place - position_in<Dim>(after, v)), tolerance) << v;
  }
}

template <int Dim>
void try_case(const test::RandomCase& random, test::Random& dice) {
  AnyMesh before = random.mesh;
  for (auto& corners : elements_in<Dim>(before).vertices)
    if (test::chance(dice, 0.2)) std::swap(corners[0], corners[1]);
  const Executor executor({.threads = 2});
  const AnyMesh after = adapt(executor, before, random.metric, random.options).mesh;
  const Origins found = origins(executor, before, after);
  EXPECT_EQ(found, origins(Executor({.threads = 1}), before, after));
  expect_by_places<Dim>(before, after, found);
  expect_hosts<Dim>(before, after, found, 1e-8 * extent<Dim>(before));
  expect_all_there(before.required_vertices, found.vertex, "vertex");
  expect_all_there(Dim == 2 ? before.required_edges : before.required_triangles, found.facet,
                   "facet");
  expect_all_there(Dim == 2 ? before.required_triangles : before.required_tetrahedra, found.element,
                   "element");
}

TEST(Origins, AreThoseAtTheSamePlacesInRandomAdaptations) {
  for (std::uint64_t seed = test::first_trial(500); seed < 500 + test::trials(16); ++seed) {
    const test::RandomCase random = test::random_case(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
    test::Random dice(seed);
    random.mesh.dimension == 2 ? try_case<2>(random, dice) : try_case<3>(random, dice);
  }
}

template <class Dimension>
class OriginsIn : public testing::Test {};
TYPED_TEST_SUITE(OriginsIn, test::Dimensions, );

/// A box with a closed crack in its middle, across the first axis.
template <int Dim>
AnyMesh cracked_box(int cells) {
  std::array<double, Dim> extent;
  std::array<int, Dim> along;
  extent.fill(1);
  along.fill(cells);
  AnyMesh mesh = box_mesh<Dim>(extent, along);
  std::map<VertexId, VertexId> twin_of;
  for (VertexId v = 0, end = static_cast<VertexId>(mesh.vertex_count()); v < end; ++v) {
    const Vector<Dim> p = position_in<Dim>(mesh, v);
    bool inside = p[0] == 0.5;
    for (int axis = 1; axis < Dim; ++axis) inside = inside && p[axis] > 0.2 && p[axis] < 0.8;
    if (!inside) continue;
    twin_of[v] = static_cast<VertexId>(mesh.vertex_count());
    mesh.coordinates.insert(mesh.coordinates.end(), p.x.begin(), p.x.end());
    mesh.vertex_reference.push_back(0);
  }
  for (auto& corners : elements_in<Dim>(mesh).vertices) {
    double centre = 0;
    for (const VertexId v : corners) centre += position_in<Dim>(mesh, v)[0] / (Dim + 1);
    for (VertexId& v : corners)
      if (centre > 0.5 && twin_of.contains(v)) v = twin_of[v];
  }
  list_boundary(Executor(), mesh);
  return mesh;
}

/// [vertex] The sides of the crack on which its elements lie.
template <int Dim>
std::vector<int> sides(const AnyMesh& mesh) {
  std::vector<int> side(mesh.vertex_count(), 0);  // bits: 1 lower, 2 higher, both at the rim
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    double centre = 0;
    for (const VertexId v : corners) centre += position_in<Dim>(mesh, v)[0] / (Dim + 1);
    for (const VertexId v : corners) side[v] |= centre < 0.5 ? 1 : 2;
  }
  return side;
}

TYPED_TEST(OriginsIn, TellBothSidesOfAClosedCrackApart) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh before = cracked_box<Dim>(Dim == 2 ? 16 : 8);
  const auto metric = [&](double size) {
    return metric_of(scalar_field(Dim, std::vector<double>(before.vertex_count(), size)), before);
  };
  std::size_t kept = 0, made = 0;
  for (const double size : Dim == 2 ? std::vector{0.08, 0.03} : std::vector{0.2, 0.1}) {
    const AnyMesh after = adapt(executor, before, metric(size)).mesh;
    const Origins found = origins(executor, before, after);
    const std::vector<int> old_side = sides<Dim>(before), side = sides<Dim>(after);
    std::vector<double> jump;  // across the crack
    for (const int on : old_side) jump.push_back(on);
    for (double& value : jump) value = value == 3 ? 1.5 : value;
    const AnyField field = scalar_field(Dim, jump);
    const auto carried = interpolate_field(executor, {before, field}, after).field.values;
    const std::vector<int> side_of_host = [&] {
      std::vector<int> result;
      for (const auto& corners : elements_in<Dim>(before).vertices) {
        double centre = 0;
        for (const VertexId v : corners) centre += position_in<Dim>(before, v)[0] / (Dim + 1);
        result.push_back(centre < 0.5 ? 1 : 2);
      }
      return result;
    }();
    for (std::size_t v = 0; v < after.vertex_count(); ++v) {
      if (position_in<Dim>(after, v)[0] != 0.5 || side[v] == 3) continue;
      EXPECT_EQ(side_of_host[found.host[v]], side[v]) << v;
      EXPECT_TRUE(side[v] == 1 ? carried[v] <= 1.5 : carried[v] >= 1.5) << v << ' ' << carried[v];
      found.vertex[v] == none ? ++made : ++kept;
      if (found.vertex[v] != none) {
        EXPECT_EQ(old_side[found.vertex[v]], side[v]) << v;
      }
    }
    expect_hosts<Dim>(before, after, found, 1e-8);
  }
  EXPECT_GT(kept, 4U);
  EXPECT_GT(made, 4U);
}

}  // namespace
}  // namespace ductile::meshadapt::origins_test
