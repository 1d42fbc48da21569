#include "ductile/meshadapt/transfer.hpp"

#include <algorithm>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/indices.hpp"
#include "mesh/sorted_cells.hpp"
#include "mesh/wording.hpp"
#include "transfer/locator.hpp"
#include "transfer/places.hpp"
#include "transfer/vertex_places.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim, int Space>
class OriginFinder {
 public:
  OriginFinder(const Executor& executor, const AnyMesh& before, const AnyMesh& after)
      : executor_(executor),
        before_(before),
        after_(after),
        old_mesh_(make_fixed_mesh<Dim, Space>(executor, before)),
        locator_(executor, old_mesh_),
        places_(executor, locator_, after) {}

  Origins find() {
    find_hosts();
    found_.vertex = places_.take_origins();
    find_elements();
    find_facets();
    return std::move(found_);
  }

 private:
  void find_hosts() {
    const std::size_t vertices = after_.vertex_count();
    runtime::resize_empty(executor_, runtime::EmptyVector{found_.host, vertices},
                          runtime::EmptyVector{found_.weight, (Dim + 1) * vertices});
    walk_in_blocks(executor_, vertices, [&](std::size_t v, ElementId near) {
      const Place<Dim> place = places_.find(static_cast<VertexId>(v), near);
      found_.host[v] = place.element;
      double* const weight = &found_.weight[(Dim + 1) * v];
      std::copy(place.weight.begin(), place.weight.end(), weight);
      const bool is_turned =
          old_mesh_.corners_of[place.element] != elements_in<Dim>(before_).vertices[place.element];
      if (is_turned) std::swap(weight[0], weight[1]);
      return place.element;
    });
  }

  // ---- Elements and facets, by their vertices ----

  void find_elements() {
    const auto& cells = elements_in<Dim>(after_);
    found_.element = runtime::make_vector<ElementId>(executor_, cells.size());
    parallel_for(executor_, cells.size(), [&](std::size_t e) {
      Corners<Dim> corners = cells.vertices[e];
      for (VertexId& v : corners) v = found_.vertex[v];
      found_.element[e] =
          contains(corners, none) ? none : same_element(corners, cells.reference[e]);
    });
  }

  ElementId same_element(const Corners<Dim>& corners, std::int32_t reference) const {
    for (const ElementId e : old_mesh_.elements_of(corners[0])) {
      bool same = elements_in<Dim>(before_).reference[e] == reference;
      for (const VertexId v : corners) same = same && contains(old_mesh_.corners_of[e], v);
      if (same) return e;
    }
    return none;
  }

  void find_facets() {
    const auto listed = sorted_cells(executor_, facets_in<Dim>(before_).vertices);
    const auto& facets = facets_in<Dim>(after_).vertices;
    found_.facet = runtime::make_vector<std::uint32_t>(executor_, facets.size());
    parallel_for(executor_, facets.size(), [&](std::size_t f) {
      Facet<Dim> corners = facets[f];
      for (VertexId& v : corners) v = found_.vertex[v];
      found_.facet[f] = find_cell<Dim>(listed, corners);
    });
  }

  const Executor& executor_;
  const AnyMesh& before_;
  const AnyMesh& after_;
  const FixedMesh<Dim, Space> old_mesh_;
  const Locator<Dim, Space> locator_;
  VertexPlaces<Dim, Space> places_;
  Origins found_;
};

template <int Dim, int Space = Dim>
Origins origins_in(const Executor& executor, const AnyMesh& before, const AnyMesh& after) {
  expect_places(executor, before.coordinates, Space, "old vertex");
  expect_places(executor, after.coordinates, Space, "new vertex");
  return OriginFinder<Dim, Space>(executor, before, after).find();
}

}  // namespace

Origins origins(const Executor& executor, const AnyMesh& before, const AnyMesh& after) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
    expect_all_vertices(*mesh);
  }
  if (before.dimension != after.dimension)
    throw InputError(name_of(after) + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + name_of(before) + ", found " + std::to_string(after.dimension));
  if (is_surface(before)) return origins_in<2, 3>(executor, before, after);
  return before.dimension == 2 ? origins_in<2>(executor, before, after)
                               : origins_in<3>(executor, before, after);
}

}  // namespace ductile::meshadapt
