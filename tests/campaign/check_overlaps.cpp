#include <algorithm>
#include <set>

#include "check.hpp"
#include "exact.hpp"
#include "facets.hpp"
#include "geometry.hpp"

namespace ductile::campaign {
namespace {

// The sides of a crack may overlap by rounding, and by twice the tolerance of the program's own
// check.
constexpr double depth_allowed = 5e-10;  // as a share of the extent

struct Boxed {
  Cell corners;
  Box box;
};

/// Visits all pairs (i, j) of boxes that meet, i from `ones`, j from `others`, in order of i.
template <class Visit>
void visit_meeting(const std::vector<Boxed>& ones, const std::vector<Boxed>& others, Visit visit) {
  std::vector<std::size_t> order(others.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return others[a].box.low[0] < others[b].box.low[0];
  });
  double widest = 0;
  for (const Boxed& other : others) widest = std::max(widest, other.box.high[0] - other.box.low[0]);
  for (const Boxed& one : ones) {
    auto at = std::lower_bound(order.begin(), order.end(), one.box.low[0] - widest,
                               [&](std::size_t i, double x) { return others[i].box.low[0] < x; });
    for (; at != order.end() && others[*at].box.low[0] <= one.box.high[0]; ++at)
      if (one.box.meets(others[*at].box)) visit(one, others[*at]);
  }
}

/// Depth of the point in the element, measured across its facets; negative outside.
double depth(const Mesh& mesh, const Cell& element, const Point& point) {
  double least = 1e300;
  for (const Cell& facet : facets_of_element(mesh, element)) {
    const Point& a = corner(mesh, facet, 0);
    Point normal;
    if (mesh.dimension == 2) {
      const Point along = corner(mesh, facet, 1) - a;
      normal = {along[1], -along[0], 0};
    } else {
      normal = cross(corner(mesh, facet, 1) - a, corner(mesh, facet, 2) - a);
    }
    least = std::min(least, dot(a - point, normal) / norm(normal));
  }
  return least;
}

std::size_t count_overlaps(const Mesh& mesh) {
  std::vector<Boxed> elements, centres;
  for (const Cell& element : mesh.elements().corners) {
    elements.push_back({element, box_of(mesh, element)});
    Box middle;
    middle.add(centre(mesh, element));
    centres.push_back({element, middle});
  }
  std::size_t overlaps = 0;
  visit_meeting(centres, elements, [&](const Boxed& one, const Boxed& other) {
    if (one.corners != other.corners && depth(mesh, other.corners, one.box.low) > depth_allowed)
      ++overlaps;
  });
  return overlaps;
}

bool share_a_corner(const Cell& a, const Cell& b) {
  return std::any_of(a.begin(), a.end(), [&](int vertex) {
    return vertex >= 0 && std::find(b.begin(), b.end(), vertex) != b.end();
  });
}

/// The point where the segment from p to q meets a line or plane at signed distances at_p and at_q.
Point where(const Point& p, const Point& q, double at_p, double at_q) {
  return p + (at_p / (at_p - at_q)) * (q - p);
}

/// Does edge p q cross segment a b by more than the allowed depth? In 2D.
bool crosses(const Point& p, const Point& q, const Point& a, const Point& b) {
  if (orientation(a, b, p) * orientation(a, b, q) >= 0) return false;
  if (orientation(p, q, a) * orientation(p, q, b) >= 0) return false;
  const auto off = [](const Point& point, const Point& from, const Point& to) {
    return cross(to - from, point - from)[2] / norm(to - from);
  };
  return std::min({std::abs(off(p, a, b)), std::abs(off(q, a, b)), std::abs(off(a, p, q)),
                   std::abs(off(b, p, q))}) > depth_allowed;
}

/// Does edge p q cross triangle a b c by more than the allowed depth?
bool crosses(const Mesh& mesh, const Point& p, const Point& q, const Cell& triangle) {
  const Point &a = corner(mesh, triangle, 0), &b = corner(mesh, triangle, 1),
              &c = corner(mesh, triangle, 2);
  if (orientation(a, b, c, p) * orientation(a, b, c, q) >= 0) return false;
  const int first = orientation(p, q, a, b);
  if (first == 0 || orientation(p, q, b, c) != first || orientation(p, q, c, a) != first)
    return false;
  const Point normal = cross(b - a, c - a);
  const double at_p = dot(p - a, normal) / norm(normal), at_q = dot(q - a, normal) / norm(normal);
  const Point hit = where(p, q, at_p, at_q);
  return std::min({std::abs(at_p), std::abs(at_q), distance_to_segment(hit, a, b),
                   distance_to_segment(hit, b, c), distance_to_segment(hit, c, a)}) > depth_allowed;
}

/// Number of edges of elements that cross facets of the boundary, or triangles of a surface.
std::size_t count_crossings(const Mesh& mesh) {
  std::vector<Boxed> facets, edges;
  for (const Facet& facet : facets_of(mesh))
    if (facet.on_boundary() && !mesh.surface)
      facets.push_back({facet.corners, box_of(mesh, facet.corners)});
  for (const Cell& element : mesh.elements().corners)
    if (mesh.surface) facets.push_back({element, box_of(mesh, element)});
  for (const auto& [a, b] : edges_of(mesh.elements().corners, mesh.corner_count())) {
    const Cell edge = {a, b, -1, -1};
    edges.push_back({edge, box_of(mesh, edge)});
  }
  std::size_t crossings = 0;
  visit_meeting(edges, facets, [&](const Boxed& edge, const Boxed& facet) {
    if (share_a_corner(edge.corners, facet.corners)) return;
    const Point &p = corner(mesh, edge.corners, 0), &q = corner(mesh, edge.corners, 1);
    const bool found = mesh.dimension == 2 ? crosses(p, q, corner(mesh, facet.corners, 0),
                                                     corner(mesh, facet.corners, 1))
                                           : crosses(mesh, p, q, facet.corners);
    if (found) ++crossings;
  });
  return crossings;
}

}  // namespace

Faults check_overlaps(const Mesh& mesh) {
  Faults faults;
  const Mesh unit = normalised(mesh, box_of(mesh.points));
  if (const std::size_t count = unit.surface ? 0 : count_overlaps(unit); count > 0)
    faults.push_back("overlap: " + std::to_string(count) + " elements lie in others");
  if (const std::size_t count = count_crossings(unit); count > 0)
    faults.push_back("overlap: " + std::to_string(count) + " edges go through the boundary");
  return faults;
}

}  // namespace ductile::campaign
