#include "extents.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::cli {

namespace {

double angle_between(const Position& u, const Position& v) {
  return std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
}

/// The angle of a triangle at its first corner.
double angle_at(const Position& at, const Position& a, const Position& b) {
  return angle_between(a - at, b - at);
}

/// The angle between the facets a b c and a b d of a tetrahedron.
double dihedral_angle(const Position& a, const Position& b, const Position& c, const Position& d) {
  return angle_between(cross(b - a, c - a), cross(b - a, d - a));
}

/// A side of a facet, the vertices that are left without its corner `tip`.
template <int Corners>
struct Side {
  std::array<std::uint32_t, Corners - 1> ends;
  std::uint32_t tip;
  auto operator<=>(const Side&) const = default;
};

/// The direction of a facet away from its side, at right angles to it.
template <int Corners>
Position away(const AnyMesh& mesh, const Side<Corners>& side) {
  const Position at = position(mesh, side.ends[0]);
  Position u = position(mesh, side.tip) - at;
  if constexpr (Corners == 3) {
    const Position edge = position(mesh, side.ends[1]) - at;
    u -= (dot(u, edge) / dot(edge, edge)) * edge;
  }
  return u;
}

template <int Corners>
std::size_t ridges_among(const AnyMesh& mesh, const Cells<Corners>& facets, double least) {
  std::vector<Side<Corners>> sides;
  sides.reserve(Corners * facets.size());
  for (auto corners : facets.vertices)
    for (int i = 0; i < Corners; ++i) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      Side<Corners>& side = sides.emplace_back();
      std::copy_n(corners.begin(), Corners - 1, side.ends.begin());
      std::sort(side.ends.begin(), side.ends.end());
      side.tip = corners.back();
    }
  std::sort(sides.begin(), sides.end());
  std::size_t count = 0;
  for (auto first = sides.begin(); first != sides.end();) {
    const auto end = std::find_if(first, sides.end(),
                                  [&](const auto& side) { return side.ends != first->ends; });
    if (end - first == 2) {
      const Position u = away(mesh, first[0]), v = -1.0 * away(mesh, first[1]);
      count += angle_between(u, v) >= least ? 1 : 0;
    } else {
      ++count;
    }
    first = end;
  }
  return count;
}

/// A facet's corners, the middles of its edges, and its own middle.
template <int Corners>
double farthest(const runtime::Executor& executor, const AnyMesh& mesh,
                const Cells<Corners>& facets, const Geometry& geometry) {
  const auto distance = [&](const Position& p) {
    const auto found = geometry.closest(p.x, std::numeric_limits<double>::infinity());
    return found ? norm(p - Position{found->position}) : -1;
  };
  const auto of_facet = [&](std::size_t facet) {
    double most = -1;
    Position middle{};
    const auto& corners = facets.vertices[facet];
    for (auto a = corners.begin(); a != corners.end(); ++a) {
      middle += (1.0 / Corners) * position(mesh, *a);
      for (auto b = a; b != corners.end(); ++b)
        most = std::max(most, distance(0.5 * (position(mesh, *a) + position(mesh, *b))));
    }
    return std::max(most, distance(middle));
  };
  return runtime::parallel_reduce(executor, facets.size(), -1.0, of_facet,
                                  [](double a, double b) { return std::max(a, b); });
}

}  // namespace

Position position(const AnyMesh& mesh, std::size_t vertex) {
  const auto dim = static_cast<std::size_t>(mesh.dimension);
  const double* const x = &mesh.coordinates[vertex * dim];
  return {{x[0], x[1], dim == 3 ? x[2] : 0}};
}

double measure(const AnyMesh& mesh, std::span<const std::uint32_t> corners) {
  const auto edge = [&](std::size_t i) {
    return position(mesh, corners[i]) - position(mesh, corners[0]);
  };
  if (corners.size() == 2) return norm(edge(1));
  if (corners.size() == 3) return norm(cross(edge(1), edge(2))) / 2;
  return std::abs(dot(edge(1), cross(edge(2), edge(3)))) / 6;
}

Extents::Amount Extents::total(std::size_t dimension) const {
  Amount sum;
  for (const auto& [reference, amount] : amount_of.at(dimension)) {
    sum.count += amount.count;
    sum.size += amount.size;
  }
  return sum;
}

Box<3> box_of(const AnyMesh& mesh) {
  auto box = Box<3>::empty();
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    box = join(box, {position(mesh, v), position(mesh, v)});
  return box;
}

Extents extents_of(const AnyMesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Extents found{.box = box_of(mesh)};
  double smallest = infinity, largest = -infinity;
  const auto note = [&](double angle) {
    smallest = std::min(smallest, angle);
    largest = std::max(largest, angle);
  };
  const auto add = [&]<int Corners>(const Cells<Corners>& cells, const auto& look) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::array<Position, Corners> p;
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = position(mesh, cells.vertices[c][i]);
      Extents::Amount& amount = found.amount_of[Corners - 1][cells.reference[c]];
      ++amount.count;
      amount.size += measure(mesh, cells.vertices[c]);
      look(p);
    }
  };
  for (const std::int32_t reference : mesh.vertex_reference) ++found.amount_of[0][reference].count;
  add(mesh.edges, [](const auto&) {});
  add(mesh.triangles, [&](const auto& p) {
    if (mesh.dimension == 2)
      for (std::size_t i = 0; i < 3; ++i) note(angle_at(p[i], p[(i + 1) % 3], p[(i + 2) % 3]));
  });
  add(mesh.tetrahedra, [&](const auto& p) {
    for (const auto& [a, b] : Simplex<3>::edge) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      const std::size_t k = i != 0 && j != 0 ? 0 : i != 1 && j != 1 ? 1 : 2;
      note(dihedral_angle(p[i], p[j], p[k], p[6 - i - j - k]));
    }
  });
  if (smallest <= largest) {
    found.smallest_angle = smallest;
    found.largest_angle = largest;
  }
  return found;
}

std::size_t ridge_count(const AnyMesh& mesh, double angle) {
  return mesh.dimension == 2 ? ridges_among(mesh, mesh.edges, angle)
                             : ridges_among(mesh, mesh.triangles, angle);
}

std::optional<double> distance_to(const runtime::Executor& executor, const AnyMesh& mesh,
                                  const Geometry& geometry) {
  const double most = mesh.dimension == 2 ? farthest(executor, mesh, mesh.edges, geometry)
                                          : farthest(executor, mesh, mesh.triangles, geometry);
  return most < 0 ? std::nullopt : std::optional(most);
}

}  // namespace ductile::cli
