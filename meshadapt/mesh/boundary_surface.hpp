/// @file
/// BoundarySurface: the facets around the regions of a mesh as a surface of its own, in 2D curves:
/// which of them hang together at which of their joints, which are edges, in 2D vertices. Where not
/// two but more facets of one region have a joint, the surface meets itself: the joint is
/// non-manifold.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A facet of a region that has no other element of it on its other side.
template <int Dim>
struct BoundarySide {
  Facet<Dim> corners;    ///< ascending
  std::uint32_t region;  ///< the number of its element's
  friend auto operator<=>(const BoundarySide&, const BoundarySide&) = default;
};

/// Where sides of one region meet.
struct BoundaryJoint {
  std::uint64_t key;     ///< the ends of an edge, the lower in the upper half; in 2D the vertex
  std::uint32_t region;  ///< of the side
  std::uint32_t side;
  std::uint32_t number;  ///< among the side's: that of the corner which it has not
  friend auto operator<=>(const BoundaryJoint&, const BoundaryJoint&) = default;
  bool is_at(const BoundaryJoint& other) const {
    return key == other.key && region == other.region;
  }
};

/// Which facets may be on the boundary of a mesh.
enum class BoundaryFrom : std::uint8_t {
  listed_facets,  ///< all boundary facets are listed, or else have corners that others have
  elements        ///< any
};

/// The sides of all regions, sorted. `region_of` numbers them by element; empty: all are of one.
/// Nearly linear in the mesh. Thread safety: one caller; runs on the executor.
template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_of(const runtime::Executor& executor,
                                                 const AnyMesh& mesh, BoundaryFrom from,
                                                 std::span<const std::uint32_t> region_of = {});

/// As above, of those sides whose corners are all marked: 1 in `marked`, [vertex], where others are
/// 0.
template <int Dim>
runtime::UnsetVector<BoundarySide<Dim>> sides_among(
    const runtime::Executor& executor, const AnyMesh& mesh,
    const runtime::UnsetVector<std::uint8_t>& marked,
    std::span<const std::uint32_t> region_of = {});

template <int Dim>
class BoundarySurface {
 public:
  /// Throws std::bad_alloc. Nearly linear in the sides.
  /// Thread safety: one caller; runs on the executor.
  BoundarySurface(const runtime::Executor& executor, runtime::UnsetVector<BoundarySide<Dim>> sides);

  std::size_t size() const { return sides_.size(); }
  const BoundarySide<Dim>& side(std::size_t i) const { return sides_[i]; }

  /// A vertex of a side's region: its number in the upper half.
  using Vertex = std::uint64_t;
  std::size_t vertex_count() const { return vertices_.size(); }
  VertexId vertex(std::size_t i) const { return static_cast<VertexId>(vertices_[i] >> 32U); }
  std::uint32_t region_of_vertex(std::size_t i) const {
    return static_cast<std::uint32_t>(vertices_[i]);
  }

  /// Calls visit(joints) for the joints of sides that meet at one place, place by place.
  void each_meeting(auto&& visit) const {
    for (std::size_t begin = 0, end = 0; begin < joints_.size(); begin = end) {
      end = end_of_run(begin);
      visit(std::span(joints_).subspan(begin, end - begin));
    }
  }

  /// The lowest vertex with which one is connected, by sides that have vertices in common.
  std::uint32_t part_of_vertex(std::size_t i) {
    return parts_.lowest(static_cast<std::uint32_t>(i));
  }
  std::uint32_t part_of_side(std::size_t i) { return part_of_vertex(index_of(sides_[i], 0)); }
  /// The lowest side with which one is connected, by joints of two sides.
  std::uint32_t sheet_of_side(std::size_t i) {
    return sheets_.lowest(static_cast<std::uint32_t>(i));
  }
  /// Of those corners of sides (Dim * side + corner) at one vertex that are connected by joints of
  /// two sides, the lowest.
  std::uint32_t fan_of_corner(std::size_t i) { return fans_.lowest(static_cast<std::uint32_t>(i)); }
  /// Of a side's corner.
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
