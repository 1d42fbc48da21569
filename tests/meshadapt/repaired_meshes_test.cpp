// Faults in the listing of a mesh are repaired with a warning: facets and edges that are listed
// twice, elements that are inverted. Faults in space are refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/make_mesh.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::repaired_meshes_test {
namespace {

using runtime::Executor;
using test::below;
using test::chance;
using test::Random;

template <int Dim>
AnyMesh random_mesh(Random& random) {
  const int n = Dim == 2 ? 3 + static_cast<int>(below(random, 4)) : 2;
  test::Grid grid = test::unit_grid(Dim, n);
  grid.seed = random();
  if (chance(random, 0.5)) grid.region = test::two_halves(n);
  AnyMesh mesh = test::make_grid(grid, chance(random, 0.5));
  if (Dim == 3 && chance(random, 0.7)) test::list_ridges(mesh);
  test::jiggle(mesh, random, 0.2);
  mesh.name = "a.mesh";
  return mesh;
}

struct Made {
  AnyMesh mesh;
  std::vector<std::string> warnings;
};

template <int Dim>
Made make(const AnyMesh& any) {
  const Executor executor({.threads = 2});
  Made made;
  runtime::with_team(executor, [&] {
    Neighbours<Dim> neighbours;
    auto mesh = make_mesh<Dim>(executor, any, {}, neighbours, made.warnings);
    for (auto& site : mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
    made.mesh = take_apart(executor, std::move(mesh)).mesh;
  });
  return made;
}

std::string complaint(const AnyMesh& any) {
  try {
    any.dimension == 2 ? make<2>(any) : make<3>(any);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// ---- Repeated facets and edges ----

struct Repeated {
  std::size_t count = 0, different = 0;
};

/// Lists some cells again, with another order of corners and some with another reference. Adds some
/// of the repetitions to `required`, and their originals to `expected`.
template <int Corners>
Repeated repeat(Cells<Corners>& cells, Random& random, std::vector<std::uint32_t>& required,
                std::vector<std::uint32_t>& expected) {
  const std::size_t listed = cells.size();
  Repeated repeated;
  const double share = chance(random, 0.3) ? 1 : 0.2;
  for (std::size_t i = 0; i < listed; ++i) {
    if (!chance(random, share)) continue;
    auto corners = cells.vertices[i];
    std::shuffle(corners.begin(), corners.end(), random);
    const bool differs = chance(random, 0.3);
    if (chance(random, 0.2)) {
      required.push_back(static_cast<std::uint32_t>(cells.size()));
      expected.push_back(static_cast<std::uint32_t>(i));
    }
    cells.add(corners, cells.reference[i] + (differs ? 100 : 0));
    ++repeated.count;
    repeated.different += differs;
  }
  return repeated;
}

template <int Dim>
void merge_repeated(unsigned seed) {
  Random random(seed);
  AnyMesh clean = random_mesh<Dim>(random), dirty = clean;
  auto& required = Dim == 2 ? dirty.required_edges : dirty.required_triangles;
  auto& expected = Dim == 2 ? clean.required_edges : clean.required_triangles;
  const Repeated facets = repeat(facets_in<Dim>(dirty), random, required, expected);
  Repeated edges;
  if constexpr (Dim == 3) edges = repeat(dirty.edges, random, dirty.ridges, clean.ridges);
  const Made made = make<Dim>(dirty), wanted = make<Dim>(clean);
  EXPECT_EQ(made.mesh, wanted.mesh);
  const std::size_t told = std::size_t{facets.count > 0} + std::size_t{edges.count > 0};
  ASSERT_EQ(made.warnings.size(), wanted.warnings.size() + told);
  if (facets.count > 0) {
    const std::string kind = Dim == 2 ? " listed edges" : " listed triangles";
    EXPECT_TRUE(contains(made.warnings[0], "a.mesh: " + std::to_string(facets.count) + " of " +
                                               std::to_string(facets_in<Dim>(dirty).size()) + kind))
        << made.warnings[0];
    EXPECT_EQ(contains(made.warnings[0], "where references differ"), facets.different > 0);
  }
  if (seed % 5 != 0) return;
  const Executor executor({.threads = 1});
  const AnyField metric = constant_metric(clean, 0.3);
  const AdaptedMesh adapted = adapt(executor, dirty, metric);
  EXPECT_TRUE(check_mesh(executor, adapted.mesh).empty());
  EXPECT_EQ(check_domain(executor, dirty, adapted.mesh), std::vector<std::string>{});
  EXPECT_EQ(adapted.mesh, adapt(executor, clean, metric).mesh);
}

TEST(RepairedMeshes, MergeWhatIsListedTwice) {
  for (unsigned seed = 0; seed < test::trials(200); ++seed) {
    SCOPED_TRACE(seed);
    seed % 2 == 0 ? merge_repeated<2>(seed) : merge_repeated<3>(seed);
  }
}

TEST(RepairedMeshes, SayWhichReferenceIsKept) {
  AnyMesh any = test::make_grid(test::unit_grid(2, 1));
  any.name = "a.mesh";
  any.edges.reference = {7, 8, 9, 10};
  any.edges.add(any.edges.vertices[1], 8);
  any.edges.add(any.edges.vertices[2], 5);
  const Made made = make<2>(any);
  ASSERT_EQ(made.warnings.size(), 1U);
  EXPECT_EQ(made.warnings[0],
            "a.mesh: 2 of 6 listed edges were listed before and are merged; the first, edge 5, is "
            "the same as edge 2; where references differ (1 of them), that of the one listed first "
            "is kept: 9 of edge 3, not 5 of edge 6");
}

// ---- Inverted elements ----

template <int Dim>
std::set<std::pair<Corners<Dim>, std::int32_t>> sorted_elements(const AnyMesh& mesh) {
  std::set<std::pair<Corners<Dim>, std::int32_t>> all;
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e) {
    Corners<Dim> corners = elements_in<Dim>(mesh).vertices[e];
    std::sort(corners.begin(), corners.end());
    all.emplace(corners, elements_in<Dim>(mesh).reference[e]);
  }
  return all;
}

template <int Dim>
void turn_back(unsigned seed) {
  Random random(seed);
  const AnyMesh clean = random_mesh<Dim>(random);
  AnyMesh dirty = clean;
  auto& elements = elements_in<Dim>(dirty).vertices;
  const double share = chance(random, 0.3) ? 0.7 : 0.05;
  std::size_t turned = 0;
  for (auto& corners : elements)
    if (turned + 1 < elements.size() && (turned == 0 || chance(random, share))) {
      const std::size_t i = below(random, Dim);
      std::swap(corners[i], corners[i + 1]);
      ++turned;
    }
  const Made made = make<Dim>(dirty), wanted = make<Dim>(clean);
  EXPECT_EQ(sorted_elements<Dim>(made.mesh), sorted_elements<Dim>(wanted.mesh));
  ASSERT_EQ(made.warnings.size(), 1U);
  EXPECT_TRUE(contains(made.warnings[0], std::to_string(turned) + " of " +
                                             std::to_string(elements.size()) +
                                             " elements were listed the other way round"))
      << made.warnings[0];
  const Executor executor({.threads = 1});
  EXPECT_TRUE(check_mesh(executor, made.mesh).empty());
  if (seed % 5 != 0) return;
  const AdaptedMesh adapted = adapt(executor, dirty, constant_metric(dirty, 0.3));
  EXPECT_TRUE(check_mesh(executor, adapted.mesh).empty());
  EXPECT_EQ(check_domain(executor, dirty, adapted.mesh), std::vector<std::string>{});
}

TEST(RepairedMeshes, TurnElementsBack) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    seed % 2 == 0 ? turn_back<2>(seed) : turn_back<3>(seed);
  }
}

/// Moves an interior vertex beyond a facet of one of its elements, so that the element overlaps its
/// neighbour. Returns false if there is no such vertex.
template <int Dim>
bool tangle(AnyMesh& mesh, Random& random) {
  const auto& elements = elements_in<Dim>(mesh).vertices;
  for (int trial = 0; trial < 100; ++trial) {
    const auto& corners = elements[below(random, elements.size())];
    const std::size_t moved = below(random, Dim + 1);
    const auto at = [&](std::size_t corner, std::size_t axis) -> double& {
      return mesh.coordinates[corners[corner] * std::size_t{Dim} + axis];
    };
    bool inside = true;
    for (std::size_t axis = 0; axis < Dim; ++axis)
      inside = inside && at(moved, axis) > 1e-9 && at(moved, axis) < 1 - 1e-9;
    if (!inside) continue;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      double across = 0;
      for (std::size_t i = 0; i <= Dim; ++i)
        if (i != moved) across += at(i, axis) / Dim;
      at(moved, axis) += 1.3 * (across - at(moved, axis));
    }
    return true;
  }
  return false;
}

TEST(RepairedMeshes, RefuseWhatIsInvertedInSpace) {
  std::size_t tangled = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    AnyMesh mesh = seed % 2 == 0 ? random_mesh<2>(random) : random_mesh<3>(random);
    if (!(seed % 2 == 0 ? tangle<2>(mesh, random) : tangle<3>(mesh, random))) continue;
    ++tangled;
    const std::string text = complaint(mesh);
    EXPECT_TRUE(contains(text, " is inverted: it overlaps ")) << text;
    for (auto& corners : mesh.triangles.vertices)  // the orientation in the list does not matter
      if (seed % 2 == 0 && chance(random, 0.3)) std::swap(corners[0], corners[1]);
    EXPECT_TRUE(contains(complaint(mesh), "overlap")) << complaint(mesh);
  }
  EXPECT_GT(tangled, 150U);
}

}  // namespace
}  // namespace ductile::meshadapt::repaired_meshes_test
