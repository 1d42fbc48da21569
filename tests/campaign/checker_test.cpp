// A checker that cannot fail is worthless: for every fault that it claims to detect there is a mesh
// with that fault, and one that differs in nothing else and is sound.

#include <gtest/gtest.h>

#include <algorithm>

#include "build.hpp"
#include "check.hpp"
#include "exact.hpp"
#include "topology.hpp"

namespace ductile::campaign {
namespace {

int by_normal(const Point&, const Point& normal) {
  for (int axis = 0; axis < 3; ++axis)
    if (normal[static_cast<std::size_t>(axis)] < -0.5) return 2 * axis + 1;
  return 2;
}

/// A unit square or cube with the facets listed.
Mesh box(int dimension, int cells = 4) {
  Random random(1);
  Grid grid;
  grid.dimension = dimension;
  for (auto& lines : grid.lines) lines = even_lines(cells);
  Mesh mesh = make_grid(random, grid);
  list_facets(mesh, true, by_normal);
  return mesh;
}

bool mentions(const Faults& faults, const std::string& words) {
  return std::any_of(faults.begin(), faults.end(), [&](const std::string& fault) {
    return fault.find(words) != std::string::npos;
  });
}

class Checker : public testing::TestWithParam<int> {
 protected:
  Mesh good_ = box(GetParam());
  Mesh bad_ = good_;
};
INSTANTIATE_TEST_SUITE_P(Dimensions, Checker, testing::Values(2, 3));

// ---- Structure ----

TEST_P(Checker, AcceptsAGoodMesh) {
  EXPECT_EQ(check_structure(good_), Faults{});
  EXPECT_EQ(check_all(good_, good_, {}), Faults{});
}

TEST_P(Checker, SeesIndicesOutOfRange) {
  bad_.elements().corners[1][0] = static_cast<int>(bad_.points.size());
  EXPECT_TRUE(mentions(check_structure(bad_), "index out of range"));
  bad_ = good_;
  bad_.facets().corners[1][0] = -1;
  EXPECT_TRUE(mentions(check_structure(bad_), "index out of range"));
  bad_ = good_;
  bad_.lists["RequiredVertices"] = {static_cast<int>(bad_.points.size())};
  EXPECT_TRUE(mentions(check_structure(bad_), "index out of range in RequiredVertices"));
}

TEST_P(Checker, SeesCoordinatesThatAreNotFinite) {
  bad_.points[3][1] = std::nan("");
  EXPECT_TRUE(mentions(check_structure(bad_), "not finite"));
}

TEST_P(Checker, SeesTurnedAndFlatElements) {
  std::swap(bad_.elements().corners[2][0], bad_.elements().corners[2][1]);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 elements without a positive volume"));
  bad_ = good_;
  const Cell& element = bad_.elements().corners[0];
  bad_.points[static_cast<std::size_t>(element[0])] =
      bad_.points[static_cast<std::size_t>(element[1])];
  EXPECT_TRUE(mentions(check_structure(bad_), "without a positive volume"));
}

TEST_P(Checker, SeesElementsThereTwice) {
  bad_.elements().add(bad_.elements().corners[0], 1);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 elements there twice"));
  EXPECT_TRUE(mentions(check_structure(bad_), "facets with both elements on one side") ||
              mentions(check_structure(bad_), "facets with more than two elements"));
}

TEST_P(Checker, SeesVerticesOfNoElement) {
  bad_.points.push_back({0.5, 0.5, 0});
  bad_.point_reference.push_back(0);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 vertices of no element"));
}

TEST_P(Checker, SeesElementsOnOneSideOfTheirFacet) {
  // A second element on a boundary facet, on the side of the first.
  const Cell facet = bad_.facets().corners[0];
  Cell element = facet;
  element[static_cast<std::size_t>(bad_.dimension)] = static_cast<int>(bad_.points.size());
  bad_.points.push_back({0.45, 0.55, bad_.dimension == 3 ? 0.35 : 0});
  bad_.point_reference.push_back(0);
  if (orientation(bad_, element) < 0) std::swap(element[0], element[1]);
  bad_.elements().add(element, 1);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 facets with both elements on one side"));
}

TEST_P(Checker, SeesFacetsThatAreNotListed) {
  bad_.facets().corners.pop_back();
  bad_.facets().reference.pop_back();
  EXPECT_TRUE(mentions(check_structure(bad_), "1 boundary facets not listed"));
  EXPECT_EQ(check_structure(bad_, true), Faults{});
}

TEST_P(Checker, SeesFacetsListedTwiceOrOfNoElement) {
  bad_.facets().add(bad_.facets().corners[0], 1);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 facets listed twice"));
  bad_ = good_;
  Cell far = {0, static_cast<int>(bad_.points.size()) - 1, -1, -1};
  if (bad_.dimension == 3) far[2] = 1;
  bad_.facets().add(far, 1);
  EXPECT_TRUE(mentions(check_structure(bad_), "1 listed facets of no element"));
}

TEST(CheckerIn3D, SeesLinesOfNoElementAndTwice) {
  Mesh mesh = box(3);
  mesh.cells[2].add({0, 1, -1, -1}, 1);
  EXPECT_EQ(check_structure(mesh), Faults{});
  mesh.cells[2].add({1, 0, -1, -1}, 1);
  EXPECT_TRUE(mentions(check_structure(mesh), "1 edges listed twice"));
  mesh.cells[2].corners[1] = {0, static_cast<int>(mesh.points.size()) - 1, -1, -1};
  EXPECT_TRUE(mentions(check_structure(mesh), "1 listed edges of no element"));
}

// ---- Topology and measures ----

/// The box without the elements around its middle.
Mesh hollow_box(int dimension) {
  Mesh mesh = box(dimension);
  keep_elements(mesh, [](const Point& x) {
    return std::max({std::abs(x[0] - 0.5), std::abs(x[1] - 0.5)}) > 0.25;
  });
  list_facets(mesh, true, by_normal);
  return mesh;
}

TEST_P(Checker, SeesAHoleThatIsClosed) {
  const Mesh holed = hollow_box(GetParam());
  EXPECT_EQ(check_domain(holed, holed, {}), Faults{});
  const Faults faults = check_domain(holed, good_, {.tolerance = 10});
  EXPECT_TRUE(mentions(faults, "Euler characteristic"));
}

TEST(CheckerIn3D, SeesAVoidThatIsClosed) {
  Mesh voided = box(3);
  hollow(voided, 100, 0.5);
  list_facets(voided, true, by_normal);
  EXPECT_EQ(check_structure(voided), Faults{});
  EXPECT_TRUE(
      mentions(check_domain(voided, box(3), {.tolerance = 10}), "boundary components 2 -> 1"));
}

TEST_P(Checker, SeesPartsThatAreJoined) {
  Mesh apart = good_;
  cut(apart, [](const std::vector<Point>& facet) {
    return std::all_of(facet.begin(), facet.end(), [](const Point& x) { return x[0] == 0.5; });
  });
  list_facets(apart, true, by_normal);
  EXPECT_EQ(check_domain(apart, apart, {}), Faults{});
  EXPECT_TRUE(mentions(check_domain(apart, good_, {.tolerance = 10}), "components 2 -> 1"));
}

TEST_P(Checker, SeesRegionsThatChange) {
  for (std::size_t i = 0; i < 3; ++i) good_.elements().reference[i] = 7;
  bad_ = good_;
  for (int& reference : bad_.elements().reference)
    if (reference == 7) reference = 1;
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {}), "region 7 is lost"));
  EXPECT_TRUE(mentions(check_domain(bad_, good_, {}), "region 7 is new"));
  bad_ = good_;
  bad_.elements().reference.back() = 7;  // far from the others: a second part
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {.tolerance = 10}), "components of region 7"));
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {}), "volume of reference 7"));
}

TEST_P(Checker, SeesWhereTheBoundaryMeetsItself) {
  // Cells of a 2 x 2 chequerboard meet at a vertex in 2D, along an edge in 3D.
  Random random(1);
  Grid grid;
  grid.dimension = GetParam();
  for (auto& lines : grid.lines) lines = even_lines(2);
  grid.keep = [](const std::array<int, 3>& cell) { return cell[0] == cell[1]; };
  Mesh touching = make_grid(random, grid);
  const Topology topology = topology_of(touching);
  EXPECT_EQ(topology.non_manifold_vertices, GetParam() == 2 ? 1 : 0);
  EXPECT_EQ(topology.non_manifold_lines, GetParam() == 2 ? 0 : 1);
  Topology other = topology;
  other.non_manifold_vertices = other.non_manifold_lines = 0;
  EXPECT_TRUE(mentions(differences(topology, other), "where the boundary meets itself"));
  remove_non_manifold(touching);
  EXPECT_EQ(topology_of(touching).non_manifold_vertices + topology_of(touching).non_manifold_lines,
            0);
}

TEST_P(Checker, SeesMeasuresThatChange) {
  for (Point& point : bad_.points) point[0] *= 1 + 1e-7;
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {}), "volume of reference 1"));
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {}), "boundary of reference"));
  EXPECT_EQ(check_domain(good_, bad_, {.tolerance = 1e-6}), Faults{});
  bad_ = good_;
  bad_.facets().reference[0] = 99;
  EXPECT_TRUE(mentions(check_domain(good_, bad_, {.tolerance = 1e-6}), "reference 99 is new"));
}

// ---- Where the boundary is ----

TEST_P(Checker, SeesABoundaryThatMoved) {
  const auto moved = static_cast<std::size_t>(
      std::find_if(bad_.points.begin(), bad_.points.end(),
                   [](const Point& x) { return x[0] == 0 && x[1] == 0.5; }) -
      bad_.points.begin());
  bad_.points[moved][0] += 0.01;
  EXPECT_TRUE(mentions(check_surface(good_, bad_, {}), "the new boundary is off the old one"));
  EXPECT_TRUE(mentions(check_surface(good_, bad_, {.tolerance = 0.0049}), "the new boundary"));
  EXPECT_EQ(check_surface(good_, bad_, {.tolerance = 0.0051}), Faults{});
  Mesh shorter = good_;
  for (Point& point : shorter.points) point[0] *= 0.9;
  EXPECT_TRUE(mentions(check_surface(good_, shorter, {}), "the old boundary is off the new one"));
}

// ---- Overlaps ----

TEST_P(Checker, SeesBodiesThatOverlap) {
  const std::size_t axis = static_cast<std::size_t>(GetParam()) - 1;
  Mesh apart = good_;
  cut(apart, [=](const std::vector<Point>& facet) {
    return std::all_of(facet.begin(), facet.end(), [=](const Point& x) { return x[axis] == 0.5; });
  });
  list_facets(apart, true, by_normal);
  EXPECT_EQ(check_overlaps(apart), Faults{});
  const auto side = [&](const Mesh& mesh, int vertex) {
    for (const Cell& element : mesh.elements().corners)
      if (std::find(element.begin(), element.end(), vertex) != element.end())
        for (const int other : element)
          if (other >= 0 && mesh.points[static_cast<std::size_t>(other)][axis] > 0.5) return 1;
    return 0;
  };
  Mesh overlapping = apart;
  for (std::size_t i = 0; i < apart.points.size(); ++i)
    if (side(apart, static_cast<int>(i)) == 1) {
      overlapping.points[i][axis] -= 0.3;
      overlapping.points[i][0] += 0.03;
    }
  EXPECT_EQ(check_structure(overlapping), Faults{});
  EXPECT_TRUE(mentions(check_overlaps(overlapping), "elements lie in others"));
  EXPECT_TRUE(mentions(check_overlaps(overlapping), "go through the boundary"));
}

// ---- Required entities ----

struct Required {
  const char* name;
  int corners;
};

TEST_P(Checker, SeesRequiredEntitiesThatAreLost) {
  if (GetParam() == 3) good_.cells[2].add({0, 1, -1, -1}, 1);
  std::vector<Required> lists = {
      {"Corners", 1}, {"RequiredVertices", 1}, {"RequiredEdges", 2}, {"RequiredTriangles", 3}};
  if (GetParam() == 3) lists.push_back({"RequiredTetrahedra", 4});
  for (const Required& required : lists) {
    SCOPED_TRACE(required.name);
    Mesh before = good_;
    before.lists[required.name] = {0};
    EXPECT_EQ(check_required(before, before), Faults{});
    Mesh after = before;
    after.lists.clear();
    EXPECT_TRUE(mentions(check_required(before, after), "no longer marked"));
    after = before;
    if (required.corners == 1)
      after.point_reference[0] = 55;
    else
      after.cells[required.corners].reference[0] = 55;
    EXPECT_TRUE(mentions(check_required(before, after), "another reference"));
    after = before;
    const int vertex = required.corners == 1 ? 0 : before.cells[required.corners].corners[0][0];
    after.points[static_cast<std::size_t>(vertex)][0] += 1e-15;
    EXPECT_TRUE(mentions(check_required(before, after), std::string(required.name) + " lost"));
  }
}

// ---- Metrics ----

Field constant_field(const Mesh& mesh, const std::vector<double>& tensor) {
  Field field;
  field.dimension = mesh.dimension;
  field.components = static_cast<int>(tensor.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    field.values.insert(field.values.end(), tensor.begin(), tensor.end());
  return field;
}

TEST_P(Checker, SeesMetricsThatAreNone) {
  const std::vector<double> unit =
      GetParam() == 2 ? std::vector<double>{4, 0, 4} : std::vector<double>{4, 0, 4, 0, 0, 4};
  const Field good = constant_field(good_, unit);
  EXPECT_EQ(check_metric(good_, good, {}), Faults{});
  EXPECT_EQ(check_metric(good_, good, {.shortest_size = 0.5, .largest_size = 0.5}), Faults{});
  Field bad = good;
  bad.values[1] = 4 * (1 + 1e-14);
  EXPECT_TRUE(mentions(check_metric(good_, bad, {}), "1 tensors that are not positive definite"));
  bad.values[1] = 4;  // singular, within what rounding may cause
  EXPECT_EQ(check_metric(good_, bad, {}), Faults{});
  EXPECT_TRUE(mentions(check_metric(good_, good, {.shortest_size = 0.51}), "sizes below -hmin"));
  EXPECT_TRUE(mentions(check_metric(good_, good, {.largest_size = 0.49}), "sizes above -hmax"));
  EXPECT_TRUE(mentions(check_metric(good_, good, {.longest_edge = 0.4}), "edges longer than"));
  EXPECT_EQ(check_metric(good_, good, {.longest_edge = 0.9}), Faults{});
  bad = good;
  bad.values[0] = std::nan("");
  EXPECT_TRUE(mentions(check_metric(good_, bad, {}), "not finite"));
  bad = good;
  bad.values.resize(bad.values.size() - unit.size());
  EXPECT_TRUE(mentions(check_metric(good_, bad, {}), "not one value for each vertex"));
}

// ---- Exact signs ----

TEST(ExactSigns, AreRightWhereDoublesCannotTell) {
  // Next to the line through (0.5, 0.5) and (12, 12), one unit in the last place away from it.
  const Point a = {12, 12, 0}, b = {24, 24, 0};
  for (int i = -20; i <= 20; ++i) {
    const double x = 0.5 + i * 0x1p-53;
    EXPECT_EQ(orientation(a, b, {x, 0.5, 0}), i > 0 ? -1 : i < 0 ? 1 : 0) << i;
    EXPECT_EQ(orientation(a, b, {7, 5, 1}, {x, 0.5, 0}) == 0, i == 0) << i;
    EXPECT_EQ(orientation(b, a, {x, 0.5, 0}), i > 0 ? 1 : i < 0 ? -1 : 0) << i;
  }
}

TEST(ExactSigns, TellDefiniteTensorsFromSingularOnes) {
  const std::array<double, 6> singular = {4, 4, 4, 0, 0, 1};
  std::array<double, 6> tensor = singular;
  EXPECT_FALSE(is_positive_definite(tensor.data(), 2));
  EXPECT_FALSE(is_positive_definite(tensor.data(), 3));
  tensor[1] = std::nextafter(4, 0);  // definite by the last bit
  EXPECT_TRUE(is_positive_definite(tensor.data(), 2));
  EXPECT_TRUE(is_positive_definite(tensor.data(), 3));
}

TEST(ExactSigns, HoldAtAnyScale) {
  for (const double scale : {1e-300, 1e-150, 1e-20, 1.0, 1e20, 1e150, 1e300}) {
    const Point a = {0, 0, 0}, b = {scale, 0, 0}, c = {0, scale, 0}, d = {0, 0, scale};
    EXPECT_EQ(orientation(a, b, c), 1) << scale;
    EXPECT_EQ(orientation(a, c, b), -1) << scale;
    EXPECT_EQ(orientation(a, b, c, d), 1) << scale;
    EXPECT_EQ(orientation(a, c, b, d), -1) << scale;
    EXPECT_EQ(orientation(a, b, c, Point{scale, scale, 0}), 0) << scale;
  }
}

}  // namespace
}  // namespace ductile::campaign
