// cut() of surfaces alone, and of the boundary of tetrahedra alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cut_support.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::surface_cut_test {
namespace {

using namespace cut_test;

/// Twice the area of triangles with a reference; 0: of all.
double area(const AnyMesh& mesh, std::int32_t reference = 0) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (reference != 0 && mesh.triangles.reference[t] != reference) continue;
    std::array<Vector<3>, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = position_in<3>(mesh, mesh.triangles.vertices[t][i]);
    sum += norm(facet_normal(p));
  }
  return sum;
}

/// A mesh of tetrahedra, and values at its vertices; some with several materials, or with holes.
Case random_solid(std::uint64_t seed) {
  Case c = random_case<3>(seed);
  c.options.materials.clear();
  return c;
}

/// The boundary of such a mesh as a surface; with two materials there are edges of three triangles.
Case random_surface(std::uint64_t seed) {
  const Case solid = random_solid(seed);
  Case c = solid;
  c.mesh.tetrahedra = {};
  c.mesh.coordinates.clear();
  c.mesh.vertex_reference.clear();
  c.values.clear();
  std::map<VertexId, VertexId> number_of;
  const auto renumber = [&](VertexId& v) {
    const auto [at, is_new] = number_of.emplace(v, c.values.size());
    if (is_new) {
      const Vector<3> p = position_in<3>(solid.mesh, v);
      c.mesh.coordinates.insert(c.mesh.coordinates.end(), p.x.begin(), p.x.end());
      c.mesh.vertex_reference.push_back(solid.mesh.vertex_reference[v]);
      c.values.push_back(solid.values[v]);
    }
    v = at->second;
  };
  for (auto& corners : c.mesh.triangles.vertices) std::ranges::for_each(corners, renumber);
  for (auto& ends : c.mesh.edges.vertices) std::ranges::for_each(ends, renumber);
  std::ranges::for_each(c.mesh.corners, renumber);
  return c;
}

Key key_of(const std::array<VertexId, 2>& edge) {
  return {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
}

/// What holds for the triangles of each cut: sides, areas, the curve and its topology.
void expect_good_triangles(const Case& c, const CutMesh& made,
                           const std::vector<std::uint32_t>& origin_of) {
  const Executor executor({.threads = 1});
  EXPECT_EQ(test::joined(check_mesh(executor, made.mesh)), "");
  EXPECT_TRUE(made.report.on_surface);
  EXPECT_NEAR(area(made.mesh) / area(c.mesh), 1, 1e-12);
  EXPECT_NEAR(2 * made.report.minus_volume, area(made.mesh, 3), 1e-12 * area(c.mesh));
  const auto& triangles = made.mesh.triangles;
  ASSERT_EQ(origin_of.size(), triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    double least = 0, most = 0;
    for (const VertexId v : triangles.vertices[t]) {
      least = std::min(least, made.value[v]);
      most = std::max(most, made.value[v]);
    }
    ASSERT_TRUE((least < 0) != (most > 0));
    ASSERT_EQ(triangles.reference[t], least < 0 ? 3 : 2);
    ASSERT_LT(origin_of[t], c.mesh.triangles.size());
  }
  std::set<Key> listed;
  for (const auto& edge : made.mesh.edges.vertices)
    EXPECT_TRUE(listed.insert(key_of(edge)).second) << "listed twice";
  for (const Key& edge : facets_between<2>(made.mesh, 2, 3)) EXPECT_TRUE(listed.contains(edge));
  for (std::size_t v = 0; v < made.mesh.vertex_count(); ++v) {
    const auto& [a, b, t] = made.vertex_origin[v];
    const Vector<3> from = position_in<3>(c.mesh, a), to = position_in<3>(c.mesh, b);
    ASSERT_LE(norm(position_in<3>(made.mesh, v) - ((1 - t) * from + t * to)),
              1e-14 * (norm(from) + norm(to)));
    if (v < c.mesh.vertex_count()) {
      ASSERT_EQ(b, v) << "vertices stay where they are";
    }
  }
}

bool is_manifold(const AnyMesh& mesh) {
  std::map<Key, int> count;
  for (const auto& corners : mesh.triangles.vertices)
    for (int i = 0; i < 3; ++i) {
      const Facet<2> edge = facet_of<2>(corners, i);
      ++count[key_of(edge)];
    }
  return std::ranges::all_of(count, [](const auto& edge) { return edge.second <= 2; });
}

TEST(SurfaceCut, FunctionsOfAllKindsGiveCurvesOfTheInterpolantsTopology) {
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_surface(seed);
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good_triangles(c, made, made.element_origin);
    if (is_manifold(c.mesh)) {
      EXPECT_EQ(of_facets<2>(facets_between<2>(made.mesh, 2, 3)),
                of_interpolant<2>(c.mesh, c.values, {}));
    }
    if (testing::Test::HasFailure()) break;
  }
}

TEST(SurfaceCut, IsAdapted) {
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(14); ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_surface(seed);
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    const AnyField sizes =
        metric_at_cut(executor, constant_metric(c.mesh, std::sqrt(area(c.mesh)) / 20), made);
    AdaptOptions options;
    options.gradation = 1.3;
    const AdaptedMesh after = adapt(executor, made.mesh, sizes, options);
    EXPECT_EQ(test::joined(check_mesh(executor, after.mesh)), "");
    for (const std::int32_t side : {2, 3})
      EXPECT_NEAR(area(after.mesh, side), area(made.mesh, side), 1e-9 * area(made.mesh));
  }
}

TEST(SurfaceCut, KeepsAnArea) {
  const Executor executor({.threads = 1});
  Case c = random_surface(7);
  c.options.keep_volume = 0.15 * area(c.mesh);
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  EXPECT_NEAR(area(made.mesh, 3) / area(c.mesh), 0.3, 1e-6);
}

/// Faces of tetrahedra agree, and so do areas and volumes; elements keep their references.
TEST(BoundaryCut, DividesTetrahedraConformally) {
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    Case c = random_solid(seed);
    c.options.boundary_only = true;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good_triangles(c, made, made.facet_origin);
    double before = 0, after = 0;
    for (std::size_t e = 0; e < c.mesh.tetrahedra.size(); ++e) before += volume<3>(c.mesh, e);
    const auto& tetrahedra = made.mesh.tetrahedra;
    ASSERT_EQ(made.element_origin.size(), tetrahedra.size());
    for (std::size_t e = 0; e < tetrahedra.size(); ++e) {
      after += volume<3>(made.mesh, e);
      ASSERT_EQ(tetrahedra.reference[e], c.mesh.tetrahedra.reference[made.element_origin[e]]);
    }
    EXPECT_NEAR(after / before, 1, 1e-11);
    if (testing::Test::HasFailure()) break;
  }
}

TEST(BoundaryCut, IsAdapted) {
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(7); ++seed) {
    SCOPED_TRACE(seed);
    Case c = random_solid(seed);
    c.options.boundary_only = true;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    const AnyField sizes = metric_at_cut(executor, default_metric(executor, c.mesh), made);
    const AdaptedMesh adapted = adapt(executor, made.mesh, sizes, {});
    EXPECT_EQ(test::joined(check_adapted(executor, made.mesh, adapted.mesh)), "");
  }
}

TEST(SurfaceCut, GivesTheSameBytesAtAnyNumberOfThreads) {
  for (const bool boundary_only : {false, true}) {
    Case c = boundary_only ? random_solid(14) : random_surface(14);
    c.options.boundary_only = boundary_only;
    const CutMesh expected = cut(Executor({.threads = 1}), c.mesh, c.values, c.options);
    for (const int threads : test::thread_counts) {
      const CutMesh made = cut(Executor({.threads = threads}), c.mesh, c.values, c.options);
      expect_same_bytes(made, expected);
    }
  }
}

TEST(SurfaceCut, MaterialsAreThoseOfTriangles) {
  const Executor executor({.threads = 1});
  for (const bool boundary_only : {false, true}) {
    Case c = boundary_only ? random_solid(0) : random_surface(0);
    c.options.boundary_only = boundary_only;
    std::set<std::int32_t> expected;
    for (const std::int32_t reference : c.mesh.triangles.reference) {
      const bool split = reference % 2 == 0;
      if (std::ranges::find(c.options.materials, reference, &CutMaterial::reference) ==
          c.options.materials.end())
        c.options.materials.push_back({reference, split, 100 + reference, 200 + reference});
      expected.insert(split ? 100 + reference : reference);
      if (split) expected.insert(200 + reference);
    }
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    EXPECT_EQ(std::set(made.mesh.triangles.reference.begin(), made.mesh.triangles.reference.end()),
              expected);
  }
}

TEST(BoundaryCut, RefusesInOneLine) {
  const auto expect = [](const std::string& said, auto&& change) {
    Case c = random_solid(1);
    c.options.boundary_only = true;
    change(c);
    EXPECT_NE(refusal(c).find(said), std::string::npos) << refusal(c);
    EXPECT_EQ(refusal(c).find('\n'), std::string::npos);
  };
  expect("found no triangles", [](Case& c) { c.mesh.triangles = {}; });
  expect("found no tetrahedra", [](Case& c) { c.mesh.tetrahedra = {}; });
  expect("keep_volume: expected none", [](Case& c) { c.options.keep_volume = 0.1; });
  expect("which is required", [](Case& c) {
    for (std::uint32_t t = 0; t < c.mesh.triangles.size(); ++t)
      c.mesh.required_triangles.push_back(t);
  });
  expect("which is required", [](Case& c) {
    for (std::uint32_t t = 0; t < c.mesh.tetrahedra.size(); ++t)
      c.mesh.required_tetrahedra.push_back(t);
  });
}

}  // namespace
}  // namespace ductile::meshadapt::surface_cut_test
