#include <sstream>

#include "check.hpp"
#include "facets.hpp"
#include "geometry.hpp"

namespace ductile::campaign {
namespace {

struct Piece {
  Cell corners;
  Box box;
};

/// Boundary and listed facets by reference; the triangles of a surface, and its rims.
std::map<int, std::vector<Piece>> pieces(const Mesh& mesh) {
  constexpr int of_rims = -1000000;
  std::map<int, std::vector<Piece>> all;
  if (mesh.surface) {
    for (std::size_t i = 0; i < mesh.elements().size(); ++i) {
      const Cell& element = mesh.elements().corners[i];
      all[mesh.elements().reference[i]].push_back({element, box_of(mesh, element)});
    }
    for (const Facet& facet : facets_of(mesh))
      if (facet.on_boundary()) all[of_rims].push_back({facet.corners, box_of(mesh, facet.corners)});
    return all;
  }
  for (const Facet& facet : facets_of(mesh)) {
    if (facet.elements.empty()) continue;
    const Piece piece = {facet.corners, box_of(mesh, facet.corners)};
    if (!facet.listed.empty())
      all[mesh.facets().reference[static_cast<std::size_t>(facet.listed[0])]].push_back(piece);
    else if (facet.on_boundary())
      all[0].push_back(piece);
  }
  return all;
}

double distance(const Mesh& mesh, const std::vector<Piece>& surface, const Point& point) {
  double nearest = 1e300;
  for (const Piece& piece : surface) {
    if (piece.box.distance(point) >= nearest) continue;
    const Cell& c = piece.corners;
    nearest = std::min(
        nearest, c[2] < 0 ? distance_to_segment(point, corner(mesh, c, 0), corner(mesh, c, 1))
                          : distance_to_triangle(point, corner(mesh, c, 0), corner(mesh, c, 1),
                                                 corner(mesh, c, 2)));
  }
  return nearest;
}

/// Sample points of a facet: corners, midpoints of edges, the centre, and points between these.
std::vector<Point> samples(const Mesh& mesh, const Cell& facet) {
  const std::size_t corners = facet[2] < 0 ? 2 : 3;
  const Point middle = centre(mesh, facet);
  std::vector<Point> points = {middle};
  for (std::size_t i = 0; i < corners; ++i) {
    points.push_back(corner(mesh, facet, i));
    points.push_back(0.5 * (corner(mesh, facet, i) + middle));
    for (std::size_t j = 0; j < i; ++j)
      points.push_back(0.5 * (corner(mesh, facet, i) + corner(mesh, facet, j)));
  }
  return points;
}

/// The largest distance of samples of `from` to the surface of the same reference in `to`.
double farthest(const Mesh& from, const Mesh& to) {
  const auto targets = pieces(to);
  double worst = 0;
  for (const auto& [reference, surface] : pieces(from)) {
    const auto target = targets.find(reference);
    if (target == targets.end()) continue;  // check_domain reports that
    for (const Piece& piece : surface)
      for (const Point& point : samples(from, piece.corners))
        worst = std::max(worst, distance(to, target->second, point));
  }
  return worst;
}

void expect(double distance, double allowed, const std::string& what, Faults& faults) {
  if (distance <= allowed) return;
  std::ostringstream text;
  text << "surface: " << what << " by " << distance << " of the extent, allowed is " << allowed;
  faults.push_back(text.str());
}

}  // namespace

Faults check_surface(const Mesh& before, const Mesh& after, const Promise& promise) {
  Faults faults;
  const Box box = box_of(before.points);
  const Mesh a = normalised(before, box), b = normalised(after, box);
  const double exact = 1e-9 + 20 * relative_rounding(box) + 4 * promise.rounding / box.extent();
  const double moved = promise.tolerance / box.extent();
  // New facets may be one tolerance from a smooth model that is itself one tolerance from the old
  // facets.
  expect(farthest(b, a), exact + 2.0002 * moved, "the new boundary is off the old one", faults);
  // Only the distance from new to old is promised. The reverse also includes corners of less than
  // -ar degrees that were cut off, which is a few times as much.
  expect(farthest(a, b), exact + 4 * moved, "the old boundary is off the new one", faults);
  return faults;
}

}  // namespace ductile::campaign
