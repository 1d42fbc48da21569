#include "mesh/flatten.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "core/first_bad.hpp"
#include "mesh/array_lengths.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

/// Range of the corners of triangles and edges along one axis.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double width() const { return high - low; }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

template <int Corners>
void extend(std::array<Range, 3>& range_of, const AnyMesh& mesh, const Cells<Corners>& cells) {
  for (const auto& corners : cells.vertices)
    for (const std::uint32_t vertex : corners) {
      if (vertex >= mesh.vertex_count()) continue;  // reported elsewhere
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = mesh.coordinates[3 * std::size_t{vertex} + axis];
        range_of[axis].low = std::min(range_of[axis].low, x);
        range_of[axis].high = std::max(range_of[axis].high, x);
      }
    }
}

std::array<Range, 3> ranges(const AnyMesh& mesh) {
  std::array<Range, 3> range_of;  // [axis]
  extend(range_of, mesh, mesh.triangles);
  extend(range_of, mesh, mesh.edges);
  return range_of;
}

/// The axis with the smallest extent; the last one if several are equal.
std::size_t flattest(const std::array<Range, 3>& range_of) {
  std::size_t best = 2;
  for (const std::size_t axis : {std::size_t{1}, std::size_t{0}})
    if (range_of[axis].width() < range_of[best].width()) best = axis;
  return best;
}

double extent(const std::array<Range, 3>& range_of) {
  double widest = 0;
  for (const Range& range : range_of) widest = std::max(widest, range.width());
  return widest;
}

/// A thicker mesh is a surface in space.
bool is_flat(const std::array<Range, 3>& range_of, std::size_t axis) {
  constexpr double share = 1e-6, single = 2 * std::numeric_limits<float>::epsilon();
  const double across = extent(range_of);
  const double rounding = std::min(single * range_of[axis].magnitude(), 100 * share * across);
  return range_of[axis].width() <= share * across + rounding;
}

void drop(AnyMesh& mesh, std::size_t axis) {
  double* to = mesh.coordinates.data();
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (i % 3 != axis) *to++ = mesh.coordinates[i];
  mesh.coordinates.resize(2 * mesh.vertex_count());
  mesh.dimension = 2;
  mesh.dropped_axis = static_cast<int>(axis);
}

std::string what_was_dropped(const Range& range, std::size_t axis) {
  const std::string name = axis_names[axis];
  std::string text = "Dimension is 3, but all triangles lie in " + name + " = " +
                     number(range.low + range.width() / 2);
  if (range.width() > 0) text += " up to " + number(range.width() / 2);
  text += "; taken as a mesh of dimension 2";
  if (axis == 2) return text;
  return text + " with the coordinates " + (axis == 0 ? "y" : "x") + " and z";
}

}  // namespace

void flatten(AnyMesh& mesh, Warnings* warnings) {
  if (!is_surface(mesh)) return;
  expect_coordinates(mesh);
  const std::array<Range, 3> range_of = ranges(mesh);
  const std::size_t axis = is_flat(range_of, 2) ? 2 : flattest(range_of);
  if (!is_flat(range_of, axis)) return;
  drop(mesh, axis);
  if (warnings)
    warnings->push_back(printable(mesh.name + ": " + what_was_dropped(range_of[axis], axis)));
}

std::string instead_of_tetrahedra(const AnyMesh& mesh) {
  if (!is_surface(mesh)) return {};
  const std::array<Range, 3> range_of = ranges(mesh);
  const std::size_t axis = flattest(range_of);
  const std::string plane = std::string(axis_names[axis]) + " = constant";
  const std::string text = "only " + std::to_string(mesh.triangles.size()) + " triangles";
  if (is_flat(range_of, axis))
    return text + " in a plane " + plane + "; give them as a mesh of dimension 2 (flatten)";
  return text + " in no plane x, y or z = constant (" + axis_names[axis] + " varies least, by " +
         number(range_of[axis].width()) +
         "): a surface, for which this cannot be done; a plane mesh must be turned into z = 0";
}

}  // namespace ductile::meshadapt
