#include "ductile/meshadapt/any_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

namespace {

constexpr double most_vertices = 4e9;  // fit numbers of 32 bits

template <std::size_t N>
void expect_box(const std::array<double, N>& extent, const std::array<int, N>& cells) {
  double vertices = 1;
  for (std::size_t axis = 0; axis < N; ++axis) {
    if (!(extent[axis] > 0) || !std::isfinite(extent[axis]) || cells[axis] < 1)
      throw InputError("expected a positive extent and at least one cell along each axis, found " +
                       std::to_string(extent[axis]) + " and " + std::to_string(cells[axis]));
    vertices *= cells[axis] + 1.0;
  }
  if (vertices > most_vertices)
    throw InputError("expected at most " + std::to_string(most_vertices) + " vertices, found " +
                     std::to_string(vertices));
}

/// Numbers of the vertices of a grid, x running fastest.
struct GridNumbers {
  std::array<int, 3> cells;

  std::uint32_t operator()(const std::array<int, 3>& at) const {
    const auto at_32 = [&](std::size_t axis) { return static_cast<std::uint32_t>(at[axis]); };
    const auto row = [&](std::size_t axis) { return static_cast<std::uint32_t>(cells[axis]) + 1; };
    return (at_32(2) * row(1) + at_32(1)) * row(0) + at_32(0);
  }
};

void add_vertices(AnyMesh& mesh, const std::array<double, 3>& extent,
                  const std::array<int, 3>& cells) {
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        const std::array<int, 3> at{i, j, k};
        for (std::size_t axis = 0; axis < static_cast<std::size_t>(mesh.dimension); ++axis)
          mesh.coordinates.push_back(extent[axis] * at[axis] / cells[axis]);
        mesh.vertex_reference.push_back(0);
      }
}

/// Adds the tetrahedron of Kuhn's subdivision of a cell that follows the axes in the order of a
/// permutation. Odd permutations are reoriented.
void add_tetrahedron(AnyMesh& mesh, const GridNumbers& number, std::array<int, 3> at,
                     const std::array<std::size_t, 3>& axes) {
  std::array<std::uint32_t, 4> corners{number(at), 0, 0, 0};
  for (std::size_t step = 0; step < 3; ++step) {
    ++at[axes[step]];
    corners[step + 1] = number(at);
  }
  const bool even = (axes[0] + 1) % 3 == axes[1];
  if (!even) std::swap(corners[1], corners[2]);
  mesh.tetrahedra.add(corners, 1);
}

void add_tetrahedra(AnyMesh& mesh, const std::array<int, 3>& cells) {
  const GridNumbers number{cells};
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        std::array<std::size_t, 3> axes{0, 1, 2};
        do add_tetrahedron(mesh, number, {i, j, k}, axes);
        while (std::next_permutation(axes.begin(), axes.end()));
      }
}

/// Adds both sides across an axis, cut along the same diagonals as the cells.
void add_sides(AnyMesh& mesh, const std::array<int, 3>& cells, std::size_t axis) {
  const GridNumbers number{cells};
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (const bool high : {false, true})
    for (int i = 0; i < cells[u]; ++i)
      for (int j = 0; j < cells[v]; ++j) {
        std::array<int, 3> at{};
        at[axis] = high ? cells[axis] : 0;
        const auto corner = [&](int du, int dv) {
          at[u] = i + du;
          at[v] = j + dv;
          return number(at);
        };
        const int side = static_cast<int>(2 * axis) + (high ? 2 : 1);
        const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        mesh.triangles.add({a, high ? b : c, high ? c : b}, side);
        mesh.triangles.add({a, high ? c : d, high ? d : c}, side);
      }
}

}  // namespace

template <>
AnyMesh box_mesh<2>(const std::array<double, 2>& extent, const std::array<int, 2>& cells) {
  expect_box(extent, cells);
  AnyMesh mesh;
  mesh.dimension = 2;
  mesh.name = "rectangle";
  add_vertices(mesh, {extent[0], extent[1], 0}, {cells[0], cells[1], 0});
  const GridNumbers number{{cells[0], cells[1], 0}};
  for (int j = 0; j < cells[1]; ++j)
    for (int i = 0; i < cells[0]; ++i) {
      const std::uint32_t a = number({i, j, 0}), b = number({i + 1, j, 0}),
                          c = number({i + 1, j + 1, 0}), d = number({i, j + 1, 0});
      const bool rising = (i + j) % 2 == 0;
      mesh.triangles.add({a, b, rising ? c : d}, 1);
      mesh.triangles.add({rising ? a : b, c, d}, 1);
    }
  for (int i = 0; i < cells[0]; ++i) {
    mesh.edges.add({number({i, 0, 0}), number({i + 1, 0, 0})}, Side::bottom);
    mesh.edges.add({number({i + 1, cells[1], 0}), number({i, cells[1], 0})}, Side::top);
  }
  for (int j = 0; j < cells[1]; ++j) {
    mesh.edges.add({number({0, j + 1, 0}), number({0, j, 0})}, Side::left);
    mesh.edges.add({number({cells[0], j, 0}), number({cells[0], j + 1, 0})}, Side::right);
  }
  return mesh;
}

template <>
AnyMesh box_mesh<3>(const std::array<double, 3>& extent, const std::array<int, 3>& cells) {
  expect_box(extent, cells);
  AnyMesh mesh;
  mesh.dimension = 3;
  mesh.name = "box";
  add_vertices(mesh, extent, cells);
  add_tetrahedra(mesh, cells);
  for (std::size_t axis = 0; axis < 3; ++axis) add_sides(mesh, cells, axis);
  return mesh;
}

}  // namespace ductile::meshadapt
