/// @file
/// A mesh as files hold it. What is to be listed is found on all threads and gathered in the order
/// of vertices or elements, so that the lists do not depend on their number.

#include <algorithm>

#include "ductile/meshadapt/make_mesh.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/make_vector.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_collect;
using runtime::parallel_for;
using runtime::resize_empty;

namespace {

template <int Dim>
struct ListedFacet {
  Facet<Dim> corners;
  PatchId patch;
};

/// A facet is written once, by the element with the lower number.
template <int Dim>
void add_facets(const Executor& executor, const Mesh<Dim>& mesh, AnyMesh& any) {
  const auto facets = parallel_collect<ListedFacet<Dim>>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        for (int i = 0; i <= Dim; ++i) {
          const PatchId id = mesh.patches_of[e][static_cast<std::size_t>(i)];
          if (id == 0 || !mesh.patches[id].listed) continue;
          const ElementId other = neighbour(mesh, element, i);
          if (other != none && other < element) continue;
          append({facet_of<Dim>(mesh.corners_of[e], i), id});
        }
      });
  for (const ListedFacet<Dim>& facet : facets) {
    const Patch<Dim>& patch = mesh.patches[facet.patch];
    if constexpr (Dim == 2) {
      const auto number = static_cast<std::uint32_t>(any.edges.size());
      if (patch.ridge) any.ridges.push_back(number);
      if (patch.required) any.required_edges.push_back(number);
      any.edges.add(facet.corners, patch.reference);
    } else {
      const auto number = static_cast<std::uint32_t>(any.triangles.size());
      if (patch.required) any.required_triangles.push_back(number);
      any.triangles.add(facet.corners, patch.reference);
    }
  }
}

void add_curves(const Executor& executor, const Mesh<3>& mesh, AnyMesh& any) {
  struct Edge {
    VertexId from, to;
    CurveId curve;
  };
  const auto edges =
      parallel_collect<Edge>(executor, mesh.vertex_slots(), [&](std::size_t v, auto&& append) {
        const auto vertex = static_cast<VertexId>(v);
        for (const CurveLink& link : mesh.links_of.of(vertex))
          if (link.to >= vertex && mesh.curves[link.curve].listed)
            append({vertex, link.to, link.curve});
      });
  for (const Edge& edge : edges) {
    const Curve& curve = mesh.curves[edge.curve];
    const auto number = static_cast<std::uint32_t>(any.edges.size());
    if (curve.ridge) any.ridges.push_back(number);
    if (curve.required) any.required_edges.push_back(number);
    any.edges.add({edge.from, edge.to}, curve.reference);
  }
}

/// The numbers below n that something holds of, in order.
template <class Holds>
std::vector<std::uint32_t> numbers_of(const Executor& executor, std::size_t n, Holds&& holds) {
  return parallel_collect<std::uint32_t>(executor, n, [&](std::size_t i, auto&& append) {
    if (holds(i)) append(static_cast<std::uint32_t>(i));
  });
}

template <int Dim>
void add_vertices(const Executor& executor, const Mesh<Dim>& mesh, AnyMesh& any) {
  resize_empty(executor, any.vertex_reference, mesh.vertex_slots());
  resize_empty(executor, any.coordinates, mesh.vertex_slots() * Dim);
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    any.vertex_reference[v] = mesh.reference_of[v];
    std::copy_n(mesh.site_of[v].position.x.begin(), Dim, &any.coordinates[v * Dim]);
  });
  any.corners = numbers_of(executor, mesh.vertex_slots(),
                           [&](std::size_t v) { return mesh.kind_of[v].corner; });
  any.required_vertices = numbers_of(executor, mesh.vertex_slots(),
                                     [&](std::size_t v) { return mesh.kind_of[v].required; });
}

template <int Dim>
void add_elements(const Executor& executor, const Mesh<Dim>& mesh, AnyMesh& any) {
  Cells<Dim + 1>& cells = elements_in<Dim>(any);
  resize_empty(executor, cells.vertices, mesh.element_slots());
  resize_empty(executor, cells.reference, mesh.element_slots());
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    cells.vertices[e] = mesh.corners_of[e];
    cells.reference[e] = mesh.regions[mesh.region_of[e]].reference;
  });
  auto& required = Dim == 2 ? any.required_triangles : any.required_tetrahedra;
  required = numbers_of(executor, mesh.element_slots(), [&](std::size_t e) {
    return mesh.required_element(static_cast<ElementId>(e));
  });
}

}  // namespace

template <int Dim>
AnyMesh to_any_mesh(const Executor& executor, const Mesh<Dim>& mesh) {
  AnyMesh any;
  any.dimension = Dim;
  add_vertices(executor, mesh, any);
  add_elements(executor, mesh, any);
  add_facets(executor, mesh, any);
  if constexpr (Dim == 3) add_curves(executor, mesh, any);
  return any;
}

template <int Dim>
AnyField to_any_field(const Executor& executor, const Mesh<Dim>& mesh) {
  AnyField field;
  field.dimension = Dim;
  field.vertex_count = mesh.vertex_slots();
  field.types = {AnyField::Type::symmetric};
  resize_empty(executor, field.values, mesh.vertex_slots() * Metric<Dim>::size);
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    std::copy_n(mesh.site_of[v].metric.m.begin(), Metric<Dim>::size,
                &field.values[v * Metric<Dim>::size]);
  });
  return field;
}

template <int Dim>
MeshWithMetric take_apart(const Executor& executor, Mesh<Dim> mesh) {
  const auto release = [&](auto&... arrays) { (arrays.release(executor), ...); };
  release(mesh.shape_of, mesh.changed_at, mesh.host_of, mesh.entity_of);
  MeshWithMetric result;
  result.mesh.dimension = Dim;
  add_facets(executor, mesh, result.mesh);
  if constexpr (Dim == 3) add_curves(executor, mesh, result.mesh);
  release(mesh.elements_of, mesh.links_of, mesh.patches_of);
  add_elements(executor, mesh, result.mesh);
  release(mesh.corners_of, mesh.region_of);
  add_vertices(executor, mesh, result.mesh);
  result.metric = to_any_field(executor, mesh);
  release(mesh.site_of, mesh.kind_of, mesh.reference_of);
  return result;
}

template AnyMesh to_any_mesh(const Executor&, const Mesh<2>&);
template AnyMesh to_any_mesh(const Executor&, const Mesh<3>&);
template AnyField to_any_field(const Executor&, const Mesh<2>&);
template AnyField to_any_field(const Executor&, const Mesh<3>&);
template MeshWithMetric take_apart(const Executor&, Mesh<2>);
template MeshWithMetric take_apart(const Executor&, Mesh<3>);

}  // namespace ductile::meshadapt
