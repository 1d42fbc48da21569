/// @file
/// Mesh<Dim>: a mesh while it is being adapted; Mesh<2, 3> is a surface, of triangles in space.
/// Elements know their corners, vertices know their elements, and element neighbours are found by
/// intersecting two such lists. Boundary facets and internal interfaces are not stored apart: an
/// element's facet carries the number of the patch it lies on, so every change of a cavity carries
/// its boundary along.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "core/instructions.hpp"
#include "core/quality.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/growing_array.hpp"
#include "mesh/list_pool.hpp"

namespace ductile::meshadapt {

using runtime::GrowingArray;

/// Number of a patch of facets or of a curve of edges; 0 is none.
using PatchId = std::uint32_t;
using CurveId = std::uint32_t;

/// A maximal flat set of facets with the same properties below: part of the boundary or of an
/// interface between regions. In 2D, a straight chain of edges. A smooth one may bend, and may be
/// replaced by a nearby one (MakeMeshOptions::hausdorff_tolerance).
template <int Dim>
struct Patch {
  Vector<Dim> normal;  ///< unit length; unused if smooth
  std::int32_t reference = 0;
  bool listed = true;     ///< was in the file, and is written
  bool required = false;  ///< its facets may not change
  bool ridge = false;     ///< 2D: its edges were listed as ridges
  bool smooth = false;
  bool crack_side = false;  ///< the other side of a crack, with the same rims, is another patch
  std::uint32_t sheet = 0;  ///< its number in Mesh::surface
};

/// A maximal straight chain of edges in 3D, between patches or listed in the file. A smooth one may
/// bend.
struct Curve {
  Vector<3> direction;  ///< unit length; unused if smooth
  std::int32_t reference = 0;
  bool listed = false;
  bool required = false;
  bool ridge = false;
  bool smooth = false;
  bool crack_side = false;  ///< of a surface: another curve has the same ends
  std::uint32_t sheet = 0;  ///< its number in Mesh::surface, if smooth
};

/// One neighbour of a vertex along a curve.
struct CurveLink {
  VertexId to = none;
  CurveId curve = 0;
  friend auto operator<=>(const CurveLink&, const CurveLink&) = default;
};

/// The element across each facet, or none: [element][facet].
template <int Dim>
using Neighbours = GrowingArray<std::array<ElementId, Dim + 1>>;

/// The freedom of a vertex. `class_dimension` is the dimension of the geometric entity in which it
/// may move: 0 never moves and is never removed (corner or required), 1 moves along a curve, 2 in a
/// patch or, in 2D, anywhere, 3 anywhere.
struct VertexKind {
  std::uint8_t class_dimension = 0;
  bool corner = false;    ///< listed as a corner
  bool required = false;  ///< listed as required
  friend bool operator==(const VertexKind&, const VertexKind&) = default;
};

/// An element reference, and whether its elements are required.
struct Region {
  std::int32_t reference = 0;
  bool required = false;
};

/// The model of smooth patches and curves; see geometry/surface.hpp.
template <int Dim>
struct Surface;

/// The precision in which coordinates were written; see geometry/rounding.hpp.
template <int Dim>
struct Rounding;

/// What facets of a mesh may lie on: patches; the edges of triangles in space lie on curves.
template <int Dim, int Space>
using FacetPatch = std::conditional_t<Dim == Space, Patch<Dim>, Curve>;

/// What elements lie in: regions; triangles in space lie on the patches of their surface, of which
/// entry 0 stands for none.
template <int Dim, int Space>
using ElementRegion = std::conditional_t<Dim == Space, Region, Patch<Space>>;

/// A mesh while it is being adapted; see the top of this file.
template <int Dim, int Space = Dim>
struct Mesh {
  // ---- Elements; deleted if the first corner is none ----
  GrowingArray<Corners<Dim>> corners_of;                  // [element], positively oriented
  GrowingArray<std::array<PatchId, Dim + 1>> patches_of;  // [element][facet], 0 inside
  GrowingArray<std::uint32_t> region_of;                  // [element], index into regions
  // [element]. Cached quality; may differ from quality() in the last bits, because kernels store
  // the value that they computed while planning.
  GrowingArray<float> quality_of;
  GrowingArray<std::uint32_t> changed_at;  // [element], epoch of its last change
  std::uint32_t epoch = 1;                 ///< changes are marked with it; a scan ends an epoch

  // ---- Vertices; deleted if there are no elements ----
  GrowingArray<Site<Space>> site_of;        // [vertex]
  GrowingArray<VertexKind> kind_of;         // [vertex]
  GrowingArray<std::uint32_t> entity_of;    // [vertex], its patch or curve, or 0
  GrowingArray<std::int32_t> reference_of;  // [vertex]
  GrowingArray<ElementId> host_of;          // [vertex], background element that contains it
  ListPool<ElementId> elements_of;          // [vertex], sorted
  ListPool<CurveLink> links_of;             // [vertex], tetrahedra only

  // ---- Geometry; entry 0 stands for none ----
  std::vector<FacetPatch<Dim, Space>> patches;
  std::vector<Curve> curves;
  std::vector<ElementRegion<Dim, Space>> regions;
  std::shared_ptr<const Surface<Space>> surface;  ///< null if no patch or curve is smooth
  /// Null unless a patch is flat, or a curve straight, only up to the precision of its coordinates.
  std::shared_ptr<const Rounding<Space>> rounding;

  std::size_t element_slots() const { return corners_of.size(); }
  std::size_t vertex_slots() const { return site_of.size(); }
  bool alive(ElementId element) const { return corners_of[element][0] != none; }
  bool vertex_alive(VertexId vertex) const { return !elements_of.empty(vertex); }

  /// Pointers to the sites of an element's corners, for the quality functions.
  std::array<const Site<Space>*, Dim + 1> sites(const Corners<Dim>& corners) const {
    std::array<const Site<Space>*, Dim + 1> result;
    for (std::size_t i = 0; i < corners.size(); ++i) result[i] = &site_of[corners[i]];
    return result;
  }
  double length(VertexId a, VertexId b) const { return edge_length(site_of[a], site_of[b]); }
  double quality_at(const Corners<Dim>& corners) const { return quality<Dim>(sites(corners)); }

  bool required_element(ElementId element) const { return regions[region_of[element]].required; }

  /// The curve that the edge a-b belongs to, or 0. 3D only.
  CurveId curve_of(VertexId a, VertexId b) const {
    if (kind_of[a].class_dimension > 1 || kind_of[b].class_dimension > 1) return 0;
    for (const CurveLink& link : links_of.of(a))
      if (link.to == b) return link.curve;
    return 0;
  }

  /// A vertex with more elements than this does not move; its edges can still be split.
  static constexpr std::size_t largest_ball = 512;

  Instructions instructions = best_instructions();  ///< for kernels; tests compare them

  /// Makes room for this many vertices and elements; set the new ones before anything else reads
  /// the mesh. Thread safety: one caller; runs on the executor.
  void grow(const runtime::Executor& executor, std::size_t vertices, std::size_t elements);
};

/// Spare room in a vertex's list of elements when it is made.
template <int Dim>
inline constexpr std::uint32_t list_slack = Dim == 2 ? 2 : 10;

/// Number of vertices whose lists are made together.
inline constexpr std::uint32_t list_block = 64;

/// Rebuilds elements_of from corners_of. Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
void rebuild_elements_of(const runtime::Executor& executor, Mesh<Dim, Space>& mesh);

/// Recomputes quality_of. Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
void update_qualities(const runtime::Executor& executor, Mesh<Dim, Space>& mesh);

/// Removes deleted entities and renumbers the others along a space-filling curve, so that
/// neighbours in space are close in memory. Rebuilds elements_of: on entry lists may be out of
/// date, but an empty list must still mean a deleted vertex; vertices from `unlisted` on count as
/// existing. The result does not depend on the number of threads.
template <int Dim, int Space>
void renumber(const runtime::Executor& executor, Mesh<Dim, Space>& mesh, VertexId unlisted = none);

/// The same, also for the neighbours of its elements. Nothing may be deleted.
template <int Dim, int Space>
void renumber(const runtime::Executor& executor, Mesh<Dim, Space>& mesh,
              Neighbours<Dim>& neighbours);

/// Marks the vertices of elements that changed after this epoch.
template <int Dim, int Space>
runtime::UnsetVector<std::uint8_t> mark_changed(const runtime::Executor& executor,
                                                const Mesh<Dim, Space>& mesh, std::uint32_t after);

/// Starts to bring a vertex's site into the cache. Always inlined: GCC 12 drops calls of functions
/// that only prefetch.
template <int Dim, int Space>
[[gnu::always_inline]] inline void prefetch_site(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  const auto* const site = reinterpret_cast<const char*>(&mesh.site_of[vertex]);
  __builtin_prefetch(site);
  __builtin_prefetch(site + sizeof(Site<Space>) - 1);
}

/// Starts to bring the ball of a vertex into the cache, in stages that build on each other: 2, its
/// list of elements; 1, those elements; 0, the sites of their corners. Let some time pass between
/// stages. Reads only.
template <int Dim, int Space>
void prefetch_ball(const Mesh<Dim, Space>& mesh, VertexId vertex, int stage) {
  if (stage == 2) return mesh.elements_of.prefetch(vertex);
  for (const ElementId e : mesh.elements_of.of(vertex)) {
    if (stage == 1) {
      __builtin_prefetch(&mesh.corners_of[e]);
      __builtin_prefetch(&mesh.patches_of[e]);
      __builtin_prefetch(&mesh.quality_of[e]);
      continue;
    }
    for (const VertexId v : mesh.corners_of[e]) prefetch_site(mesh, v);
  }
}

/// The same for the elements around the edge a-b: 2, the lists of both ends; 1, the corners of the
/// elements of the shorter one. There is no stage 0.
template <int Dim, int Space>
[[gnu::always_inline]] inline void prefetch_shell(const Mesh<Dim, Space>& mesh, VertexId a,
                                                  VertexId b, int stage) {
  if (stage == 2) {
    mesh.elements_of.prefetch(a);
    mesh.elements_of.prefetch(b);
  }
  if (stage != 1) return;
  const auto of_a = mesh.elements_of.of(a), of_b = mesh.elements_of.of(b);
  for (const ElementId e : of_b.size() < of_a.size() ? of_b : of_a)
    __builtin_prefetch(&mesh.corners_of[e]);
}

/// Visits the elements around the edge a-b in order: those in the shorter of the two lists that
/// have the other vertex. They are collected branch-free first, because branches would be
/// unpredictable.
template <int Dim, int Space>
void visit_shell(const Mesh<Dim, Space>& mesh, VertexId a, VertexId b, auto&& visit) {
  const auto of_a = mesh.elements_of.of(a), of_b = mesh.elements_of.of(b);
  const bool fewer = of_b.size() < of_a.size();
  const auto ball = fewer ? of_b : of_a;
  const VertexId other = fewer ? a : b;
  std::array<ElementId, 64> around;
  for (std::size_t begin = 0; begin < ball.size(); begin += around.size()) {
    std::size_t count = 0;
    for (const ElementId e : ball.subspan(begin, std::min(around.size(), ball.size() - begin))) {
      bool found = false;
      for (const VertexId v : mesh.corners_of[e]) found |= v == other;
      around[count] = e;
      count += found;
    }
    for (std::size_t i = 0; i < count; ++i) visit(around[i]);
  }
}

/// The elements around the edge a-b, in order. Buffer is any vector-like type.
template <int Dim, int Space, class Buffer>
void shell_of(const Mesh<Dim, Space>& mesh, VertexId a, VertexId b, Buffer& shell) {
  shell.clear();
  visit_shell(mesh, a, b, [&](ElementId element) { shell.push_back(element); });
}

/// Among the elements around a facet's first corner, the one besides `element` that has all
/// corners, or none.
template <int Dim, int Space>
ElementId sharer_of(const Mesh<Dim, Space>& mesh, std::span<const ElementId> around,
                    ElementId element, const Facet<Dim>& corners) {
  for (const ElementId other : around) {
    if (other == element) continue;
    bool all = true;
    for (std::size_t i = 1; i < corners.size(); ++i)
      all = all && contains(mesh.corners_of[other], corners[i]);
    if (all) return other;
  }
  return none;
}

/// The element on the other side of an element's facet, or none on the boundary.
template <int Dim, int Space>
ElementId neighbour(const Mesh<Dim, Space>& mesh, ElementId element, int facet) {
  const Facet<Dim> corners = facet_of<Dim>(mesh.corners_of[element], facet);
  return sharer_of<Dim>(mesh, mesh.elements_of.of(corners[0]), element, corners);
}

extern template struct Mesh<2>;
extern template struct Mesh<2, 3>;
extern template struct Mesh<3>;

}  // namespace ductile::meshadapt
