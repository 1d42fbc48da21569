#include "adapt/take_apart.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/growing_array.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/numbering.hpp"
#include "metric/metric_range.hpp"

namespace ductile::meshadapt {

using runtime::EmptyVector;
using runtime::Executor;
using runtime::parallel_collect;
using runtime::parallel_for;

namespace {

/// The numbers i below n for which holds(i) is true, in order.
template <class Holds>
std::vector<std::uint32_t> numbers_of(const Executor& executor, std::size_t n, Holds&& holds) {
  const auto found =
      parallel_collect<std::uint32_t>(executor, n, [&](std::size_t i, auto&& append) {
        if (holds(i)) append(static_cast<std::uint32_t>(i));
      });
  return {found.begin(), found.end()};
}

/// Adds the mesh's edges along curves, and which of them are ridges or required. Vertices get their
/// positions in `vertices` as numbers, which place_of has.
void add_curves(const Executor& executor, const Mesh<3>& mesh, const Ids& vertices,
                const Ids& place_of, AnyMesh& any) {
  struct Edge {
    VertexId from, to;
    CurveId curve;
    auto operator<=>(const Edge&) const = default;
  };
  auto edges = parallel_collect<Edge>(executor, vertices.size(), [&](std::size_t i, auto&& append) {
    const auto from = static_cast<VertexId>(i);
    for (const CurveLink& link : mesh.links_of.of(vertices[i]))
      if (place_of[link.to] >= from && mesh.curves[link.curve].listed)
        append({from, place_of[link.to], link.curve});
  });
  std::sort(edges.begin(), edges.end());  // those of each vertex, as its links have old numbers
  for (const Edge& edge : edges) {
    const Curve& curve = mesh.curves[edge.curve];
    const auto number = static_cast<std::uint32_t>(any.edges.size());
    if (curve.ridge) any.ridges.push_back(number);
    if (curve.required) any.required_edges.push_back(number);
    any.edges.add({edge.from, edge.to}, curve.reference);
  }
}

/// A mesh whose corners have new numbers, while lists are still those of the old vertices.
template <int Dim, int Space>
class RenumberedFacets {
 public:
  RenumberedFacets(const Executor& executor, const Mesh<Dim, Space>& mesh, const Ids& vertices,
                   const Ids& elements)
      : executor_(executor), mesh_(mesh), vertices_(vertices), elements_(elements) {}

  /// A facet is written once, by the element that comes first.
  void add_to(AnyMesh& any) const {
    const auto listed =
        parallel_collect<Listed>(executor_, elements_.size(), [&](std::size_t i, auto&& append) {
          const ElementId element = elements_[i];
          for (int facet = 0; facet <= Dim; ++facet) {
            const PatchId patch = mesh_.patches_of[element][static_cast<std::size_t>(facet)];
            if (patch == 0 || !mesh_.patches[patch].listed) continue;
            const Facet<Dim> corners = facet_of<Dim>(mesh_.corners_of[element], facet);
            if (!is_of_one_before(element, corners)) append({corners, patch});
          }
        });
    for (const Listed& facet : listed) add(any, facet.corners, mesh_.patches[facet.patch]);
  }

 private:
  struct Listed {
    Facet<Dim> corners;
    PatchId patch;
  };

  bool is_of_one_before(ElementId element, const Facet<Dim>& corners) const {
    const auto around = mesh_.elements_of.of(vertices_[corners[0]]);
    return std::any_of(around.begin(), around.end(), [&](ElementId other) {
      return other != element && has_facet<Dim>(mesh_.corners_of[other], corners) &&
             rank_of(other) < rank_of(element);
    });
  }

  /// The order of elements, see renumber_corners().
  std::pair<VertexId, ElementId> rank_of(ElementId element) const {
    const Corners<Dim>& corners = mesh_.corners_of[element];
    return {*std::min_element(corners.begin(), corners.end()), element};
  }

  static void add(AnyMesh& any, const Facet<Dim>& corners, const FacetPatch<Dim, Space>& patch) {
    if constexpr (Dim == 2) {
      const auto number = static_cast<std::uint32_t>(any.edges.size());
      if (patch.ridge) any.ridges.push_back(number);
      if (patch.required) any.required_edges.push_back(number);
      any.edges.add(corners, patch.reference);
    } else {
      const auto number = static_cast<std::uint32_t>(any.triangles.size());
      if (patch.required) any.required_triangles.push_back(number);
      any.triangles.add(corners, patch.reference);
    }
  }

  const Executor& executor_;
  const Mesh<Dim, Space>& mesh_;
  const Ids& vertices_;
  const Ids& elements_;
};

template <int Dim, int Space>
void add_elements(const Executor& executor, const Mesh<Dim, Space>& mesh, const Ids& elements,
                  AnyMesh& any) {
  Cells<Dim + 1>& cells = elements_in<Dim>(any);
  runtime::resize_empty(executor, EmptyVector{cells.vertices, elements.size()},
                        EmptyVector{cells.reference, elements.size()});
  parallel_for(executor, elements.size(), [&](std::size_t i) {
    cells.vertices[i] = mesh.corners_of[elements[i]];
    cells.reference[i] = mesh.regions[mesh.region_of[elements[i]]].reference;
  });
  auto& required = Dim == 2 ? any.required_triangles : any.required_tetrahedra;
  required = numbers_of(executor, elements.size(),
                        [&](std::size_t i) { return mesh.required_element(elements[i]); });
}

/// Vertices with their metric.
template <int Dim, int Space>
void add_vertices(const Executor& executor, const Mesh<Dim, Space>& mesh, const Ids& vertices,
                  MeshWithMetric& result) {
  constexpr std::size_t stride = Metric<Space>::size;
  const std::size_t count = vertices.size();
  AnyMesh& any = result.mesh;
  AnyField& field = result.metric;
  field.dimension = Space;
  field.vertex_count = count;
  field.types = {AnyField::Type::symmetric};
  runtime::resize_empty(executor, EmptyVector{any.vertex_reference, count},
                        EmptyVector{any.coordinates, count * Space},
                        EmptyVector{field.values, count * stride});
  parallel_for(executor, count, [&](std::size_t i) {
    const Site<Space>& site = mesh.site_of[vertices[i]];
    any.vertex_reference[i] = mesh.reference_of[vertices[i]];
    std::copy_n(site.position.x.begin(), Space, &any.coordinates[i * Space]);
    // Rounding may have left the range by a little, so that it could not be read again.
    const Metric<Space> metric = brought_into_range(site.metric);
    std::copy_n(metric.m.begin(), stride, &field.values[i * stride]);
  });
  any.corners = numbers_of(executor, vertices.size(),
                           [&](std::size_t i) { return mesh.kind_of[vertices[i]].corner; });
  any.required_vertices = numbers_of(
      executor, vertices.size(), [&](std::size_t i) { return mesh.kind_of[vertices[i]].required; });
}

/// Gives arrays back as soon as they have been read if the mesh is not needed any more.
template <int Dim, int Space>
MeshWithMetric read_out(const Executor& executor, Mesh<Dim, Space>& mesh, bool is_spent) {
  const auto release = [&](auto&... arrays) {
    if (!is_spent) return;
    runtime::SpentMemory spent;
    (arrays.release(spent), ...);
    spent.give_back(executor);
  };
  release(mesh.quality_of, mesh.changed_at, mesh.host_of, mesh.entity_of);
  MeshWithMetric result;
  result.mesh.dimension = Space;
  const Ids vertices = order_of_vertices(executor, mesh, none);
  const Ids elements = [&] {
    const Ids place_of = places_in(executor, vertices, mesh.vertex_slots());
    if constexpr (Dim == 3) add_curves(executor, mesh, vertices, place_of, result.mesh);
    return renumber_corners(executor, mesh, place_of, vertices.size());
  }();
  RenumberedFacets(executor, mesh, vertices, elements).add_to(result.mesh);
  if (is_spent) {
    mesh.elements_of.release(executor);
    mesh.links_of.release(executor);
  }
  release(mesh.patches_of);
  add_elements(executor, mesh, elements, result.mesh);
  release(mesh.corners_of, mesh.region_of);
  add_vertices(executor, mesh, vertices, result);
  release(mesh.site_of, mesh.kind_of, mesh.reference_of);
  return result;
}

}  // namespace

template <int Dim, int Space>
MeshWithMetric take_apart(const Executor& executor, Mesh<Dim, Space> mesh) {
  return read_out(executor, mesh, true);
}

template <int Dim, int Space>
MeshWithMetric copy_in_order(const Executor& executor, Mesh<Dim, Space>& mesh) {
  renumber(executor, mesh);
  return read_out(executor, mesh, false);  // numbers nothing anew
}

template MeshWithMetric take_apart(const Executor&, Mesh<2>);
template MeshWithMetric take_apart(const Executor&, Mesh<2, 3>);
template MeshWithMetric take_apart(const Executor&, Mesh<3>);
template MeshWithMetric copy_in_order(const Executor&, Mesh<2>&);
template MeshWithMetric copy_in_order(const Executor&, Mesh<2, 3>&);
template MeshWithMetric copy_in_order(const Executor&, Mesh<3>&);

}  // namespace ductile::meshadapt
