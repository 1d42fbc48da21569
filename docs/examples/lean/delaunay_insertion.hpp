/// @file
/// The Delaunay triangulation of points by insertion, serially. Points are inserted in rounds, each
/// of about as many random points as all before (Amenta, Choi & Rote, SoCG 2003), and within a
/// round along a Hilbert curve, so that a walk from the last triangle made is short.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "../cavity.hpp"
#include "ductile/runtime/hash.hpp"
#include "radix_sort.hpp"
#include "triangles.hpp"

namespace lean {

/// The position along a Hilbert curve through 2^bits times 2^bits cells.
inline std::uint32_t hilbert_place(std::uint32_t x, std::uint32_t y, unsigned bits) {
  std::uint32_t place = 0;
  for (unsigned bit = bits; bit-- > 0;) {
    const std::uint32_t right = x >> bit & 1U, up = y >> bit & 1U;
    place = 4 * place + ((3 * right) ^ up);
    // In the lower quarters the curve is rotated. Masks of ones or zeros, because branches cost
    // more.
    const std::uint32_t invert = 0U - (right & (1U - up)), swap = (x ^ y) & (0U - (1U - up));
    x ^= swap ^ invert;
    y ^= swap ^ invert;
  }
  return place;
}

/// The vertices from `first` on, in the order in which to insert them.
inline std::vector<VertexId> insertion_order(std::span<const Point> points, VertexId first) {
  constexpr unsigned bits = 24, kept = 12;  // of coordinates, and those that the curve uses
  constexpr int last_round = 6;
  std::vector<std::uint64_t> keys;
  keys.reserve(points.size());
  for (VertexId v = first; v < points.size(); ++v) {
    const auto cell = [](std::int32_t x) { return static_cast<std::uint32_t>(x) >> (bits - kept); };
    // Half of the points are in the last round, a quarter in the one before, and so on.
    const int back = std::min(last_round, std::countr_zero(ductile::runtime::mix64(v)));
    const auto round = static_cast<std::uint64_t>(last_round - back);
    const std::uint64_t place = hilbert_place(cell(points[v].x), cell(points[v].y), kept);
    keys.push_back(round << 56U | place << 32U | v);
  }
  sort_by_upper_half(keys);
  std::vector<VertexId> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](std::uint64_t key) { return static_cast<VertexId>(key); });
  return order;
}

/// The first four points are the corners of a rectangle, anticlockwise; all others are inside. Of
/// equal points only one becomes a vertex with triangles.
inline Triangulation delaunay_insertion(std::vector<Point> points) {
  Triangulation mesh{std::move(points), {}, {}};
  mesh.corners_of.reserve(2 * mesh.points.size());
  mesh.neighbours_of.reserve(2 * mesh.points.size());
  mesh.corners_of = {{0, 1, 2}, {0, 2, 3}};
  mesh.neighbours_of = {{outside, 1, outside}, {outside, outside, 0}};
  example::Cavity cavity;
  TriangleId last = 0;
  for (const VertexId vertex : insertion_order(mesh.points, 4)) {
    const Point point = mesh.points[vertex];
    walk(mesh, last, point, anywhere);
    if (mesh.corner(last, 0) == point || mesh.corner(last, 1) == point ||
        mesh.corner(last, 2) == point)
      continue;
    cavity.point = point;
    cavity.dig(mesh, last, 3, anywhere, [](auto...) { return false; });
    cavity.fill(mesh, vertex, [&] { return add_triangle(mesh); });
    last = cavity.triangles.back();
  }
  return mesh;
}

}  // namespace lean
