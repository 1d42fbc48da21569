#include "gmf_keywords.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "number_reader.hpp"

namespace ductile::meshadapt::gmf {
namespace {

/// All names in the order of their numbers, from 0; '-' stands for a free number.
constexpr std::string_view names_in_order =
    "- MeshVersionFormatted - Dimension Vertices Edges Triangles Quadrilaterals Tetrahedra Prisms "
    "Hexahedra - RequiredTetrahedra Corners Ridges RequiredVertices RequiredEdges "
    "RequiredTriangles RequiredQuadrilaterals TangentAtEdgeVertices NormalAtVertices "
    "NormalAtTriangleVertices NormalAtQuadrilateralVertices AngleOfCornerBound TrianglesP2 "
    "EdgesP2 SolAtPyramids QuadrilateralsQ2 ISolAtPyramids SubDomainFromGeom TetrahedraP2 "
    "Fault_NearTri Fault_Inter HexahedraQ2 ExtraVerticesAtEdges ExtraVerticesAtTriangles "
    "ExtraVerticesAtQuadrilaterals ExtraVerticesAtTetrahedra ExtraVerticesAtPrisms "
    "ExtraVerticesAtHexahedra VerticesOnGeometricVertices VerticesOnGeometricEdges "
    "VerticesOnGeometricTriangles VerticesOnGeometricQuadrilaterals EdgesOnGeometricEdges "
    "Fault_FreeEdge Polyhedra Polygons Fault_Overlap Pyramids BoundingBox - PrivateTable "
    "Fault_BadShape End TrianglesOnGeometricTriangles TrianglesOnGeometricQuadrilaterals "
    "QuadrilateralsOnGeometricTriangles QuadrilateralsOnGeometricQuadrilaterals Tangents Normals "
    "TangentAtVertices SolAtVertices SolAtEdges SolAtTriangles SolAtQuadrilaterals "
    "SolAtTetrahedra SolAtPrisms SolAtHexahedra DSolAtVertices ISolAtVertices ISolAtEdges "
    "ISolAtTriangles ISolAtQuadrilaterals ISolAtTetrahedra ISolAtPrisms ISolAtHexahedra "
    "Iterations Time Fault_SmallTri CoarseHexahedra Comments PeriodicVertices PeriodicEdges "
    "PeriodicTriangles PeriodicQuadrilaterals PrismsP2 PyramidsP2 QuadrilateralsQ3 "
    "QuadrilateralsQ4 TrianglesP3 TrianglesP4 EdgesP3 EdgesP4 IRefGroups DRefGroups TetrahedraP3 "
    "TetrahedraP4 HexahedraQ3 HexahedraQ4 PyramidsP3 PyramidsP4 PrismsP3 PrismsP4 HOSolAtEdgesP1 "
    "HOSolAtEdgesP2 HOSolAtEdgesP3 HOSolAtTrianglesP1 HOSolAtTrianglesP2 HOSolAtTrianglesP3 "
    "HOSolAtQuadrilateralsQ1 HOSolAtQuadrilateralsQ2 HOSolAtQuadrilateralsQ3 HOSolAtTetrahedraP1 "
    "HOSolAtTetrahedraP2 HOSolAtTetrahedraP3 HOSolAtPyramidsP1 HOSolAtPyramidsP2 "
    "HOSolAtPyramidsP3 HOSolAtPrismsP1 HOSolAtPrismsP2 HOSolAtPrismsP3 HOSolAtHexahedraQ1 "
    "HOSolAtHexahedraQ2 HOSolAtHexahedraQ3 BezierBasis ByteFlow EdgesP2Ordering EdgesP3Ordering "
    "TrianglesP2Ordering TrianglesP3Ordering QuadrilateralsQ2Ordering QuadrilateralsQ3Ordering "
    "TetrahedraP2Ordering TetrahedraP3Ordering PyramidsP2Ordering PyramidsP3Ordering "
    "PrismsP2Ordering PrismsP3Ordering HexahedraQ2Ordering HexahedraQ3Ordering EdgesP1Ordering "
    "EdgesP4Ordering TrianglesP1Ordering TrianglesP4Ordering QuadrilateralsQ1Ordering "
    "QuadrilateralsQ4Ordering TetrahedraP1Ordering TetrahedraP4Ordering PyramidsP1Ordering "
    "PyramidsP4Ordering PrismsP1Ordering PrismsP4Ordering HexahedraQ1Ordering HexahedraQ4Ordering "
    "FloatingPointPrecision HOSolAtEdgesP4 HOSolAtTrianglesP4 HOSolAtQuadrilateralsQ4 "
    "HOSolAtTetrahedraP4 HOSolAtPyramidsP4 HOSolAtPrismsP4 HOSolAtHexahedraQ4 "
    "HOSolAtEdgesP1NodesPositions HOSolAtEdgesP2NodesPositions HOSolAtEdgesP3NodesPositions "
    "HOSolAtEdgesP4NodesPositions HOSolAtTrianglesP1NodesPositions "
    "HOSolAtTrianglesP2NodesPositions HOSolAtTrianglesP3NodesPositions "
    "HOSolAtTrianglesP4NodesPositions HOSolAtQuadrilateralsQ1NodesPositions "
    "HOSolAtQuadrilateralsQ2NodesPositions HOSolAtQuadrilateralsQ3NodesPositions "
    "HOSolAtQuadrilateralsQ4NodesPositions HOSolAtTetrahedraP1NodesPositions "
    "HOSolAtTetrahedraP2NodesPositions HOSolAtTetrahedraP3NodesPositions "
    "HOSolAtTetrahedraP4NodesPositions HOSolAtPyramidsP1NodesPositions "
    "HOSolAtPyramidsP2NodesPositions HOSolAtPyramidsP3NodesPositions "
    "HOSolAtPyramidsP4NodesPositions HOSolAtPrismsP1NodesPositions HOSolAtPrismsP2NodesPositions "
    "HOSolAtPrismsP3NodesPositions HOSolAtPrismsP4NodesPositions HOSolAtHexahedraQ1NodesPositions "
    "HOSolAtHexahedraQ2NodesPositions HOSolAtHexahedraQ3NodesPositions "
    "HOSolAtHexahedraQ4NodesPositions EdgesReferenceElement TriangleReferenceElement "
    "QuadrilateralReferenceElement TetrahedronReferenceElement PyramidReferenceElement "
    "PrismReferenceElement HexahedronReferenceElement BoundaryLayers ReferenceStrings Prisms9 "
    "Hexahedra12 Quadrilaterals6 BoundaryPolygonHeaders BoundaryPolygonVertices "
    "InnerPolygonHeaders InnerPolygonVertices PolyhedraHeaders PolyhedraFaces Domains VerticesGID "
    "EdgesGID TrianglesGID QuadrilateralsGID TetrahedraGID PyramidsGID PrismsGID HexahedraGID "
    "SolAtBoundaryPolygons SolAtPolyhedra VertexOnGeometryNode VertexOnGeometryEdge "
    "EdgeOnGeometryEdge VertexOnGeometryFace EdgeOnGeometryFace TriangleOnGeometryFace "
    "QuadrialteralOnGeometryFace MeshOnGeometry VerticesColour VerticesGrain "
    "VertexGrainPartitions EdgeGrainPartitions TriangleGrainPartitions "
    "QuadrilateralGrainPartitions TetrahedronGrainPartitions PyramidGrainPartitions "
    "PrismGrainPartitions HexahedronGrainPartitions ColorPartitions TetrahedraColour "
    "TetrahedraGrain ";

constexpr std::size_t keyword_limit =
    static_cast<std::size_t>(std::count(names_in_order.begin(), names_in_order.end(), ' '));

constexpr auto name_table = [] {
  std::array<std::string_view, keyword_limit> table;
  std::size_t begin = 0;
  for (std::string_view& name : table) {
    const std::size_t end = names_in_order.find(' ', begin);
    name = names_in_order.substr(begin, end - begin);
    if (name == "-") name = {};
    begin = end + 1;
  }
  return table;
}();

/// True for simple cells of every order ("Prisms", "TrianglesP2", "Hexahedra12") and general ones,
/// but not for data about them ("TrianglesP2Ordering").
bool names_other_cells(std::string_view name) {
  if (name.starts_with("Poly") || name.find("Polygon") != std::string_view::npos)
    return !name.starts_with("Sol");
  constexpr std::array shapes = {"Edges",    "Triangles", "Quadrilaterals", "Tetrahedra",
                                 "Pyramids", "Prisms",    "Hexahedra"};
  for (const std::string_view shape : shapes) {
    if (!name.starts_with(shape)) continue;
    std::string_view order = name.substr(shape.size());
    if (order.starts_with('P') || order.starts_with('Q')) order.remove_prefix(1);
    if (order.find_first_not_of("0123456789") == std::string_view::npos) return true;
  }
  return false;
}

/// True if inserting, removing or replacing one letter makes the two equal.
bool differ_by_one(std::string_view a, std::string_view b) {
  if (a.size() < b.size()) std::swap(a, b);
  if (a.size() > b.size() + 1) return false;
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto rest_of_b = a.size() == b.size() && in_b != b.end() ? in_b + 1 : in_b;
  return in_a == a.end() || std::equal(in_a + 1, a.end(), rest_of_b, b.end());
}

}  // namespace

std::string_view name_of(Keyword keyword) {
  const auto number = static_cast<std::size_t>(keyword);
  return number < name_table.size() ? name_table[number] : std::string_view{};
}

Keyword keyword_named(std::string_view name) {
  if (name.empty()) return Keyword::none;
  if (name == "Hexaedra") name = "Hexahedra";  // as some programs spell it
  const auto found = std::find(name_table.begin(), name_table.end(), name);
  return found == name_table.end() ? Keyword::none
                                   : static_cast<Keyword>(found - name_table.begin());
}

std::string_view similar_name(std::string_view name) {
  const std::string wanted = lower(name);
  for (const std::string_view candidate : name_table)
    if (!candidate.empty() && role_of(keyword_named(candidate)) != Role::other &&
        differ_by_one(wanted, lower(candidate)))
      return candidate;
  return {};
}

Role role_of(Keyword keyword) {
  using enum Keyword;
  constexpr std::array of_mesh = {
      vertices, edges,          triangles,         tetrahedra,         corners,
      ridges,   required_edges, required_vertices, required_triangles, required_tetrahedra};
  if (keyword == version || keyword == dimension || keyword == end) return Role::frame;
  if (keyword == field_at_vertices) return Role::field;
  if (std::find(of_mesh.begin(), of_mesh.end(), keyword) != of_mesh.end()) return Role::mesh;
  return names_other_cells(name_of(keyword)) ? Role::other_cells : Role::other;
}

bool has_count(Keyword keyword) {
  const std::string_view name = name_of(keyword);
  constexpr std::array without = {
      "AngleOfCornerBound",     "BoundingBox", "Iterations", "Time", "BezierBasis",
      "FloatingPointPrecision", "Domains",     "Polygons"};
  return !name.empty() && role_of(keyword) != Role::frame && !name.ends_with("ReferenceElement") &&
         std::find(without.begin(), without.end(), name) == without.end();
}

bool has_text(Keyword keyword) {
  const std::string_view name = name_of(keyword);
  return name == "Comments" || name == "ReferenceStrings" || name == "IRefGroups";
}

}  // namespace ductile::meshadapt::gmf
