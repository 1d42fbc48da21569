/// @file
/// Surfaces alone for tests, and measures of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt::surface_support {

using Edge = std::array<std::uint32_t, 2>;

// ---- Surfaces ----

/// The graph of (u, v) in [0, 1]^2, of n x m cells; `closed`: u = 1 is u = 0.
inline AnyMesh sheet(int n, int m, const std::function<Vector<3>(double, double)>& at,
                     bool closed = false, std::int32_t reference = 1) {
  AnyMesh mesh;
  mesh.dimension = 3;
  mesh.name = "sheet";
  const int columns = closed ? n : n + 1;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i)
      for (const double x : at(static_cast<double>(i) / n, static_cast<double>(j) / m).x)
        mesh.coordinates.push_back(x);
  mesh.vertex_reference.assign(mesh.coordinates.size() / 3, 0);
  const auto vertex = [&](int i, int j) {
    return static_cast<std::uint32_t>(j * columns + i % columns);
  };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.triangles.add({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)}, reference);
      mesh.triangles.add({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}, reference);
    }
  return mesh;
}

/// Joins vertices that are within 1e-9 of each other.
inline AnyMesh welded(const std::vector<AnyMesh>& parts) {
  AnyMesh mesh;
  mesh.dimension = 3;
  mesh.name = "parts";
  std::map<std::array<long long, 3>, std::uint32_t> number_of;
  for (const AnyMesh& part : parts) {
    std::vector<std::uint32_t> number;
    for (std::size_t v = 0; v < part.vertex_count(); ++v) {
      std::array<long long, 3> key;
      for (std::size_t k = 0; k < 3; ++k) key[k] = std::llround(part.coordinates[3 * v + k] * 1e9);
      const auto [at, is_new] =
          number_of.try_emplace(key, static_cast<std::uint32_t>(number_of.size()));
      if (is_new)
        mesh.coordinates.insert(mesh.coordinates.end(), &part.coordinates[3 * v],
                                &part.coordinates[3 * v] + 3);
      number.push_back(at->second);
    }
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      auto corners = part.triangles.vertices[t];
      for (std::uint32_t& v : corners) v = number[v];
      if (std::set(corners.begin(), corners.end()).size() == 3)
        mesh.triangles.add(corners, part.triangles.reference[t]);
    }
  }
  mesh.vertex_reference.assign(mesh.coordinates.size() / 3, 0);
  return mesh;
}

inline Vector<3> on_sphere(double u, double v) {
  const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v;
  return {{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), -std::cos(b)}};
}
inline AnyMesh sphere(int n) { return welded({sheet(2 * n, n, on_sphere, true)}); }
inline AnyMesh hemisphere(int n) {
  return welded({sheet(
      2 * n, n, [](double u, double v) { return on_sphere(u, v / 2); }, true)});
}

/// A tube of radius 1/2 and height 2, in long facets; its caps have the references 2 and 3.
inline AnyMesh cylinder(int n, bool with_caps) {
  const auto on_tube = [](double u, double v) {
    const double a = 2 * std::numbers::pi * u;
    return Vector<3>{{std::cos(a) / 2, std::sin(a) / 2, 2 * v}};
  };
  std::vector<AnyMesh> parts{sheet(n, 1, on_tube, true)};
  for (const double z : {0.0, 2.0})
    if (with_caps)
      parts.push_back(sheet(
          n, 1,
          [&, z](double u, double v) {
            const double a = 2 * std::numbers::pi * (z == 0 ? u : 1 - u);
            return Vector<3>{{(1 - v) * std::cos(a) / 2, (1 - v) * std::sin(a) / 2, z}};
          },
          true, z == 0 ? 2 : 3));
  // Outwards all over.
  for (std::size_t p = 1; p < parts.size(); ++p)
    for (auto& corners : parts[p].triangles.vertices) std::swap(corners[0], corners[1]);
  return welded(parts);
}

/// Three squares that meet along the line x = y = 0.
inline AnyMesh three_sheets(int n) {
  std::vector<AnyMesh> parts;
  for (int k = 0; k < 3; ++k) {
    const double a = 2 * std::numbers::pi * k / 3;
    parts.push_back(sheet(
        n, n,
        [a](double u, double v) {
          return Vector<3>{{u * std::cos(a), u * std::sin(a), v}};
        },
        false, k + 1));
  }
  return welded(parts);
}

// ---- Measures ----

inline Vector<3> at(const AnyMesh& mesh, std::uint32_t v) { return position_in<3>(mesh, v); }

inline std::map<Edge, int> edges_of(const AnyMesh& mesh) {
  std::map<Edge, int> count_of;
  for (const auto& corners : mesh.triangles.vertices)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      ++count_of[{std::min(a, b), std::max(a, b)}];
    }
  return count_of;
}

/// The length of the edges of one triangle (rims), or of more than two.
inline double length_of(const AnyMesh& mesh, const std::function<bool(int)>& counts) {
  double sum = 0;
  for (const auto& [edge, count] : edges_of(mesh))
    if (counts(count)) sum += norm(at(mesh, edge[1]) - at(mesh, edge[0]));
  return sum;
}
inline double rims(const AnyMesh& mesh) {
  return length_of(mesh, [](int n) { return n == 1; });
}
inline double non_manifold(const AnyMesh& mesh) {
  return length_of(mesh, [](int n) { return n > 2; });
}

inline long euler(const AnyMesh& mesh) {
  return static_cast<long>(mesh.vertex_count()) - static_cast<long>(edges_of(mesh).size()) +
         static_cast<long>(mesh.triangles.size());
}

inline Vector<3> normal(const AnyMesh& mesh, std::size_t t) {
  const auto& corners = mesh.triangles.vertices[t];
  return facet_normal({at(mesh, corners[0]), at(mesh, corners[1]), at(mesh, corners[2])});
}

inline std::map<std::int32_t, double> areas(const AnyMesh& mesh) {
  std::map<std::int32_t, double> area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area[mesh.triangles.reference[t]] += norm(normal(mesh, t)) / 2;
  return area;
}

inline double volume(const AnyMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    sum += dot(at(mesh, mesh.triangles.vertices[t][0]), normal(mesh, t)) / 6;
  return sum;
}

inline const runtime::Executor& two() {
  static const runtime::Executor executor({.threads = 2});
  return executor;
}

inline AdaptOptions within(double tolerance) {
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  return options;
}

}  // namespace ductile::meshadapt::surface_support
