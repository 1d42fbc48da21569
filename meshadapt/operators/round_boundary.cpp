#include "operators/round_boundary.hpp"

#include <algorithm>
#include <utility>

#include "core/determinant.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/rounding.hpp"
#include "geometry/surface.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

namespace {

/// Does it keep the elements around it, nearly as good, and its patches, at a place?
template <int Dim, int Space>
bool may_be_at(Mesh<Dim, Space>& mesh, VertexId vertex, const Vector<Space>& place) {
  const auto around = mesh.elements_of.of(vertex);
  const auto keeps = [&](ElementId e) {
    return keeps_facets_turned(mesh, e, vertex, place) && keeps_surface(mesh, e, vertex, place);
  };
  if (!std::all_of(around.begin(), around.end(), keeps)) return false;
  const Vector<Space> before = std::exchange(mesh.site_of[vertex].position, place);
  const auto is_good = [&](ElementId e) {
    return mesh.quality_at(mesh.corners_of[e]) > 0.7 * mesh.quality_of[e];
  };
  const bool all = std::all_of(around.begin(), around.end(), is_good);
  if (!all) mesh.site_of[vertex].position = before;
  return all;
}

/// The patch or curve that the vertex lies on.
template <int Dim, int Space>
std::uint32_t entity(const Mesh<Dim, Space>& mesh, VertexId v) {
  return mesh.kind_of[v].class_dimension == Dim ? mesh.region_of[mesh.elements_of.of(v)[0]]
                                                : mesh.entity_of[v];
}

}  // namespace

template <int Dim, int Space>
void round_boundary(Mesh<Dim, Space>& mesh) {
  if (!mesh.rounding) return;
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    const int class_dimension = mesh.kind_of[v].class_dimension;
    if (!mesh.vertex_alive(v) || class_dimension == 0 || class_dimension == Space) continue;
    const Vector<Space> from = mesh.site_of[v].position;
    Vector<Space> same = from;
    for (double& x : same.x) x = mesh.rounding->precision.rounded(x);
    if (same == from) continue;  // as it was
    const Vector<Space> place = mesh.rounding->rounded(from, class_dimension, entity(mesh, v));
    if (!may_be_at(mesh, v, place)) continue;
    for (const ElementId e : mesh.elements_of.of(v)) update_element(mesh, e);
  }
}

template void round_boundary(Mesh<2>&);
template void round_boundary(Mesh<2, 3>&);
template void round_boundary(Mesh<3>&);

}  // namespace ductile::meshadapt
