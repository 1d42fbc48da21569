/// @file
/// find_neighbours(): the elements across all facets of a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/facet_key.hpp"

namespace ductile::meshadapt {

/// A facet of an element.
struct ElementFacet {
  ElementId element = none;
  int facet = 0;
};

/// Does an element have all corners of a facet?
template <int Dim>
bool has_facet(const Corners<Dim>& element, const Facet<Dim>& corners) {
  return std::ranges::all_of(corners, [&](VertexId v) { return contains(element, v); });
}

/// The number of the facet of an element that has these corners, all of them the element's.
template <int Dim>
int facet_number(const Corners<Dim>& element, const Facet<Dim>& corners) {
  int i = 0;
  while (i < Dim && contains(corners, element[static_cast<std::size_t>(i)])) ++i;
  return i;
}

/// Among the elements around a corner of a facet, the first that has it; element `none` if there is
/// none.
template <int Dim>
ElementFacet find_facet(std::span<const ElementId> around, std::span<const Corners<Dim>> corners_of,
                        const Facet<Dim>& corners) {
  for (const ElementId element : around)
    if (has_facet<Dim>(corners_of[element], corners))
      return {element, facet_number<Dim>(corners_of[element], corners)};
  return {};
}

/// Replaces a neighbour if more than two elements have a facet, or two on one side of it.
inline constexpr ElementId crowded = none - 1;

/// ElementsAt: elements_at(vertex) is a span of the elements around a vertex, ascending.
template <int Dim, class ElementsAt>
class NeighbourFinder {
 public:
  using Elements = std::span<const Corners<Dim>>;
  using NeighbourOf = std::span<std::array<ElementId, Dim + 1>>;

  NeighbourFinder(Elements corners_of, ElementsAt elements_at, NeighbourOf neighbour_of)
      : corners_of_(corners_of),
        elements_at_(std::move(elements_at)),
        neighbour_of_(neighbour_of) {}

  void run(const runtime::Executor& executor, std::size_t vertex_count) {
    runtime::parallel_for(executor, neighbour_of_.size(),
                          [&](std::size_t e) { neighbour_of_[e].fill(none); });
    runtime::PerThread<std::vector<Met>> table(executor);
    runtime::parallel_for(executor, vertex_count,
                          [&](std::size_t v) { visit(static_cast<VertexId>(v), table.mine()); });
  }

 private:
  /// A facet seen before, and its first element. The lowest corner is stored, because tables keep
  /// entries of earlier vertices.
  struct Met {
    std::uint64_t others = 0;
    VertexId lowest = none;
    ElementId element = none;
    std::uint8_t facet = 0;
    bool odd = false, twice = false;
  };

  /// Neighbours find each other at the lowest corner of their facet.
  void visit(VertexId lowest, std::vector<Met>& table) {
    const std::span<const ElementId> around = elements_at_(lowest);
    const std::size_t size = facet_table_size(Dim * around.size());
    table.resize(std::max(table.size(), size));
    for (const ElementId element : around) {
      const Corners<Dim>& corners = corners_of_[element];
      const auto lower = std::count_if(corners.begin(), corners.end(),
                                       [lowest](VertexId v) { return v < lowest; });
      for (int i = 0; i <= Dim; ++i) {
        const VertexId opposite = corners[static_cast<std::size_t>(i)];
        if (opposite != lowest && lower == (opposite < lowest ? 1 : 0))
          meet(lowest, element, i, std::span(table).first(size));
      }
    }
  }

  /// Elements come in order, so the first is the lowest. A facet belongs to two, one on each side.
  void meet(VertexId lowest, ElementId element, int facet, std::span<Met> table) {
    const FacetKey key = key_of<Dim>(facet_of<Dim>(corners_of_[element], facet));
    const auto is_free = [lowest](const Met& met) { return met.lowest != lowest; };
    Met& met = facet_place(table, key.others, is_free);
    if (is_free(met)) {
      met = {key.others, lowest, element, static_cast<std::uint8_t>(facet), key.odd};
    } else if (met.twice || met.odd == key.odd) {
      crowd(met);
      neighbour_at(element, facet) = crowded;
    } else {
      met.twice = true;
      neighbour_at(met.element, met.facet) = element;
      neighbour_at(element, facet) = met.element;
    }
  }

  /// Marks a facet that has another element on the same side, or a third.
  void crowd(Met& met) {
    ElementId& other = neighbour_at(met.element, met.facet);
    if (met.twice && other != crowded)
      neighbour_at(other, facet_number<Dim>(corners_of_[other], corners_at(met))) = crowded;
    met.twice = true;
    other = crowded;
  }

  Facet<Dim> corners_at(const Met& met) const {
    return facet_of<Dim>(corners_of_[met.element], met.facet);
  }

  ElementId& neighbour_at(ElementId element, int facet) {
    return neighbour_of_[element][static_cast<std::size_t>(facet)];
  }

  Elements corners_of_;
  ElementsAt elements_at_;
  NeighbourOf neighbour_of_;
};

/// Sets neighbour_of, [element][facet]: the element across it, `none` if there is none, or
/// `crowded`. elements_at(vertex) is a span of the elements around a vertex, ascending. Nearly
/// linear. Thread safety: one caller; runs on the executor.
template <int Dim>
void find_neighbours(const runtime::Executor& executor, std::span<const Corners<Dim>> corners_of,
                     std::size_t vertex_count, auto elements_at,
                     std::span<std::array<ElementId, Dim + 1>> neighbour_of) {
  NeighbourFinder<Dim, decltype(elements_at)>(corners_of, std::move(elements_at), neighbour_of)
      .run(executor, vertex_count);
}

}  // namespace ductile::meshadapt
