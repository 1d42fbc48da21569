#include "mesh/adjacency.hpp"

#include <algorithm>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "mesh/grouping.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

template <int Dim>
ElementFacet Adjacency<Dim>::find(const Facet<Dim>& corners) const {
  return find_facet<Dim>(this->elements_of(corners[0]), corners_of, corners);
}

template <int Dim>
ElementFacet Adjacency<Dim>::other_side(const ElementFacet& at) const {
  const ElementId other = across(at.element, at.facet);
  if (other == none || other == crowded) return {};
  const Facet<Dim> corners = facet_of<Dim>(corners_of[at.element], at.facet);
  return {other, facet_number<Dim>(corners_of[other], corners)};
}

template <int Dim>
bool Adjacency<Dim>::is_first(const ElementFacet& at) const {
  const ElementId other = across(at.element, at.facet);
  if (other != crowded) return at.element < other;
  return find(facet_of<Dim>(corners_of[at.element], at.facet)).element == at.element;
}

template <int Dim>
bool Adjacency<Dim>::on_region_boundary(ElementId element, int facet,
                                        std::span<const std::uint32_t> region_of) const {
  const ElementId other = across(element, facet);
  if (other == none) return true;
  const auto is_like = [&](ElementId e) {
    return region_of.empty() || region_of[e] == region_of[element];
  };
  if (other != crowded) return !is_like(other);
  const Facet<Dim> corners = facet_of<Dim>(corners_of[element], facet);
  const auto here = this->elements_of(corners[0]);
  return std::count_if(here.begin(), here.end(), [&](ElementId e) {
           return is_like(e) && has_facet<Dim>(corners_of[e], corners);
         }) == 1;
}

template <int Dim>
VertexElements list_elements(const Executor& executor, std::span<const Corners<Dim>> corners_of,
                             std::size_t vertex_count) {
  VertexElements lists;
  runtime::resize_empty(executor, runtime::EmptyVector{lists.first_around, vertex_count + 1},
                        runtime::EmptyVector{lists.around, (Dim + 1) * corners_of.size() + 1});
  Grouping grouping(executor, GroupingBounds::even(executor, corners_of.size(), vertex_count),
                    std::span(lists.first_around).subspan(1),
                    [&corners_of](ElementId element, auto&& visit) {
                      for (const VertexId v : corners_of[element]) visit(v);
                    });
  grouping.list([&](std::uint32_t place, ElementId element) { lists.around[place] = element; });
  return lists;
}

template <int Dim>
Adjacency<Dim> make_adjacency(const Executor& executor, std::span<const Corners<Dim>> corners_of,
                              VertexElements lists) {
  Adjacency<Dim> made{std::move(lists), corners_of, {}};
  runtime::resize_empty(executor, runtime::EmptyVector{made.neighbour_of, corners_of.size()});
  find_neighbours<Dim>(
      executor, corners_of, made.first_around.size() - 1,
      [&made](VertexId v) { return made.elements_of(v); }, made.neighbour_of);
  return made;
}

template <int Dim>
const VertexElements& AdjacentMesh::lists() const {
  if (kept<Dim>()) return *kept<Dim>();
  if (!lists_)
    lists_ = list_elements<Dim>(executor_, elements_in<Dim>(mesh_).vertices, mesh_.vertex_count());
  return *lists_;
}

template <int Dim>
const Adjacency<Dim>& AdjacentMesh::adjacency() const {
  if (!kept<Dim>()) {
    lists<Dim>();
    kept<Dim>() =
        make_adjacency<Dim>(executor_, elements_in<Dim>(mesh_).vertices, *std::move(lists_));
    lists_.reset();
  }
  return *kept<Dim>();
}

template struct Adjacency<2>;
template struct Adjacency<3>;
template VertexElements list_elements<2>(const Executor&, std::span<const Corners<2>>, std::size_t);
template VertexElements list_elements<3>(const Executor&, std::span<const Corners<3>>, std::size_t);
template Adjacency<2> make_adjacency<2>(const Executor&, std::span<const Corners<2>>,
                                        VertexElements);
template Adjacency<3> make_adjacency<3>(const Executor&, std::span<const Corners<3>>,
                                        VertexElements);
template const VertexElements& AdjacentMesh::lists<2>() const;
template const VertexElements& AdjacentMesh::lists<3>() const;
template const Adjacency<2>& AdjacentMesh::adjacency<2>() const;
template const Adjacency<3>& AdjacentMesh::adjacency<3>() const;

}  // namespace ductile::meshadapt
