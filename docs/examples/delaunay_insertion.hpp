/// @file
/// The Delaunay triangulation of points by insertion (Bowyer and Watson, 1981). Points are inserted
/// in rounds, each of about as many random points as all before (Amenta, Choi & Rote, SoCG 2003).
/// In a round each point is located by a walk. The walk starts at a triangle made for a point of an
/// earlier round that precedes it along a Hilbert curve.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cavity.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "ductile/runtime/sort.hpp"
#include "plane.hpp"

namespace example {

namespace runtime = ductile::runtime;

class InsertPoints {
 public:
  // ---- Items: a vertex, and a triangle close to it ----
  struct Item {
    VertexId vertex;
    TriangleId start;
  };
  using Plan = Cavity;

  explicit InsertPoints(Triangulation& mesh) : triangle_of(mesh.points.size()), mesh_(mesh) {}

  // ---- Resources: triangles, close together if they are reached together ----
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  std::array<double, 2> place_of(TriangleId t) const {
    const Point point = mesh_.corner(t, 2);
    return {static_cast<double>(point.x), static_cast<double>(point.y)};
  }

  // ---- Plan: walk to the triangle that contains the point, and find the cavity ----
  bool plan(const Item& item, Cavity& cavity, auto& reach) const {
    cavity.point = mesh_.points[item.vertex];
    TriangleId t = item.start;
    if (!walk(mesh_, t, cavity.point, reach)) return false;
    for (std::size_t i = 0; i < 3; ++i)
      if (mesh_.corner(t, i) == cavity.point) return false;
    return cavity.dig(mesh_, t, 3, reach, [](auto...) { return false; }) == Dug::closed;
  }
  // ---- Apply ----
  void apply(const Item& item, Cavity& cavity, auto& commit) {
    cavity.fill(mesh_, item.vertex, [&] { return commit.fresh(); });
    triangle_of[item.vertex] = cavity.triangles.front();
  }

  // ---- Made things: triangles ----
  std::array<std::size_t, 1> counts() const { return {mesh_.corners_of.size()}; }
  std::array<std::size_t, 1> demand(const Cavity& cavity) const {
    return {cavity.sides.size() - cavity.triangles.size()};
  }
  void grow(const std::array<std::size_t, 1>& room) {
    mesh_.corners_of.resize(room[0]);
    mesh_.neighbours_of.resize(room[0]);
  }
  void renumber(std::size_t /*kind*/, std::span<const runtime::Renumbered> moved,
                std::size_t count) {
    std::vector<TriangleId> now_of(mesh_.corners_of.size() - count, outside);  // [t - count]
    for (const auto [from, to] : moved) now_of[from - count] = to;
    for (TriangleId& t : triangle_of)
      if (t >= count) t = now_of[t - count];
    renumber_triangles(mesh_, moved, count);
  }

  std::vector<TriangleId> triangle_of;  // [vertex], one that its insertion made

 private:
  Triangulation& mesh_;
};

/// Keys of all vertices except the first four, in the order of rounds, and within a round along the
/// curve.
inline std::vector<std::uint64_t> insertion_keys(const runtime::Executor& executor,
                                                 std::span<const Point> points) {
  constexpr int bits = 12, coarser = 24 - bits, last_round = 24;
  std::vector<std::uint64_t> keys(points.size() - 4);
  runtime::parallel_for(executor, keys.size(), [&](std::size_t i) {
    const auto vertex = static_cast<VertexId>(i + 4);
    const Point point = points[vertex];
    const auto cell = [](std::int32_t x) {
      return std::min(static_cast<std::uint32_t>(x) >> coarser, (1U << bits) - 1);
    };
    // Half of the points are in the last round, a quarter in the one before, and so on.
    const int back = std::min(last_round, std::countr_zero(runtime::mix64(vertex)));
    keys[i] = static_cast<std::uint64_t>(last_round - back) << 56U |
              runtime::hilbert_key<2>({cell(point.x), cell(point.y)}, bits) << 32U | vertex;
  });
  runtime::parallel_sort(executor, std::span(keys));
  return keys;
}

/// Inserts the points of all keys, round by round; adds to a report if there is one.
inline void insert_in_rounds(const runtime::Executor& executor, Triangulation& mesh,
                             std::span<const std::uint64_t> keys, runtime::RoundsReport* report) {
  InsertPoints insert(mesh);
  constexpr std::uint64_t place_and_vertex = (std::uint64_t{1} << 56U) - 1;
  std::vector<std::uint64_t> earlier{0}, both;  // places and vertices of earlier rounds, ascending
  std::vector<InsertPoints::Item> work;
  for (auto begin = keys.begin(), end = begin; begin != keys.end(); begin = end) {
    work.clear();
    both.clear();
    std::size_t e = 0;
    for (; end != keys.end() && *end >> 56U == *begin >> 56U; ++end) {
      const std::uint64_t key = *end & place_and_vertex;
      for (; e < earlier.size() && earlier[e] < key; ++e) both.push_back(earlier[e]);
      const auto before = static_cast<VertexId>(earlier[e - (e > 0)]);
      both.push_back(key);
      work.push_back({static_cast<VertexId>(key), insert.triangle_of[before]});
    }
    both.insert(both.end(), earlier.begin() + static_cast<std::ptrdiff_t>(e), earlier.end());
    earlier.swap(both);
    const runtime::RoundsReport rounds = runtime::run_rounds(executor, insert, work);
    if (report) *report += rounds;
  }
}

/// The first four points are the corners of a rectangle, anticlockwise; all others are inside. Of
/// equal points only one becomes a vertex with triangles.
inline Triangulation delaunay_insertion_in_parallel(const runtime::Executor& executor,
                                                    std::vector<Point> points,
                                                    runtime::RoundsReport* report = nullptr) {
  Triangulation mesh{std::move(points), {{0, 1, 2}, {0, 2, 3}}, {}};
  find_neighbours(mesh);
  runtime::with_team(executor, [&] {
    insert_in_rounds(executor, mesh, insertion_keys(executor, mesh.points), report);
  });
  return mesh;
}

}  // namespace example
