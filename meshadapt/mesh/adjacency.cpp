#include "mesh/adjacency.hpp"

#include <algorithm>

#include "ductile/runtime/arrays.hpp"
#include "mesh/grouping.hpp"

namespace ductile::meshadapt {

namespace {

/// Which facet of an element has these corners: that opposite the one that they lack.
template <std::size_t N>
int facet_number(const std::array<VertexId, N>& corners,
                 const std::array<VertexId, N + 1>& element) {
  int i = 0;
  while (i < static_cast<int>(N) && contains(corners, element[static_cast<std::size_t>(i)])) ++i;
  return i;
}

}  // namespace

template <int Dim>
bool Adjacency<Dim>::has_all(ElementId element, std::span<const VertexId> vertices) const {
  return std::all_of(vertices.begin(), vertices.end(),
                     [&](VertexId v) { return contains(corners_of[element], v); });
}

template <int Dim>
ElementFacet Adjacency<Dim>::find(const Facet<Dim>& corners) const {
  for (const ElementId element : elements_of(corners[0]))
    if (has_all(element, corners)) return {element, facet_number(corners, corners_of[element])};
  return {};
}

template <int Dim>
ElementFacet Adjacency<Dim>::other_side(const ElementFacet& at) const {
  const ElementId other = across(at.element, at.facet);
  if (other == none || other == crowded) return {};
  return {other, facet_number(facet_of<Dim>(corners_of[at.element], at.facet), corners_of[other])};
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
  const auto here = elements_of(corners[0]);
  return std::count_if(here.begin(), here.end(),
                       [&](ElementId e) { return is_like(e) && has_all(e, corners); }) == 1;
}

template <int Dim>
Adjacency<Dim> make_adjacency(const runtime::Executor& executor,
                              std::span<const Corners<Dim>> corners_of, std::size_t vertex_count) {
  Adjacency<Dim> made;
  made.corners_of = corners_of;
  const std::size_t entries = (Dim + 1) * corners_of.size();
  runtime::resize_empty(executor, runtime::EmptyVector{made.first_around, vertex_count + 1},
                        runtime::EmptyVector{made.around, entries + 1},
                        runtime::EmptyVector{made.neighbour_of, corners_of.size()});
  Grouping grouping(executor, GroupingBounds::even(executor, corners_of.size(), vertex_count),
                    std::span(made.first_around).subspan(1),
                    [&corners_of](ElementId element, auto&& visit) {
                      for (const VertexId v : corners_of[element]) visit(v);
                    });
  grouping.list([&](std::uint32_t place, ElementId element) { made.around[place] = element; });
  find_neighbours<Dim>(
      executor, corners_of, vertex_count, [&made](VertexId v) { return made.elements_of(v); },
      made.neighbour_of);
  return made;
}

template struct Adjacency<2>;
template struct Adjacency<3>;
template Adjacency<2> make_adjacency(const runtime::Executor&, std::span<const Corners<2>>,
                                     std::size_t);
template Adjacency<3> make_adjacency(const runtime::Executor&, std::span<const Corners<3>>,
                                     std::size_t);

}  // namespace ductile::meshadapt
