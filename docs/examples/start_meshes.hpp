/// @file
/// Start meshes: random points in a square, alone, or sorted into rows with the strips between rows
/// triangulated from left to right, which is far from Delaunay; and a plate with holes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "plane.hpp"

namespace example {

constexpr std::int32_t square_side = 1 << 24;

/// The corners of a square, anticlockwise, and n random points inside.
inline std::vector<Point> random_points(std::size_t n) {
  std::vector<Point> points{{0, 0}, {square_side, 0}, {square_side, square_side}, {0, square_side}};
  points.reserve(n + 4);
  const auto random = [](std::uint64_t seed) {
    return static_cast<std::int32_t>(1 + ductile::runtime::mix64(seed) % (square_side - 1));
  };
  for (std::size_t i = 0; i < n; ++i) points.push_back({random(2 * i + 1), random(2 * i + 2)});
  return points;
}

/// Triangulates between two rows of points, each ascending in x, the second above the first. Sweeps
/// both from left to right; vertices not yet joined to the right wait on a stack (Garey, Johnson,
/// Preparata & Tarjan, Inf. Process. Lett. 7, 1978).
inline void triangulate_between(Triangulation& mesh, std::span<const VertexId> low,
                                std::span<const VertexId> high) {
  std::vector<VertexId> waiting;
  const VertexId first_high = high.front();
  const auto is_low = [&](VertexId v) { return v < first_high; };
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    if (turn(mesh.points[a], mesh.points[b], mesh.points[c]) < 0) std::swap(b, c);
    mesh.corners_of.push_back({a, b, c});
  };
  while (!low.empty() || !high.empty()) {
    const bool take_low =
        !low.empty() && (high.empty() || mesh.points[low.front()].x <= mesh.points[high.front()].x);
    auto& row = take_low ? low : high;
    const VertexId next = row.front();
    row = row.subspan(1);
    if (waiting.size() >= 2 && is_low(waiting.back()) != take_low) {
      for (std::size_t i = 1; i < waiting.size(); ++i) add(waiting[i - 1], waiting[i], next);
      waiting = {waiting.back()};
    }
    while (waiting.size() >= 2 && is_low(waiting.back()) == take_low) {
      const VertexId middle = waiting.back(), back = waiting[waiting.size() - 2];
      const auto bend = turn(mesh.points[back], mesh.points[middle], mesh.points[next]);
      if (take_low ? bend <= 0 : bend >= 0) break;
      add(back, middle, next);
      waiting.pop_back();
    }
    waiting.push_back(next);
  }
}

/// About n random points in a square, with its corners and a point for each row on its sides.
inline Triangulation rows_of_points(std::size_t n) {
  const auto rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(n))) + 1;
  const auto random = [](std::uint64_t seed) {
    return static_cast<std::int32_t>(1 + ductile::runtime::mix64(seed) % (square_side - 1));
  };
  std::vector<std::vector<Point>> row_of(rows + 2);
  row_of.front() = {{0, 0}, {square_side, 0}};
  row_of.back() = {{0, square_side}, {square_side, square_side}};
  for (std::uint32_t row = 0; row < rows; ++row) {
    const auto middle = static_cast<std::int32_t>((row + 0.5) * square_side / rows);
    row_of[row + 1] = {{0, middle}, {square_side, middle}};
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Point point{random(2 * i), random(2 * i + 1)};
    row_of[1 + std::uint64_t{static_cast<std::uint32_t>(point.y)} * rows / square_side].push_back(
        point);
  }
  Triangulation mesh;
  std::vector<VertexId> below, row;
  for (std::vector<Point>& points : row_of) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    row.clear();
    for (const Point point : points) {
      row.push_back(static_cast<VertexId>(mesh.points.size()));
      mesh.points.push_back(point);
    }
    if (!below.empty()) triangulate_between(mesh, below, row);
    below = row;
  }
  find_neighbours(mesh);
  return mesh;
}

/// Cells in a row of the plate; every other cell of every other row is a hole.
constexpr std::int32_t plate_cells = 15, cell_side = 1 << 20;
constexpr std::int64_t plate_area =
    (plate_cells * plate_cells - (plate_cells / 2) * (plate_cells / 2)) * std::int64_t{cell_side} *
    cell_side;

/// Makes the cells of the plate, two triangles each.
inline Triangulation plate() {
  Triangulation mesh;
  for (std::int32_t y = 0; y <= plate_cells; ++y)
    for (std::int32_t x = 0; x <= plate_cells; ++x)
      mesh.points.push_back({x * cell_side, y * cell_side});
  for (VertexId y = 0; y < plate_cells; ++y)
    for (VertexId x = 0; x < plate_cells; ++x) {
      if (x % 2 == 1 && y % 2 == 1) continue;
      const VertexId low = y * (plate_cells + 1) + x, high = low + plate_cells + 1;
      mesh.corners_of.push_back({low, low + 1, high + 1});
      mesh.corners_of.push_back({low, high + 1, high});
    }
  find_neighbours(mesh);
  return mesh;
}

}  // namespace example
