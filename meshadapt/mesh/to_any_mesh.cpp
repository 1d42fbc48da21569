#include <algorithm>

#include "ductile/meshadapt/make_mesh.hpp"

namespace ductile::meshadapt {

namespace {

/// A facet is written once, by the element with the lower number.
template <int Dim>
void add_facets(const Mesh<Dim>& mesh, AnyMesh& any) {
  for (ElementId e = 0; e < mesh.element_slots(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const PatchId id = mesh.patches_of[e][static_cast<std::size_t>(i)];
      if (id == 0 || !mesh.patches[id].listed) continue;
      const ElementId other = neighbour(mesh, e, i);
      if (other != none && other < e) continue;
      const Patch<Dim>& patch = mesh.patches[id];
      const Facet<Dim> corners = facet_of<Dim>(mesh.corners_of[e], i);
      if constexpr (Dim == 2) {
        if (patch.ridge) any.ridges.push_back(static_cast<std::uint32_t>(any.edges.size()));
        if (patch.required)
          any.required_edges.push_back(static_cast<std::uint32_t>(any.edges.size()));
        any.edges.add(corners, patch.reference);
      } else {
        if (patch.required)
          any.required_triangles.push_back(static_cast<std::uint32_t>(any.triangles.size()));
        any.triangles.add(corners, patch.reference);
      }
    }
}

void add_curves(const Mesh<3>& mesh, AnyMesh& any) {
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    for (const CurveLink& link : mesh.links_of.of(v)) {
      const Curve& curve = mesh.curves[link.curve];
      if (link.to < v || !curve.listed) continue;
      const auto number = static_cast<std::uint32_t>(any.edges.size());
      if (curve.ridge) any.ridges.push_back(number);
      if (curve.required) any.required_edges.push_back(number);
      any.edges.add({v, link.to}, curve.reference);
    }
}

template <int Dim>
void add_elements(const Mesh<Dim>& mesh, AnyMesh& any) {
  Cells<Dim + 1>& cells = elements_in<Dim>(any);
  auto& required = Dim == 2 ? any.required_triangles : any.required_tetrahedra;
  cells.vertices = mesh.corners_of;
  cells.reference.resize(mesh.element_slots());
  for (ElementId e = 0; e < mesh.element_slots(); ++e) {
    cells.reference[e] = mesh.regions[mesh.region_of[e]].reference;
    if (mesh.required_element(e)) required.push_back(e);
  }
}

}  // namespace

template <int Dim>
AnyMesh to_any_mesh(const Mesh<Dim>& mesh) {
  AnyMesh any;
  any.dimension = Dim;
  any.vertex_reference = mesh.reference_of;
  any.coordinates.resize(mesh.vertex_slots() * Dim);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    std::copy_n(mesh.site_of[v].position.x.begin(), Dim, &any.coordinates[std::size_t{v} * Dim]);
    if (mesh.kind_of[v].corner) any.corners.push_back(v);
    if (mesh.kind_of[v].required) any.required_vertices.push_back(v);
  }
  add_elements(mesh, any);
  add_facets(mesh, any);
  if constexpr (Dim == 3) add_curves(mesh, any);
  return any;
}

template <int Dim>
AnyField to_any_field(const Mesh<Dim>& mesh) {
  AnyField field;
  field.dimension = Dim;
  field.vertex_count = mesh.vertex_slots();
  field.types = {AnyField::Type::symmetric};
  field.values.resize(mesh.vertex_slots() * Metric<Dim>::size);
  for (std::size_t v = 0; v < mesh.vertex_slots(); ++v)
    std::copy_n(mesh.site_of[v].metric.m.begin(), Metric<Dim>::size,
                &field.values[v * Metric<Dim>::size]);
  return field;
}

template AnyMesh to_any_mesh(const Mesh<2>&);
template AnyMesh to_any_mesh(const Mesh<3>&);
template AnyField to_any_field(const Mesh<2>&);
template AnyField to_any_field(const Mesh<3>&);

}  // namespace ductile::meshadapt
