#include "geometry/make_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::make_mesh_test {
namespace {

using runtime::Executor;

template <int Dim>
struct Made {
  Mesh<Dim> mesh;
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
};

/// Makes the mesh and checks everything except qualities, which need a metric.
template <int Dim>
Made<Dim> make(const AnyMesh& any, const MakeMeshOptions& options = {}) {
  const Executor executor({.threads = 2});
  Made<Dim> made;
  made.mesh = make_mesh<Dim>(executor, any, options, made.neighbours, made.warnings);
  for (auto& site : made.mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
  update_qualities(executor, made.mesh);
  const auto faults = check_mesh(executor, made.mesh);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  return made;
}

template <int Dim>
std::array<int, 4> vertices_by_class_dimension(const Mesh<Dim>& mesh) {
  std::array<int, 4> count{};
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    if (mesh.vertex_alive(v)) ++count[mesh.kind_of[v].class_dimension];
  return count;
}

std::string complaint(const AnyMesh& any, const MakeMeshOptions& options = {}) {
  try {
    if (any.dimension == 2)
      make<2>(any, options);
    else
      make<3>(any, options);
  } catch (const InputError& error) {
    return error.in_file();
  }
  return "nothing thrown";
}

#define EXPECT_COMPLAINT(mesh, part) \
  EXPECT_NE(complaint(mesh).find(part), std::string::npos) << complaint(mesh)

AnyMesh square(int n) { return test::make_grid(test::unit_grid(2, n)); }
AnyMesh cube(int n) { return test::make_grid(test::unit_grid(3, n)); }

// ---- Classification ----

TEST(MakeMesh, FindsTheSidesAndCornersOfASquare) {
  const auto made = make<2>(square(4));
  EXPECT_EQ(made.mesh.patches.size(), 1U + 4);
  EXPECT_EQ(vertices_by_class_dimension(made.mesh), (std::array{4, 12, 9, 0}));
}

TEST(MakeMesh, FindsTheSidesRidgesAndCornersOfACube) {
  const auto made = make<3>(cube(4));
  EXPECT_EQ(made.mesh.patches.size(), 1U + 6);
  EXPECT_EQ(made.mesh.curves.size(), 1U + 12);
  EXPECT_EQ(vertices_by_class_dimension(made.mesh), (std::array{8, 36, 54, 27}));
}

TEST(MakeMesh, FindsTheSameInAnyDirectionOfSpace) {
  for (const double offset : {0.0, 100.0}) {
    test::Random random(5);
    AnyMesh flat = square(4), solid = cube(4);
    test::place(flat, random, 1e-3, offset * 1e-3);
    test::place(solid, random, 1e3, offset * 1e3);
    EXPECT_EQ(vertices_by_class_dimension(make<2>(flat).mesh), (std::array{4, 12, 9, 0}));
    EXPECT_EQ(vertices_by_class_dimension(make<3>(solid).mesh), (std::array{8, 36, 54, 27}));
  }
}

TEST(MakeMesh, FindsInterfacesBetweenRegionsListedOrNot) {
  for (const bool listed : {true, false}) {
    test::Grid grid = test::unit_grid(3, 4);
    grid.region = test::two_halves(4);
    const auto made = make<3>(test::make_grid(grid, listed));
    EXPECT_EQ(made.mesh.regions.size(), 2U);
    EXPECT_EQ(made.mesh.patches.size(), 1U + 2 + 8 + 1);  // ends, halved sides, interface
    EXPECT_EQ(made.mesh.curves.size(), 1U + 8 + 8 + 4);
    EXPECT_EQ(vertices_by_class_dimension(made.mesh)[0], 12);
  }
}

TEST(MakeMesh, GivesEachFacetOfACurvedBoundaryItsOwnPatch) {
  AnyMesh any = cube(4);
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    double largest = 0, square_sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& x = any.coordinates[3 * v + axis];
      x = 2 * x - 1 + 1e-3 * std::sin(static_cast<double>(7 * v + axis));
      largest = std::max(largest, std::abs(x));
      square_sum += x * x;
    }
    const double scale = square_sum > 0 ? largest / std::sqrt(square_sum) : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) any.coordinates[3 * v + axis] *= scale;
  }
  std::fill(any.triangles.reference.begin(), any.triangles.reference.end(), 1);
  const auto made = make<3>(any);
  EXPECT_EQ(made.mesh.patches.size(), 1 + any.triangles.size());
  EXPECT_EQ(vertices_by_class_dimension(made.mesh), (std::array{98, 0, 0, 27}));
}

// ---- Smooth patches and curves ----

AnyMesh bent(int dimension, int n, double angle) {
  AnyMesh any = test::make_grid(test::unit_grid(dimension, n));
  test::bend(any, angle);
  return any;
}

TEST(MakeMesh, JoinsFacetsThatTurnLittleIfCurvedBoundariesMayChange) {
  const auto flat = make<2>(bent(2, 4, 1), {.hausdorff_tolerance = 0.01});
  EXPECT_EQ(vertices_by_class_dimension(flat.mesh), (std::array{4, 12, 9, 0}));
  const auto solid = make<3>(bent(3, 4, 1), {.hausdorff_tolerance = 0.01});
  EXPECT_EQ(vertices_by_class_dimension(solid.mesh), (std::array{8, 36, 54, 27}));
  const auto is_smooth = [](const auto& entity) { return entity.smooth; };
  EXPECT_EQ(std::count_if(solid.mesh.curves.begin(), solid.mesh.curves.end(), is_smooth), 4);
}

TEST(MakeMesh, KeepsFacetsApartThatTurnMuch) {
  for (const double angle : {1.5 * 0.78, 1.5 * 0.79})  // of two cells; 45 degrees: 0.785
    for (const int dimension : {2, 3}) {
      const AnyMesh any = bent(dimension, 2, 2 * angle / 1.5);
      const auto fixed =
          dimension == 2
              ? vertices_by_class_dimension(make<2>(any, {.hausdorff_tolerance = 0.01}).mesh)[0]
              : vertices_by_class_dimension(make<3>(any, {.hausdorff_tolerance = 0.01}).mesh)[0];
      const bool joined = angle < 1.5 * 0.785;
      EXPECT_EQ(fixed, dimension == 2 ? (joined ? 4 : 6) : (joined ? 8 : 12));
    }
}

TEST(MakeMesh, TellsRidgesByTheAngleGiven) {
  const AnyMesh flat = bent(2, 4, 1.3), solid = bent(3, 4, 1.3);  // 18.6 degrees per cell
  for (const double angle : {18.0, 19.0, 89.0}) {
    const MakeMeshOptions options{.hausdorff_tolerance = 0.01, .ridge_angle = angle};
    const bool joined = angle > 18.6;
    EXPECT_EQ(vertices_by_class_dimension(make<2>(flat, options).mesh)[0], joined ? 4 : 10);
    EXPECT_EQ(vertices_by_class_dimension(make<3>(solid, options).mesh)[0], joined ? 8 : 20);
  }
}

TEST(MakeMesh, RefusesTolerancesAndAnglesThatAreNone) {
  for (const double tolerance : {-0.1, std::nan(""), double{INFINITY}})
    EXPECT_THROW(make<2>(square(2), {.hausdorff_tolerance = tolerance}), InputError) << tolerance;
  for (const double angle : {-1.0, 0.0, 90.0, 180.0, std::nan("")})
    EXPECT_THROW(make<2>(square(2), {.ridge_angle = angle}), InputError) << angle;
}

/// The closed curves are the rims of the cone's lid and base.
TEST(MakeMesh, ClosedCurvesKeepThreeVertices) {
  const auto made = make<3>(test::truncated_cone(6, 0.5), {.hausdorff_tolerance = 0.01});
  const auto count = vertices_by_class_dimension(made.mesh);
  EXPECT_GE(count[0], 6);
  EXPECT_LE(count[0], 12);
  EXPECT_EQ(count[0] + count[1], 2 * 24);
}

/// The arcs are recognised whatever the number of edges between their ends.
TEST(MakeMesh, ArcsBendAsAWhole) {
  for (int n = 3; n <= 12; ++n) {
    const auto made = make<3>(test::truncated_cone(n, 0.5), {.hausdorff_tolerance = 0.01});
    const auto& curves = made.mesh.curves;
    EXPECT_GE(curves.size(), 1U + 6);
    for (std::size_t c = 1; c < curves.size(); ++c) EXPECT_TRUE(curves[c].smooth) << n;
  }
}

/// A drop: a closed curve whose edges turn little, except at one corner.
TEST(MakeMesh, ACornerOfASmoothPatchStays) {
  constexpr int n = 24;
  AnyMesh any;
  any.dimension = 2;
  any.vertex_reference.assign(n + 1, 0);
  any.coordinates = {-0.5, 0};
  for (int i = 0; i < n; ++i) {
    const double at = 2 * std::numbers::pi * i / n;
    const double width = std::sin(at / 2) * std::sin(at / 2);
    any.coordinates.insert(any.coordinates.end(), {-std::cos(at) - 1, width * std::sin(at)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % n;
    any.triangles.add({0, b, a}, 1);
    any.edges.add({b, a}, 1);
  }
  const auto made = make<2>(any, {.hausdorff_tolerance = 0.01});
  EXPECT_EQ(made.mesh.kind_of[1].class_dimension, 0);
  EXPECT_EQ(vertices_by_class_dimension(made.mesh), (std::array{1, n - 1, 1, 0}));
}

TEST(MakeMesh, RequiredEntitiesFixTheirVertices) {
  AnyMesh any = square(4);
  any.required_triangles = {12};
  any.required_edges = {0};
  const auto made = make<2>(any);
  for (const VertexId v : any.triangles.vertices[12])
    EXPECT_EQ(made.mesh.kind_of[v].class_dimension, 0);
  for (const VertexId v : any.edges.vertices[0]) EXPECT_EQ(made.mesh.kind_of[v].class_dimension, 0);
  EXPECT_EQ(vertices_by_class_dimension(make<2>(square(4), {.lock_boundary = true}).mesh)[0], 16);
}

/// A side bends by more than rounding. A far-away vertex without elements must not make it count as
/// flat.
TEST(MakeMesh, AnUnusedVertexFarAwayDoesNotFlattenTheBoundary) {
  AnyMesh any = square(4);
  any.coordinates[1] -= 1e-6 / 3;  // all digits are used, so the bend is intended
  any.coordinates.insert(any.coordinates.end(), {1e9, 1e9});
  any.vertex_reference.push_back(0);
  const auto made = make<2>(any);
  EXPECT_GT(made.mesh.patches.size(), 1U + 4);
  ASSERT_EQ(made.warnings.size(), 1U);
  EXPECT_NE(made.warnings[0].find("belong to no element"), std::string::npos);
}

/// A slit from the middle of the left side to the centre. Its sides have different vertices but
/// share the tip, over which neither side may slide.
TEST(MakeMesh, TheTipOfASlitIsACorner) {
  test::Grid grid = test::unit_grid(2, 4);
  grid.region = [](const test::Cell& cell) { return cell[0] < 2 && cell[1] >= 2 ? 2 : 1; };
  AnyMesh any = test::make_grid(grid, false);
  const auto at = [&](double x, double y) {
    std::uint32_t v = 0;
    while (any.coordinates[2 * v] != x || any.coordinates[2 * v + 1] != y) ++v;
    return v;
  };
  const std::uint32_t outer = at(0, 0.5), middle = at(0.25, 0.5), tip = at(0.5, 0.5);
  const auto twin = [&](std::uint32_t v) {
    any.coordinates.insert(any.coordinates.end(),
                           {any.coordinates[2 * v], any.coordinates[2 * v + 1]});
    any.vertex_reference.push_back(0);
    return static_cast<std::uint32_t>(any.vertex_count() - 1);
  };
  const std::uint32_t outer_twin = twin(outer), middle_twin = twin(middle);
  const auto above = [&](std::uint32_t& v) {
    v = v == outer ? outer_twin : v == middle ? middle_twin : v;
  };
  for (std::size_t t = 0; t < any.triangles.size(); ++t)
    if (any.triangles.reference[t] == 2)
      std::for_each(any.triangles.vertices[t].begin(), any.triangles.vertices[t].end(), above);
  for (auto& edge : any.edges.vertices)
    if (any.coordinates[2 * edge[0] + 1] + any.coordinates[2 * edge[1] + 1] > 1)
      std::for_each(edge.begin(), edge.end(), above);
  std::fill(any.triangles.reference.begin(), any.triangles.reference.end(), 1);
  for (const auto& edge :
       {std::array{outer, middle}, {middle, tip}, {tip, middle_twin}, {middle_twin, outer_twin}})
    any.edges.add(edge, 9);
  const auto made = make<2>(any);
  EXPECT_EQ(made.mesh.kind_of[tip].class_dimension, 0);
  EXPECT_EQ(made.mesh.kind_of[middle].class_dimension, 1);
  EXPECT_EQ(made.mesh.kind_of[middle_twin].class_dimension, 1);
}

// ---- Invalid meshes ----

TEST(MakeMesh, ReorientsAMeshThatIsInvertedAsAWhole) {
  for (AnyMesh any : {square(3), cube(2)}) {
    for (auto& t : any.triangles.vertices) std::swap(t[0], t[1]);
    for (auto& t : any.tetrahedra.vertices) std::swap(t[0], t[1]);
    const auto warnings = any.dimension == 2 ? make<2>(any).warnings : make<3>(any).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("reoriented"), std::string::npos);
  }
}

/// The vertices lie beyond a facet of an element. Elements that are only listed with the wrong
/// orientation are repaired, see repaired_meshes_test.
TEST(MakeMesh, RefusesAnInvertedElement) {
  AnyMesh flat = square(3), solid = cube(3);
  const auto move_inner = [](AnyMesh& mesh, double to) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      double* x = &mesh.coordinates[v * static_cast<std::size_t>(mesh.dimension)];
      if (std::all_of(x, x + mesh.dimension, [](double at) { return at > 0.3 && at < 0.4; }))
        return std::fill(x, x + mesh.dimension, to);
    }
  };
  move_inner(flat, 0.8);
  move_inner(solid, 0.8);
  EXPECT_COMPLAINT(flat, " is inverted: it overlaps triangle");
  EXPECT_COMPLAINT(solid, " is inverted: it overlaps tetrahedron");
}

TEST(MakeMesh, RefusesAnElementWithoutVolume) {
  AnyMesh flat = square(2), solid = cube(2);
  const auto collapse = [](AnyMesh& mesh, const auto& corners) {
    const auto dimension = static_cast<std::size_t>(mesh.dimension);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      mesh.coordinates[corners[0] * dimension + axis] =
          mesh.coordinates[corners[1] * dimension + axis];
  };
  collapse(flat, flat.triangles.vertices[3]);
  collapse(solid, solid.tetrahedra.vertices[3]);
  EXPECT_COMPLAINT(flat, "has no volume");
  EXPECT_COMPLAINT(solid, "has no volume");
}

TEST(MakeMesh, AcceptsAnElementThatOnlyExactArithmeticFindsPositive) {
  AnyMesh any;
  any.dimension = 2;
  any.vertex_reference = {0, 0, 0};
  const double up = std::nextafter(0.7, 1.0);
  any.coordinates = {0.1, 0.1, 0.3, 0.3, 0.7, up};
  any.triangles.add({0, 1, 2}, 1);
  for (std::uint32_t i = 0; i < 3; ++i) any.edges.add({i, (i + 1) % 3}, 1);
  EXPECT_TRUE(make<2>(any).warnings.empty());
}

TEST(MakeMesh, RefusesDuplicateElements) {
  AnyMesh flat = square(2), solid = cube(1);
  flat.triangles.add(flat.triangles.vertices[1], 1);
  solid.tetrahedra.add(solid.tetrahedra.vertices[1], 1);
  EXPECT_COMPLAINT(flat, "triangle 2 and 9 are the same element");
  EXPECT_COMPLAINT(solid, "tetrahedron 2 and 7 are the same element");
}

TEST(MakeMesh, NamesTheFirstElementsOfACrowdInAnyOrder) {
  AnyMesh any;  // two triangles above the edge 0-1, one below
  any.dimension = 2;
  any.coordinates = {0, 0, 1, 0, 0.4, 1, 0.6, 2, 0.5, -1};
  any.vertex_reference = {0, 0, 0, 0, 0};
  const std::vector<Corners<2>> crowd{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  for (const auto& order : {std::array{0, 1, 2}, {0, 2, 1}, {2, 0, 1}}) {
    any.triangles = {};
    for (const int i : order) any.triangles.add(crowd[static_cast<std::size_t>(i)], 1);
    EXPECT_COMPLAINT(any, "triangle 1 and");
    EXPECT_COMPLAINT(any, "overlap, or share an edge with a third");
  }
}

TEST(MakeMesh, RefusesAThirdElementAtAFacet) {
  AnyMesh any = square(1);
  any.coordinates.insert(any.coordinates.end(), {0.9, 0.2});
  any.vertex_reference.push_back(0);
  any.triangles.add({0, 4, 2}, 1);  // overlaps, on the diagonal
  EXPECT_COMPLAINT(any, "overlap, or share an edge with a third");
}

TEST(MakeMesh, RefusesOrCompletesAnUnlistedBoundary) {
  for (AnyMesh any : {square(2), cube(1)}) {
    any.dimension == 2 ? any.edges.vertices.pop_back() : any.triangles.vertices.pop_back();
    any.dimension == 2 ? any.edges.reference.pop_back() : any.triangles.reference.pop_back();
    EXPECT_COMPLAINT(any, "is not listed in the file");
    EXPECT_EQ(complaint(any, {.complete_boundary = true}), "nothing thrown");
  }
}

/// Meshes assembled from pieces have doubled vertices where these meet.
TEST(MakeMesh, NamesVerticesAtOnePlaceWhereABoundaryIsNotListed) {
  const auto give_twin = [](auto& elements, std::uint32_t vertex, std::uint32_t twin) {
    for (auto& corners : elements)
      for (std::uint32_t& corner : corners)
        if (corner == vertex) return void(corner = twin);
  };
  for (AnyMesh any : {square(2), cube(2)}) {
    any.name = "pieces.mesh";
    const auto d = static_cast<std::size_t>(any.dimension);
    const auto twin = static_cast<std::uint32_t>(any.vertex_count()), middle = twin / 2;
    for (std::size_t axis = 0; axis < d; ++axis)
      any.coordinates.push_back(any.coordinates[d * middle + axis]);
    any.vertex_reference.push_back(0);
    d == 2 ? give_twin(any.triangles.vertices, middle, twin)
           : give_twin(any.tetrahedra.vertices, middle, twin);
    const std::string pair = "vertices " + std::to_string(middle + 1) + " and " +
                             std::to_string(twin + 1) + " are at one place: join";
    EXPECT_COMPLAINT(any, pair);
    const MakeMeshOptions completed{.complete_boundary = true};
    const auto warnings =
        any.dimension == 2 ? make<2>(any, completed).warnings : make<3>(any, completed).warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find(pair), std::string::npos) << warnings[0];
  }
}

/// Some mesh generators write construction lines whose end points belong to nothing else.
TEST(MakeMesh, LeavesOutEdgesOfNoTetrahedron) {
  AnyMesh any = cube(2);
  test::list_ridges(any);
  any.required_edges = {2, 5};
  AnyMesh loose = any;
  loose.name = "loose.mesh";
  loose.coordinates.insert(loose.coordinates.end(), {5, 5, 5});
  loose.vertex_reference.push_back(0);
  for (const std::array<std::uint32_t, 2> corners : {std::array{0U, 26U}, {0U, 27U}}) {
    loose.edges.vertices.insert(loose.edges.vertices.begin() + 1, corners);
    loose.edges.reference.insert(loose.edges.reference.begin() + 1, 9);
  }
  for (auto* list : {&loose.ridges, &loose.required_edges}) {
    for (std::uint32_t& edge : *list) edge += edge < 1 ? 0 : 2;
    list->insert(list->begin() + 1, {1, 2});
  }
  const auto made = make<3>(loose);
  ASSERT_EQ(made.warnings.size(), 2U);
  EXPECT_EQ(made.warnings[1], "loose.mesh: 2 of " + std::to_string(loose.edges.size()) +
                                  " listed edges belong to no tetrahedron and are left out;"
                                  " the first is edge 2");
  const Executor executor({.threads = 2});
  EXPECT_EQ(take_apart(executor, make<3>(loose).mesh).mesh,
            take_apart(executor, make<3>(any).mesh).mesh);
}

TEST(MakeMesh, RefusesIndicesAndNumbersThatAreNone) {
  AnyMesh any = square(2);
  any.triangles.vertices[5][1] = 100;
  EXPECT_COMPLAINT(any, "triangle 6 names vertex 101, but there are only 9");
  any = square(2);
  any.triangles.vertices[5][1] = any.triangles.vertices[5][0];
  EXPECT_COMPLAINT(any, "triangle 6 names the same vertex twice");
  any = square(2);
  any.coordinates[7] = std::nan("");
  EXPECT_COMPLAINT(any, "vertex 4 has a coordinate that is not a finite number");
  any.coordinates[7] = -1e51;
  EXPECT_COMPLAINT(any, "vertex 4 has a coordinate beyond 1e50");
  any = square(2);
  for (double& x : any.coordinates) x *= 1e-51;
  EXPECT_COMPLAINT(any, "the mesh is smaller than 1e-50");
  any = square(2);
  any.required_vertices = {9};
  EXPECT_COMPLAINT(any, "names vertex 10");
  any = square(2);
  any.required_triangles = {8};
  EXPECT_COMPLAINT(any, "has number 9, but there are only 8");
  any = square(2);
  any.edges.add({0, 8}, 1);
  EXPECT_COMPLAINT(any, "edge 9 is not a facet of any triangle");
  AnyMesh none;
  none.dimension = 3;
  EXPECT_COMPLAINT(none, "there is nothing to adapt");
}

TEST(TakeApart, GivesBackWhatWasMade) {
  test::Grid grid = test::unit_grid(3, 3);
  grid.region = test::checkerboard();
  AnyMesh any = test::make_grid(grid);
  test::list_ridges(any);
  any.required_tetrahedra = {3, 5};
  any.required_triangles = {7};
  any.required_vertices = {11};
  const AnyMesh back = take_apart(Executor({.threads = 2}), make<3>(any).mesh).mesh;
  const auto changes = test::changes_of_what_is_kept(any, back);
  EXPECT_TRUE(changes.empty()) << test::joined(changes);
  EXPECT_EQ(back.tetrahedra.size(), any.tetrahedra.size());
  EXPECT_EQ(back.triangles.size(), any.triangles.size());
  EXPECT_EQ(back.edges.size(), any.edges.size());
  EXPECT_EQ(back.ridges.size(), any.ridges.size());
}

}  // namespace
}  // namespace ductile::meshadapt::make_mesh_test
