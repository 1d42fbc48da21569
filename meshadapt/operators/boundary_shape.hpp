/// @file
/// Whether what an operator would do leaves boundaries, curves and surfaces in their places.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/determinant.hpp"
#include "geometry/surface.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// May the vertex only move along a curve that bends?
template <int Dim, int Space>
bool on_smooth_curve(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  return Dim == 3 && mesh.kind_of[vertex].class_dimension == 1 &&
         mesh.curves[mesh.entity_of[vertex]].smooth;
}

/// May the vertex only move in a patch that bends?
template <int Dim, int Space>
bool on_smooth_patch(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  return mesh.kind_of[vertex].class_dimension == Dim - 1 &&
         mesh.patches[mesh.entity_of[vertex]].smooth;
}

/// May a vertex of a surface move only in a patch that bends, inside of it?
template <int Dim, int Space>
bool in_smooth_patch(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  if constexpr (Dim == Space)
    return false;
  else
    return mesh.kind_of[vertex].class_dimension == Dim &&
           mesh.regions[mesh.region_of[mesh.elements_of.of(vertex)[0]]].smooth;
}

/// The corners of an element if one of them were at another place.
template <int Dim, int Space>
std::array<Vector<Space>, Dim + 1> corners_with(const Mesh<Dim, Space>& mesh, ElementId element,
                                                VertexId vertex, const Vector<Space>& position) {
  std::array<Vector<Space>, Dim + 1> corner;
  for (std::size_t i = 0; i <= Dim; ++i) {
    const VertexId v = mesh.corners_of[element][i];
    corner[i] = v == vertex ? position : mesh.site_of[v].position;
  }
  return corner;
}

/// Is a triangle of a surface turned as its patch is, if that is flat, or close to it all over?
inline bool is_on_patch(const Mesh<2, 3>& mesh, const std::array<Vector<3>, 3>& triangle,
                        std::uint32_t region) {
  const Patch<3>& patch = mesh.regions[region];
  return patch.smooth ? mesh.surface->facets.cover(triangle, patch.sheet)
                      : dot(facet_normal(triangle), patch.normal) > 0;
}

/// Do a triangle of a surface, and its edges on smooth curves, stay close to what was there in the
/// input if one of its corners moves? A flat one is looked at where it ends at a smooth curve.
inline bool keeps_surface(const Mesh<2, 3>& mesh, ElementId element, VertexId vertex,
                          const Vector<3>& position) {
  if (!mesh.surface) return true;
  const auto corner = corners_with(mesh, element, vertex, position);
  for (std::size_t i = 0; i < 3; ++i) {
    const Curve& curve = mesh.patches[mesh.patches_of[element][i]];
    if (!curve.smooth || mesh.corners_of[element][i] == vertex) continue;
    if (!mesh.surface->edges.cover({corner[(i + 1) % 3], corner[(i + 2) % 3]}, curve.sheet))
      return false;
  }
  const Patch<3>& patch = mesh.regions[mesh.region_of[element]];
  return !(patch.smooth || on_smooth_patch(mesh, vertex)) ||
         mesh.surface->facets.cover(corner, patch.sheet);
}

/// Does a triangle on a flat patch of a surface keep its turn if one of its corners moves?
inline bool keeps_facets_turned(const Mesh<2, 3>& mesh, ElementId element, VertexId vertex,
                                const Vector<3>& position) {
  const Patch<3>& patch = mesh.regions[mesh.region_of[element]];
  return patch.smooth ||
         dot(facet_normal(corners_with(mesh, element, vertex, position)), patch.normal) > 0;
}

/// Do the element's facets on smooth patches, and those that end at a smooth curve, stay close to
/// what was there in the input if one of its corners moves?
template <int Dim>
bool keeps_surface(const Mesh<Dim>& mesh, ElementId element, VertexId vertex,
                   const Vector<Dim>& position) {
  if (!mesh.surface) return true;
  const bool at_curve = on_smooth_curve(mesh, vertex);
  for (std::size_t i = 0; i <= Dim; ++i) {
    const PatchId patch = mesh.patches_of[element][i];
    if (patch == 0 || mesh.corners_of[element][i] == vertex) continue;
    if (!mesh.patches[patch].smooth && !at_curve) continue;
    const Facet<Dim> facet = facet_of<Dim>(mesh.corners_of[element], static_cast<int>(i));
    std::array<Vector<Dim>, Dim> after;
    for (std::size_t k = 0; k < Dim; ++k)
      after[k] = facet[k] == vertex ? position : mesh.site_of[facet[k]].position;
    if (!mesh.surface->facets.cover(after, mesh.patches[patch].sheet)) return false;
  }
  return true;
}

/// Do the element's facets on flat patches keep their turn if one of its corners moves? On a patch
/// that is flat only up to rounding, positive volumes alone do not say so.
template <int Dim>
bool keeps_facets_turned(const Mesh<Dim>& mesh, ElementId element, VertexId vertex,
                         const Vector<Dim>& position) {
  for (std::size_t i = 0; i <= Dim; ++i) {
    const PatchId patch = mesh.patches_of[element][i];
    if (patch == 0 || mesh.corners_of[element][i] == vertex || mesh.patches[patch].smooth) continue;
    const Facet<Dim> facet = facet_of<Dim>(mesh.corners_of[element], static_cast<int>(i));
    std::array<Vector<Dim>, Dim> before, after;
    for (std::size_t k = 0; k < Dim; ++k) {
      before[k] = mesh.site_of[facet[k]].position;
      after[k] = facet[k] == vertex ? position : before[k];
    }
    const Vector<Dim>& normal = mesh.patches[patch].normal;
    if (!(dot(facet_normal(before), normal) * dot(facet_normal(after), normal) > 0)) return false;
  }
  return true;
}

/// Does the quadrilateral of two facets on a patch remain unfolded when its diagonal is swapped,
/// and close to a smooth patch? Its corners turn as facets do, seen from outside.
inline bool convex_in_patch(const Mesh<3>& mesh, const std::array<VertexId, 4>& corners,
                            PatchId patch) {
  const auto at = [&](std::size_t i) { return mesh.site_of[corners[i]].position; };
  if (mesh.patches[patch].smooth)
    return mesh.surface->facets.cover({at(0), at(1), at(3)}, mesh.patches[patch].sheet) &&
           mesh.surface->facets.cover({at(1), at(2), at(3)}, mesh.patches[patch].sheet);
  const Vector<3>& normal = mesh.patches[patch].normal;
  return dot(facet_normal({at(0), at(1), at(3)}), normal) *
             dot(facet_normal({at(1), at(2), at(3)}), normal) >
         0;
}

}  // namespace ductile::meshadapt
