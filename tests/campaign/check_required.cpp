#include <algorithm>
#include <set>

#include "check.hpp"

namespace ductile::campaign {
namespace {

/// Identifies a cell by the positions of its corners, because vertices may be renumbered. Where
/// sides touch, several cells share a place.
using Place = std::vector<Point>;

Place place_of(const Mesh& mesh, const Cell& cell) {
  Place place;
  for (const int vertex : cell)
    if (vertex >= 0) place.push_back(mesh.points[static_cast<std::size_t>(vertex)]);
  std::sort(place.begin(), place.end());
  return place;
}

struct Found {
  std::set<int> references;
  bool marked = false;
};

/// Cells with this number of corners and their references; vertices if it is 1.
Cells named(const Mesh& mesh, int corners) {
  if (corners > 1) return mesh.cells_of(corners);
  Cells points;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    points.add({static_cast<int>(i), -1, -1, -1}, mesh.point_reference[i]);
  return points;
}

std::set<int> used_vertices(const Mesh& mesh) {
  std::set<int> used;
  for (const Cell& element : mesh.elements().corners) used.insert(element.begin(), element.end());
  return used;
}

void compare(const Mesh& before, const Mesh& after, const std::string& name, int corners,
             Faults& faults) {
  const std::vector<int>& wanted = before.list(name);
  if (wanted.empty()) return;
  const Cells old_cells = named(before, corners), new_cells = named(after, corners);
  const std::vector<int>& listed = after.list(name);
  const std::set<int> marked(listed.begin(), listed.end());
  std::map<Place, Found> there;
  for (std::size_t i = 0; i < new_cells.size(); ++i) {
    Found& found = there[place_of(after, new_cells.corners[i])];
    found.references.insert(new_cells.reference[i]);
    found.marked = found.marked || marked.count(static_cast<int>(i)) != 0;
  }
  const std::set<int> used = used_vertices(before);
  std::size_t lost = 0, unmarked = 0, changed = 0;
  for (const int index : wanted) {
    const Cell& cell = old_cells.corners[static_cast<std::size_t>(index)];
    if (used.count(cell[0]) == 0) continue;
    const auto found = there.find(place_of(before, cell));
    if (found == there.end()) {
      ++lost;
      continue;
    }
    if (!found->second.marked) ++unmarked;
    if (found->second.references.count(old_cells.reference[static_cast<std::size_t>(index)]) == 0)
      ++changed;
  }
  report("required", lost, name + " lost", faults);
  report("required", unmarked, name + " no longer marked", faults);
  report("required", changed, name + " with another reference", faults);
}

}  // namespace

Faults check_required(const Mesh& before, const Mesh& after) {
  Faults faults;
  compare(before, after, "Corners", 1, faults);
  compare(before, after, "RequiredVertices", 1, faults);
  compare(before, after, "RequiredEdges", 2, faults);
  compare(before, after, "RequiredTriangles", 3, faults);
  compare(before, after, "RequiredTetrahedra", 4, faults);
  return faults;
}

}  // namespace ductile::campaign
