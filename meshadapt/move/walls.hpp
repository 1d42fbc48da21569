/// @file
/// Walls<Dim>: where vertices of boundaries and interfaces without a displacement may go: along
/// flat ones they slide, elsewhere they stay.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Walls {
 public:
  Walls(const AnyMesh& mesh, const std::vector<Vector<Dim>>& position_of)
      : rank_of_(mesh.vertex_count(), 0), wall_of_(mesh.vertex_count(), none) {
    const auto& facets = facets_in<Dim>(mesh);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      std::array<Vector<Dim>, Dim> point;
      for (std::size_t i = 0; i < Dim; ++i) point[i] = position_of[facets.vertices[f][i]];
      const Vector<Dim> normal = facet_normal(point);
      for (const VertexId v : facets.vertices[f])
        add(v, 1 / norm(normal) * normal, facets.reference[f]);
    }
    if constexpr (Dim == 3) stop_on_edges(mesh);
    for (const std::uint32_t v : mesh.corners) stop(v);
    for (const std::uint32_t v : mesh.required_vertices) stop(v);
    stop_all(mesh.edges.vertices, mesh.required_edges);
    stop_all(mesh.triangles.vertices, mesh.required_triangles);
    stop_all(mesh.tetrahedra.vertices, mesh.required_tetrahedra);
  }

  bool may_move(VertexId v) const { return rank_of_[v] < Dim; }

  /// The part of a displacement that keeps the vertex in its walls.
  Vector<Dim> allowed(VertexId v, Vector<Dim> d) const {
    for (int i = 0; i < rank_of_[v]; ++i) {
      const Vector<Dim>& normal = walls_[wall_of_[v]].normal[static_cast<std::size_t>(i)];
      d -= dot(d, normal) * normal;
    }
    return d;
  }

 private:
  /// The walls of a vertex: orthonormal vectors that span their normals, and what they are.
  struct Wall {
    std::array<Vector<Dim>, Dim> normal, plane;
    std::array<std::int32_t, Dim> reference;
  };

  void stop(VertexId v) { rank_of_[v] = Dim; }
  void stop_all(const auto& cells, const std::vector<std::uint32_t>& indices) {
    for (const std::uint32_t i : indices)
      for (const VertexId v : cells[i]) stop(v);
  }

  /// A vertex stays where more planes meet than leave it a direction, or a plane has two
  /// references.
  void add(VertexId v, const Vector<Dim>& normal, std::int32_t reference) {
    constexpr double same = 1e-10;
    if (!may_move(v)) return;
    if (wall_of_[v] == none) {
      wall_of_[v] = static_cast<std::uint32_t>(walls_.size());
      walls_.emplace_back();
    }
    Wall& wall = walls_[wall_of_[v]];
    const auto rank = static_cast<std::size_t>(rank_of_[v]);
    for (std::size_t i = 0; i < rank; ++i) {
      const Vector<Dim> off = normal - dot(normal, wall.plane[i]) * wall.plane[i];
      if (norm(off) > same) continue;
      if (wall.reference[i] != reference) stop(v);
      return;
    }
    const Vector<Dim> off = allowed(v, normal);
    if (rank + 1 == Dim || norm(off) < 1e-6) return stop(v);
    wall.normal[rank] = 1 / norm(off) * off;
    wall.plane[rank] = normal;
    wall.reference[rank] = reference;
    ++rank_of_[v];
  }

  /// Along a listed edge between two flat walls vertices slide if two edges of one reference meet.
  void stop_on_edges(const AnyMesh& mesh) {
    std::vector<std::uint8_t> count_of(mesh.vertex_count(), 0);
    std::vector<std::int32_t> reference_of(mesh.vertex_count());
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      for (const VertexId v : mesh.edges.vertices[e]) {
        const bool fits = count_of[v] == 0 || reference_of[v] == mesh.edges.reference[e];
        count_of[v] = fits && count_of[v] < 3 ? count_of[v] + 1 : 3;
        reference_of[v] = mesh.edges.reference[e];
      }
    for (std::size_t v = 0; v < count_of.size(); ++v)
      if (count_of[v] != 0 && (count_of[v] != 2 || rank_of_[v] != 2))
        stop(static_cast<VertexId>(v));
  }

  std::vector<std::uint8_t> rank_of_;   // [vertex], dimensions that walls take away
  std::vector<std::uint32_t> wall_of_;  // [vertex], or none
  std::vector<Wall> walls_;
};

}  // namespace ductile::meshadapt
