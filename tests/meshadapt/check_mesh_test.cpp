#include "ductile/meshadapt/check_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/make_mesh.hpp"
#include "io_support.hpp"
#include "operators/cavity.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::check_mesh_test {
namespace {

using runtime::Executor;

const Executor executor({.threads = 2});

AnyMesh box(int dimension) {
  test::Grid grid = test::unit_grid(dimension, 4);
  grid.region = test::two_halves(4);
  AnyMesh mesh = test::make_grid(grid);
  if (dimension == 3) test::list_ridges(mesh);
  return mesh;
}

template <int Dim>
Mesh<Dim> made(const AnyMesh& any) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (auto& site : mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
  update_qualities(executor, mesh);
  return mesh;
}

#define EXPECT_FINDS(mesh, part)                                                    \
  EXPECT_NE(test::joined(check_mesh(executor, mesh)).find(part), std::string::npos) \
      << "found only:" << test::joined(check_mesh(executor, mesh))

TEST(CheckMesh, HasNothingToSayOfSoundMeshes) {
  EXPECT_EQ(test::joined(check_mesh(executor, box(2))), "");
  EXPECT_EQ(test::joined(check_mesh(executor, box(3))), "");
  EXPECT_EQ(test::joined(check_mesh(executor, made<2>(box(2)))), "");
  EXPECT_EQ(test::joined(check_mesh(executor, made<3>(box(3)))), "");
}

TEST(CheckMesh, FindsWhatIsWrongWithElements) {
  for (const int dimension : {2, 3}) {
    const std::string name = dimension == 2 ? "triangle " : "tetrahedron ";
    AnyMesh any = box(dimension);
    const auto change = [&](auto&& edit) {
      any = box(dimension);
      if (dimension == 2)
        edit(any.triangles);
      else
        edit(any.tetrahedra);
    };
    change([](auto& cells) { std::swap(cells.vertices[6][0], cells.vertices[6][1]); });
    EXPECT_FINDS(any, name + "7 is inverted");
    change([](auto& cells) { cells.vertices[6][0] = 100000; });
    EXPECT_FINDS(any, name + "7 names a vertex twice or one that does not exist");
    change([](auto& cells) { cells.vertices[6][0] = cells.vertices[6][1]; });
    EXPECT_FINDS(any, name + "7 names a vertex twice or one that does not exist");
    change([](auto& cells) { cells.add(cells.vertices[6], 1); });
    EXPECT_FINDS(any, "has two elements on one side, or more than two");
    change([](auto& cells) {
      cells.vertices.erase(cells.vertices.begin() + 5);
      cells.reference.pop_back();
    });
    EXPECT_FINDS(any, "is not listed");
    any = box(dimension);
    any.coordinates[3] = std::nan("");
    EXPECT_FINDS(any, "has no volume");
    any = box(dimension);
    any.vertex_reference.push_back(0);
    any.coordinates.resize(any.coordinates.size() + static_cast<std::size_t>(dimension), 0.5);
    EXPECT_FINDS(any, "belongs to no element");
  }
}

TEST(CheckMesh, FindsWhatIsWrongWithFacetsAndEdges) {
  AnyMesh any = box(3);
  any.triangles.add(any.triangles.vertices[4], 1);
  EXPECT_FINDS(any, "is listed twice");
  any = box(3);
  any.triangles.vertices[4][0] = any.triangles.vertices[9][2];
  EXPECT_FINDS(any, "is no facet of an element");
  EXPECT_FINDS(any, "is not listed");
  any = box(3);
  any.edges.vertices[4] = {0, static_cast<std::uint32_t>(any.vertex_count() - 1)};
  EXPECT_FINDS(any, "is no edge of an element");
  any.edges.vertices[4] = any.edges.vertices[5];
  EXPECT_FINDS(any, "is listed twice");
  any = box(2);
  any.ridges = {100000};
  EXPECT_FINDS(any, "ridge 1 does not exist");
  any.dimension = 4;
  EXPECT_FINDS(any, "the dimension is 4");
}

/// Triangles around vertex 0, more than are compared pairwise.
AnyMesh fan(std::uint32_t spokes) {
  AnyMesh any;
  any.dimension = 2;
  any.coordinates = {0, 0};
  for (std::uint32_t i = 0; i < spokes; ++i) {
    const double angle = 6.283185307179586 * i / spokes;
    any.coordinates.insert(any.coordinates.end(), {std::cos(angle), std::sin(angle)});
    any.edges.add({1 + i, 1 + (i + 1) % spokes}, 1);
    any.triangles.add({0, 1 + i, 1 + (i + 1) % spokes}, 1);
  }
  any.vertex_reference.assign(spokes + 1, 0);
  return any;
}

TEST(CheckMesh, LooksAtVerticesOfManyFacets) {
  AnyMesh any = fan(100);
  EXPECT_EQ(test::joined(check_mesh(executor, any)), "");
  any.edges.add({0, 51}, 1);
  EXPECT_EQ(test::joined(check_mesh(executor, any)), "");  // an interior edge may be listed
  any.edges.add({51, 0}, 1);
  EXPECT_FINDS(any, "a facet of triangle 51 is listed twice");
  any = fan(100);
  any.triangles.vertices.erase(any.triangles.vertices.begin() + 70);
  any.triangles.reference.pop_back();
  EXPECT_FINDS(any, "a boundary facet of triangle 70 is not listed (and 1 more like it)");
  EXPECT_FINDS(any, "edge 71 is no facet of an element");
}

TEST(CheckMesh, FindsTheSameInAnyOrderOnAnyNumberOfThreads) {
  AnyMesh any = test::make_grid(test::unit_grid(3, 14));
  std::mt19937 random(7);
  std::shuffle(any.tetrahedra.vertices.begin(), any.tetrahedra.vertices.end(), random);
  for (const int threads : {1, 2, 3, 8})
    EXPECT_EQ(test::joined(check_mesh(Executor({.threads = threads}), any)), "");
  any.tetrahedra.vertices[9000] = any.tetrahedra.vertices[1000];
  any.triangles.vertices[500] = any.triangles.vertices[20];
  const std::string found = test::joined(check_mesh(Executor({.threads = 1}), any));
  for (const char* part : {"has two elements on one side", "is not listed", "is listed twice"})
    EXPECT_NE(found.find(part), std::string::npos) << found;
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(test::joined(check_mesh(Executor({.threads = threads}), any)), found);
}

template <int Dim>
ElementId element_at_boundary(const Mesh<Dim>& mesh, int& facet) {
  for (ElementId e = 0; e < mesh.element_slots(); ++e)
    for (facet = 0; facet <= Dim; ++facet)
      if (mesh.patches_of[e][static_cast<std::size_t>(facet)] != 0) return e;
  return none;
}

template <int Dim>
void expect_finds_faults_of_structure() {
  const AnyMesh any = box(Dim);
  int facet = 0;
  Mesh<Dim> mesh = made<Dim>(any);
  mesh.quality_of[3] *= 1.01F;
  EXPECT_FINDS(mesh, "element 3's quality is not up to date");
  mesh = made<Dim>(any);
  mesh.elements_of.erase(mesh.corners_of[3][0], 3);
  EXPECT_FINDS(mesh, "element 3 is missing in the list of one of its vertices");
  mesh = made<Dim>(any);
  mesh.corners_of[3].fill(none);
  EXPECT_FINDS(mesh, "list of elements is not sorted, or has one that is not its own");
  mesh = made<Dim>(any);
  mesh.elements_of.insert(0, none - 1);
  EXPECT_FINDS(mesh, "list of elements is not sorted, or has one that is not its own");
  mesh = made<Dim>(any);
  for (const VertexId v : mesh.corners_of[2]) mesh.elements_of.erase(v, 2);
  mesh.corners_of[2] = mesh.corners_of[3];
  for (const VertexId v : mesh.corners_of[3]) mesh.elements_of.insert(v, 2);
  EXPECT_FINDS(mesh, "has a facet with more than two elements");
  mesh = made<Dim>(any);
  const ElementId e = element_at_boundary(mesh, facet);
  mesh.patches_of[e][static_cast<std::size_t>(facet)] = 0;
  EXPECT_FINDS(mesh, Dim == 2 ? "has a" : "has an edge between patches");
  mesh = made<Dim>(any);
  mesh.patches_of[e][static_cast<std::size_t>(facet)] %= mesh.patches.size() - 1;
  mesh.patches_of[e][static_cast<std::size_t>(facet)] += 1;
  EXPECT_FINDS(mesh, "has a facet that does not lie in the plane of its patch");
  mesh = made<Dim>(any);
  mesh.kind_of[0].class_dimension = Dim;
  EXPECT_FINDS(mesh, "vertex 0 may move or go in a way that does not fit what it lies on");
  mesh = made<Dim>(any);
  mesh.region_of[3] = 7;
  EXPECT_FINDS(mesh, "is in a region that does not exist");
}

TEST(CheckMesh, FindsWhatIsWrongWithTheDataStructure) {
  expect_finds_faults_of_structure<2>();
  expect_finds_faults_of_structure<3>();
  Mesh<3> mesh = made<3>(box(3));
  VertexId v = 0;
  while (mesh.links_of.of(v).empty()) ++v;
  mesh.links_of.erase(v, CurveLink(mesh.links_of.of(v)[0]));
  EXPECT_FINDS(mesh, "links are not sorted, not mutual, or not along edges");
  mesh = made<3>(box(3));
  VertexId far = v + 1;
  const VertexBuffer beside = neighbours_of(mesh, v);
  while (std::find(beside.begin(), beside.end(), far) != beside.end()) ++far;
  mesh.links_of.insert(v, {far, 1});
  mesh.links_of.insert(far, {v, 1});
  EXPECT_FINDS(mesh, "links are not sorted, not mutual, or not along edges");
}

TEST(CheckDomain, FindsWhatLeftItsPlace) {
  for (const int dimension : {2, 3}) {
    const AnyMesh before = box(dimension);
    EXPECT_EQ(test::joined(check_domain(executor, before, before)), "");
    AnyMesh after = before;
    after.coordinates[0] -= 1e-6;  // the corner of the box
    EXPECT_NE(test::joined(check_domain(executor, before, after)).find("the domain measures"),
              std::string::npos);
    after = before;
    (dimension == 2 ? after.edges.reference : after.triangles.reference)[0] += 100;
    EXPECT_NE(test::joined(check_domain(executor, before, after)).find("facets of reference"),
              std::string::npos);
    auto& reference_of = dimension == 2 ? after.edges.reference : after.triangles.reference;
    std::replace(reference_of.begin(), reference_of.end(), 2, 1);
    EXPECT_NE(test::joined(check_domain(executor, before, after, 0.1))
                  .find("facets of reference 2 are gone"),
              std::string::npos);
  }
}

TEST(CheckDomain, FindsRegionsThatChanged) {
  for (const int dimension : {2, 3}) {
    const AnyMesh before = box(dimension);
    const auto swap_reference = [&](std::size_t e) {
      AnyMesh after = before;
      auto& reference_of = dimension == 2 ? after.triangles.reference : after.tetrahedra.reference;
      reference_of[e] = reference_of[e] == 1 ? 2 : 1;
      return after;
    };
    const AnyMesh after = swap_reference(0);
    const std::string found = test::joined(check_domain(executor, before, after));
    EXPECT_NE(found.find("elements of reference 1 measure 0.4"), std::string::npos) << found;
    EXPECT_NE(found.find("elements of reference 2 measure 0.5"), std::string::npos) << found;
    // An element is 1/32 of the square, 1/384 of the cube; each half has a boundary of measure 3 or
    // 4.
    const double element = dimension == 2 ? 1.0 / 32 : 1.0 / 384, boundary = dimension == 2 ? 3 : 4;
    EXPECT_NE(test::joined(check_domain(executor, before, after, 0.99 * element / boundary)), "");
    EXPECT_EQ(test::joined(check_domain(executor, before, after, 1.01 * element / boundary)), "");
  }
}

TEST(CheckDomain, FindsRegionsThatAreGoneOrNew) {
  const AnyMesh before = box(2);
  AnyMesh after = before;
  std::replace(after.triangles.reference.begin(), after.triangles.reference.end(), 2, 7);
  for (const double tolerance : {0.0, 0.1}) {
    const std::string found = test::joined(check_domain(executor, before, after, tolerance));
    EXPECT_NE(found.find("elements of reference 2 are gone"), std::string::npos) << found;
    EXPECT_NE(found.find("elements of reference 7 measure 0.5, expected 0"), std::string::npos)
        << found;
  }
}

TEST(CheckDomain, ExpectsReference0OfWhatWasNotListed) {
  for (const int dimension : {2, 3}) {
    AnyMesh after = box(dimension);
    auto& reference_of = dimension == 2 ? after.edges.reference : after.triangles.reference;
    std::fill(reference_of.begin(), reference_of.end(), 0);
    AnyMesh before = after;
    const auto leave_one = [](auto& facets) {
      facets.vertices.resize(1);
      facets.reference.resize(1);
    };
    dimension == 2 ? leave_one(before.edges) : leave_one(before.triangles);
    // An interface is no boundary and need not be listed.
    const auto drop_interface = [&](auto& facets, double half) {
      std::size_t kept = 0;
      for (std::size_t f = 0; f < facets.size(); ++f) {
        bool inside = true;
        for (const std::uint32_t v : facets.vertices[f])
          inside = inside && after.coordinates[v * static_cast<std::size_t>(dimension)] == half;
        if (inside) continue;
        facets.vertices[kept] = facets.vertices[f];
        facets.reference[kept++] = 0;
      }
      facets.vertices.resize(kept);
      facets.reference.resize(kept);
    };
    dimension == 2 ? drop_interface(after.edges, 0.5) : drop_interface(after.triangles, 0.5);
    EXPECT_EQ(test::joined(check_domain(executor, before, after)), "");
    dimension == 2 ? after.edges.vertices.pop_back() : after.triangles.vertices.pop_back();
    reference_of.pop_back();
    EXPECT_NE(
        test::joined(check_domain(executor, before, after)).find("facets of reference 0 measure"),
        std::string::npos);
  }
}

/// Two elements that share an edge (2D: a vertex), or have an edge each at the same place.
AnyMesh two_at_an_edge(int dimension, bool common) {
  AnyMesh mesh;
  mesh.dimension = dimension;
  const std::uint32_t a = common ? 0 : (dimension == 2 ? 5U : 6U), b = common ? 1 : 7;
  if (dimension == 2) {
    mesh.coordinates = {0, 0, 1, 0, 0, 1, -1, 0, 0, -1, 0, 0};
    mesh.triangles = {{{0, 1, 2}, {a, 3, 4}}, {0, 0}};
    mesh.edges = {{{0, 1}, {1, 2}, {2, 0}, {a, 3}, {3, 4}, {4, a}}, std::vector(6, 0)};
  } else {
    mesh.coordinates = {0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 2};
    mesh.tetrahedra = {{{0, 2, 3, 1}, {a, 4, 5, b}}, {0, 0}};
    mesh.triangles.vertices = {{0, 2, 3}, {0, 2, 1}, {2, 3, 1}, {3, 0, 1},
                               {a, 4, 5}, {a, 4, b}, {4, 5, b}, {5, a, b}};
    mesh.triangles.reference.assign(8, 0);
  }
  mesh.vertex_reference.assign(mesh.coordinates.size() / static_cast<std::size_t>(dimension), 0);
  return mesh;
}

TEST(CheckDomain, FindsWhereTheBoundaryMeetsItself) {
  for (const int dimension : {2, 3})
    for (const double tolerance : {0.0, 0.1}) {
      const AnyMesh apart = two_at_an_edge(dimension, false);
      const AnyMesh joined = two_at_an_edge(dimension, true);
      EXPECT_EQ(test::joined(check_domain(executor, apart, apart, tolerance)), "");
      EXPECT_EQ(test::joined(check_domain(executor, joined, joined, tolerance)), "");
      EXPECT_EQ(test::joined(check_domain(executor, joined, apart, tolerance)), "");
      EXPECT_EQ(test::joined(check_domain(executor, apart, joined, tolerance)),
                dimension == 2 ? "\n  the boundary meets itself at vertices, 1 in all, expected 0"
                               : "\n  the boundary meets itself along edges, 2 in all, expected 0");
    }
}

TEST(CheckDomain, FindsNothingWhereThereIsNothing) {
  AnyMesh nothing;
  nothing.dimension = 2;
  EXPECT_EQ(test::joined(check_domain(executor, nothing, nothing)), "");
}

TEST(CheckDomain, RefusesArraysThatDoNotFit) {
  AnyMesh mesh = box(2);
  mesh.name = "a.mesh";
  const auto complaint = [&](const AnyMesh& other) {
    auto at_second = test::complaint([&] { check_domain(executor, mesh, other); });
    if (other.dimension == 2) {
      EXPECT_EQ(test::complaint([&] { check_domain(executor, other, mesh); }), at_second);
    }
    return at_second;
  };
  AnyMesh other = mesh;
  other.coordinates.pop_back();
  EXPECT_EQ(complaint(other),
            "a.mesh: expected 2 coordinates for each of the 25 vertices, found 49 numbers in "
            "coordinates");
  other = mesh;
  other.triangles.reference.pop_back();
  EXPECT_EQ(
      complaint(other),
      "a.mesh: expected a reference for each of the 32 triangles, found 31 in triangles.reference");
  EXPECT_EQ(complaint(box(3)), "test: expected dimension 2, that of a.mesh, found 3");
}

TEST(CheckDomain, AllowsForRoundingFarFromTheOriginAndInThinDomains) {
  constexpr double thickness = 1e-3, offset = 1e6;
  for (const int dimension : {2, 3}) {
    AnyMesh before = box(dimension);
    const auto stride = static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < before.coordinates.size(); ++i) {
      if (i % stride == stride - 1) before.coordinates[i] *= thickness;
      before.coordinates[i] += offset;
    }
    AnyMesh after = before;  // with the next representable coordinates on half of the bottom
    const double bottom = offset;
    for (std::size_t i = stride - 1; i < after.coordinates.size(); i += 2 * stride)
      if (after.coordinates[i] == bottom) after.coordinates[i] = std::nextafter(bottom, 2 * bottom);
    EXPECT_EQ(test::joined(check_domain(executor, before, after)), "");
    after.coordinates[stride - 1] += 1e-6;
    const std::string found = test::joined(check_domain(executor, before, after));
    EXPECT_NE(found.find("the domain measures"), std::string::npos);
    EXPECT_NE(found.find(", expected 0.00"), std::string::npos) << found;
  }
}

/// A tetrahedron (2D: triangle) of height 1 over a flat base, and an inverted one above it, whose
/// tip reaches into the first by `depth`.
AnyMesh two_with_tips(int dimension, double depth) {
  AnyMesh mesh;
  mesh.dimension = dimension;
  if (dimension == 2) {
    mesh.coordinates = {0, 0, 1, 0, 0.5, 1, 0, 2, 0.5, 1 - depth, 1, 2};
    mesh.triangles = {{{0, 1, 2}, {3, 4, 5}}, {0, 0}};
    mesh.edges = {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}, std::vector(6, 0)};
  } else {
    mesh.coordinates = {0,   0,    0, 1,   0, 0, 0,  1,   0, 0.25, 0.25, 1,
                        0.6, -0.5, 2, 0.5, 1, 2, -1, 0.3, 2, 0.25, 0.25, 1 - depth};
    mesh.tetrahedra = {{{0, 1, 2, 3}, {4, 6, 5, 7}}, {0, 0}};
    mesh.triangles.vertices = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3},
                               {4, 5, 6}, {4, 7, 5}, {5, 7, 6}, {6, 7, 4}};
    mesh.triangles.reference.assign(8, 0);
  }
  mesh.vertex_reference.assign(mesh.coordinates.size() / static_cast<std::size_t>(dimension), 0);
  return mesh;
}

TEST(CheckBoundary, FindsFacetsThatCross) {
  for (const int dimension : {2, 3}) {
    EXPECT_EQ(test::joined(check_mesh(executor, two_with_tips(dimension, 1e-9))), "");
    EXPECT_EQ(test::joined(check_boundary(executor, two_with_tips(dimension, -1e-9))), "");
    EXPECT_EQ(test::joined(check_boundary(executor, two_with_tips(dimension, 0))), "") << "touches";
    EXPECT_EQ(test::joined(check_boundary(executor, two_with_tips(dimension, 1e-10))), "");
    const auto found = test::joined(check_boundary(executor, two_with_tips(dimension, 1e-8)));
    EXPECT_NE(found.find(dimension == 2 ? "edge 2 crosses edge 5" : "triangle 2 crosses triangle"),
              std::string::npos)
        << found;
  }
}

/// Two elements at a common slanted line or plane, without common vertices. A corner of one lies in
/// the middle of the other's facet, at this depth inside.
AnyMesh closed_crack(int dimension, double depth) {
  AnyMesh mesh;
  mesh.dimension = dimension;
  const double in = 1.0 / 3 - depth;  // on the diagonal, where the coordinates sum to 1
  if (dimension == 2) {
    mesh.coordinates = {0, 0, 1, 0, 0, 1, 0.5 - depth, 0.5 - depth, 1.5, -0.5, 1, 1, -0.5, 1.5};
    mesh.triangles = {{{0, 1, 2}, {3, 4, 5}, {3, 5, 6}}, {0, 0, 0}};
    mesh.edges = {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 6}, {6, 3}}, std::vector(7, 0)};
  } else {
    mesh.coordinates = {0,  0,  0,  1,   0,   0,    0,    1,   0,   0, 0, 1,
                        in, in, in, 0.9, 0.8, -0.7, -0.8, 0.9, 0.9, 1, 1, 1};
    mesh.tetrahedra = {{{0, 1, 2, 3}, {4, 5, 6, 7}}, {0, 0}};
    mesh.triangles.vertices = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3},
                               {4, 5, 6}, {4, 5, 7}, {5, 6, 7}, {6, 4, 7}};
    mesh.triangles.reference.assign(8, 0);
  }
  mesh.vertex_reference.assign(mesh.coordinates.size() / static_cast<std::size_t>(dimension), 0);
  return mesh;
}

TEST(CheckBoundary, LetsBothSidesOfACrackCrossByRounding) {
  for (const int dimension : {2, 3}) {
    for (const double depth : {0.0, 1e-16, 1e-13, 1e-10, -1e-10})
      EXPECT_EQ(test::joined(check_boundary(executor, closed_crack(dimension, depth))), "")
          << depth;
    EXPECT_NE(test::joined(check_boundary(executor, closed_crack(dimension, 1e-8))), "");
  }
}

TEST(CheckBoundary, FindsMeshesThatOverlapThemselves) {
  for (const int dimension : {2, 3})
    for (const double angle : {1.0, 6.2, 6.4, 7.0}) {
      AnyMesh mesh = box(dimension);
      test::bend(mesh, angle);
      EXPECT_EQ(test::joined(check_mesh(executor, mesh)), "");
      EXPECT_EQ(check_boundary(executor, mesh).empty(), angle < 6.3) << angle;
    }
}

}  // namespace
}  // namespace ductile::meshadapt::check_mesh_test
