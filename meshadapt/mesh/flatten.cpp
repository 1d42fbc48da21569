#include "mesh/flatten.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/first_bad.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

template <int Corners>
void extend(Box<3>& box, const AnyMesh& mesh, const Cells<Corners>& cells) {
  for (const auto& corners : cells.vertices)
    for (const std::uint32_t vertex : corners) {
      if (vertex >= mesh.vertex_count()) continue;  // reported elsewhere
      const Vector<3> at = position_in<3>(mesh, vertex);
      box = join(box, {at, at});
    }
}

/// The box around the corners of triangles and edges.
Box<3> box_of(const AnyMesh& mesh) {
  auto box = Box<3>::empty();
  extend(box, mesh, mesh.triangles);
  extend(box, mesh, mesh.edges);
  return box;
}

double width(const Box<3>& box, int axis) { return box.high[axis] - box.low[axis]; }

/// The axis with the smallest extent; the last one if several are equal.
int flattest(const Box<3>& box) {
  int best = 2;
  for (const int axis : {1, 0})
    if (width(box, axis) < width(box, best)) best = axis;
  return best;
}

/// A thicker mesh is a surface in space.
bool is_flat(const Box<3>& box, int axis) {
  constexpr double share = 1e-6, single = 2 * std::numeric_limits<float>::epsilon();
  const double across = std::max({width(box, 0), width(box, 1), width(box, 2)});
  const double magnitude = std::max(std::abs(box.low[axis]), std::abs(box.high[axis]));
  const double rounding = std::min(single * magnitude, 100 * share * across);
  return width(box, axis) <= share * across + rounding;
}

void drop(AnyMesh& mesh, int axis) {
  double* to = mesh.coordinates.data();
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    if (i % 3 != static_cast<std::size_t>(axis)) *to++ = mesh.coordinates[i];
  mesh.coordinates.resize(2 * mesh.vertex_count());
  mesh.dimension = 2;
  mesh.dropped_axis = axis;
}

std::string what_was_dropped(const Box<3>& box, int axis) {
  const std::string name = axis_names.at(static_cast<std::size_t>(axis));
  const double half = width(box, axis) / 2;
  std::string text =
      "Dimension is 3, but all triangles lie in " + name + " = " + number(box.low[axis] + half);
  if (half > 0) text += " up to " + number(half);
  text += "; taken as a mesh of dimension 2";
  if (axis == 2) return text;
  return text + " with the coordinates " + (axis == 0 ? "y" : "x") + " and z";
}

}  // namespace

void flatten(AnyMesh& mesh, Warnings* warnings) {
  if (!is_surface(mesh)) return;
  expect_coordinates(mesh);
  const Box<3> box = box_of(mesh);
  const int axis = is_flat(box, 2) ? 2 : flattest(box);
  if (!is_flat(box, axis)) return;
  drop(mesh, axis);
  if (warnings) warnings->push_back(printable(mesh.name + ": " + what_was_dropped(box, axis)));
}

std::string instead_of_tetrahedra(const AnyMesh& mesh) {
  if (!is_surface(mesh)) return {};
  const Box<3> box = box_of(mesh);
  const int axis = flattest(box);
  const std::string name = axis_names.at(static_cast<std::size_t>(axis));
  const std::string text = "only " + std::to_string(mesh.triangles.size()) + " triangles";
  if (is_flat(box, axis))
    return text + " in a plane " + name +
           " = constant; give them as a mesh of dimension 2 (flatten)";
  return text + " in no plane x, y or z = constant (" + name + " varies least, by " +
         number(width(box, axis)) +
         "): a surface, for which this cannot be done; a plane mesh must be turned into z = 0";
}

}  // namespace ductile::meshadapt
