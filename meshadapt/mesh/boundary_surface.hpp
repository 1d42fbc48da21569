/// @file
/// BoundarySurface: connectivity of the boundary facets of regions across shared joints: edges, in
/// 2D vertices. If more than two facets of one region share a joint, the surface touches itself:
/// the joint is non-manifold.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

/// A facet of a region with no element of that region on its other side.
template <int Dim>
struct BoundarySide {
  Facet<Dim> corners;    ///< ascending
  std::uint32_t region;  ///< number of its element's region
  friend auto operator<=>(const BoundarySide&, const BoundarySide&) = default;
};

/// A place where sides of one region meet.
struct BoundaryJoint {
  std::uint64_t key;     ///< the ends of an edge, the lower in the upper half; in 2D, the vertex
  std::uint32_t region;  ///< of the side
  std::uint32_t side;
  std::uint32_t number;  ///< within the side: the number of the opposite corner
  friend auto operator<=>(const BoundaryJoint&, const BoundaryJoint&) = default;
  bool is_at(const BoundaryJoint& other) const {
    return key == other.key && region == other.region;
  }
};

/// The sides of all regions, sorted. `region_of` gives the region of each element; empty: there is
/// one. Nearly linear in the mesh. Thread safety: one caller; runs on the executor.
template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_of(const runtime::Executor& executor,
                                                 const Adjacency<Dim>& adjacency,
                                                 std::span<const std::uint32_t> region_of = {});

/// The same; those of a surface alone are its triangles.
template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_in(const AdjacentMesh& mesh,
                                                 std::span<const std::uint32_t> region_of = {});

template <int Dim>
class BoundarySurface {
 public:
  /// Throws std::bad_alloc. Nearly linear in the sides.
  /// Thread safety: one caller; runs on the executor.
  BoundarySurface(const runtime::Executor& executor, runtime::UnsetVector<BoundarySide<Dim>> sides);

  std::size_t size() const { return sides_.size(); }
  const BoundarySide<Dim>& side(std::size_t i) const { return sides_[i]; }

  /// A vertex of a side's region: its number is in the upper half.
  using Vertex = std::uint64_t;
  std::size_t vertex_count() const { return vertices_.size(); }
  VertexId vertex(std::size_t i) const { return static_cast<VertexId>(vertices_[i] >> 32U); }
  std::uint32_t region_of_vertex(std::size_t i) const {
    return static_cast<std::uint32_t>(vertices_[i]);
  }

  /// Calls visit(joints) once for each place, with the joints there.
  void each_meeting(auto&& visit) const {
    for (std::size_t begin = 0, end = 0; begin < joints_.size(); begin = end) {
      end = end_of_run(begin);
      visit(std::span(joints_).subspan(begin, end - begin));
    }
  }

  /// The lowest vertex connected to this one by sides that share vertices.
  std::uint32_t part_of_vertex(std::size_t i) {
    return parts_.lowest(static_cast<std::uint32_t>(i));
  }
  std::uint32_t part_of_side(std::size_t i) { return part_of_vertex(index_of(sides_[i], 0)); }
  /// The lowest side connected to this one by joints of two sides.
  std::uint32_t sheet_of_side(std::size_t i) {
    return sheets_.lowest(static_cast<std::uint32_t>(i));
  }
  /// The lowest corner (Dim * side + corner) at the same vertex that is connected to this one by
  /// joints of two sides.
  std::uint32_t fan_of_corner(std::size_t i) { return fans_.lowest(static_cast<std::uint32_t>(i)); }
  /// Index of a side's corner among the vertices.
  std::size_t index_of(const BoundarySide<Dim>& side, std::size_t corner) const;

 private:
  void find_vertices(const runtime::Executor& executor);
  void find_joints(const runtime::Executor& executor);
  void connect(const runtime::Executor& executor);
  void connect(const BoundaryJoint& one, const BoundaryJoint& other);
  std::size_t end_of_run(std::size_t begin) const {
    std::size_t end = begin + 1;
    while (end < joints_.size() && joints_[end].is_at(joints_[begin])) ++end;
    return end;
  }

  runtime::UnsetVector<BoundarySide<Dim>> sides_;
  runtime::UnsetVector<Vertex> vertices_;       // sorted
  runtime::UnsetVector<BoundaryJoint> joints_;  // sorted
  runtime::DisjointSets parts_, sheets_, fans_;
};

extern template class BoundarySurface<2>;
extern template class BoundarySurface<3>;

}  // namespace ductile::meshadapt
