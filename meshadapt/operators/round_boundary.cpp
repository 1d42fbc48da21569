#include "operators/round_boundary.hpp"

#include <algorithm>
#include <utility>

#include "ductile/meshadapt/simplex.hpp"
#include "geometry/rounding.hpp"
#include "geometry/surface.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

namespace {

/// Does it keep the elements around it, nearly as good, and its patches, at a place?
template <int Dim>
bool may_be_at(Mesh<Dim>& mesh, VertexId vertex, const Vector<Dim>& place) {
  const auto around = mesh.elements_of.of(vertex);
  const auto keeps = [&](ElementId e) {
    return keeps_facets_turned(mesh, e, vertex, place) && keeps_surface(mesh, e, vertex, place);
  };
  if (!std::all_of(around.begin(), around.end(), keeps)) return false;
  const Vector<Dim> before = std::exchange(mesh.site_of[vertex].position, place);
  const auto is_good = [&](ElementId e) {
    std::array<Vector<Dim>, Dim + 1> corner;
    for (std::size_t i = 0; i < corner.size(); ++i)
      corner[i] = mesh.site_of[mesh.corners_of[e][i]].position;
    return certain_determinant<Dim>(corner) > 0 &&
           mesh.quality_at(mesh.corners_of[e]) > 0.7 * mesh.quality_of[e];
  };
  const bool all = std::all_of(around.begin(), around.end(), is_good);
  if (!all) mesh.site_of[vertex].position = before;
  return all;
}

}  // namespace

template <int Dim>
void round_boundary(Mesh<Dim>& mesh) {
  if (!mesh.rounding) return;
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    const int class_dimension = mesh.kind_of[v].class_dimension;
    if (!mesh.vertex_alive(v) || class_dimension == 0 || class_dimension == Dim) continue;
    const Vector<Dim> from = mesh.site_of[v].position;
    Vector<Dim> same = from;
    for (double& x : same.x) x = mesh.rounding->precision.rounded(x);
    if (same == from) continue;  // as it was
    const Vector<Dim> place = mesh.rounding->rounded(from, class_dimension, mesh.entity_of[v]);
    if (!may_be_at(mesh, v, place)) continue;
    for (const ElementId e : mesh.elements_of.of(v)) update_element(mesh, e);
  }
}

template void round_boundary(Mesh<2>&);
template void round_boundary(Mesh<3>&);

}  // namespace ductile::meshadapt
