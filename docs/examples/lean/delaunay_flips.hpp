/// @file
/// Lawson's edge flips, serially: a stack of edges; after a flip, the four edges around are pushed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../plane.hpp"

namespace lean {

/// Flips edges until the triangulation is Delaunay.
inline void delaunay_flips(example::Triangulation& mesh) {
  using example::outside, example::place_of, example::TriangleId;
  std::vector<std::uint32_t> edges;  // 3 t + i: the edge of triangle t opposite to its corner i
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i)
      if (mesh.neighbours_of[t][i] < t) edges.push_back(3 * t + i);
  const auto replace = [&](TriangleId owner, TriangleId before, TriangleId now) {
    if (owner == outside) return;
    auto& neighbours = mesh.neighbours_of[owner];
    neighbours[place_of(before, neighbours)] = now;
  };
  while (!edges.empty()) {
    const TriangleId one = edges.back() / 3;
    const std::size_t i = edges.back() % 3, left = (i + 1) % 3, right = (i + 2) % 3;
    edges.pop_back();
    const TriangleId two = mesh.neighbours_of[one][i];
    if (two == outside) continue;
    const std::size_t j = place_of(one, mesh.neighbours_of[two]);
    const std::size_t left_of_two = (j + 1) % 3, right_of_two = (j + 2) % 3;
    auto &corners = mesh.corners_of[one], &corners_of_two = mesh.corners_of[two];
    if (!in_circle(mesh.points[corners[0]], mesh.points[corners[1]], mesh.points[corners[2]],
                   mesh.points[corners_of_two[j]]))
      continue;
    auto &beside = mesh.neighbours_of[one], &beside_two = mesh.neighbours_of[two];
    replace(beside[left], one, two);
    replace(beside_two[left_of_two], two, one);
    corners[right] = corners_of_two[j];
    corners_of_two[right_of_two] = corners[i];
    beside[i] = beside_two[left_of_two];
    beside_two[j] = beside[left];
    beside[left] = two;
    beside_two[left_of_two] = one;
    for (const std::size_t place : {i, right})
      edges.push_back(3 * one + static_cast<std::uint32_t>(place));
    for (const std::size_t place : {j, right_of_two})
      edges.push_back(3 * two + static_cast<std::uint32_t>(place));
  }
}

}  // namespace lean
