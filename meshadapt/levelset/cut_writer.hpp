/// @file
/// CutWriter<Dim, Space>: makes the cut mesh from the mesh before and the snapped surface. With
/// Dim 2 and Space 3 that is a surface alone, or the boundary of tetrahedra with these.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/snap.hpp"

namespace ductile::meshadapt {

/// The volume of an element, 2D: its area.
template <int Dim, int Space>
double volume_of_simplex(const std::array<Vector<Space>, Dim + 1>& p) {
  if constexpr (Space == Dim)
    return plain_determinant(p) / (Dim == 2 ? 2 : 6);
  else
    return 0.5 * norm(facet_normal(p));
}

template <int Dim, int Space>
class CutWriter {
 public:
  CutWriter(const runtime::Executor& executor, const CutDomain<Dim>& domain,
            const Snapped<Space>& snapped)
      : executor_(executor),
        domain_(domain),
        snapped_(snapped),
        divider_(snapped.crossings, snapped.sign_of) {}

  /// New facets on the surface get the reference `interface`. Throws InputError if something
  /// required is cut. Thread safety: one caller; runs on the executor.
  CutMesh write(std::int32_t interface) {
    write_domain(interface);
    return std::move(made_);
  }

  /// The same for tetrahedra of which the domain is the listed facets: they keep their references.
  CutMesh write_with_tetrahedra(const AnyMesh& whole,
                                std::int32_t interface) requires(Dim < Space) {
    const auto mesh = make_fixed_mesh<3>(executor_, whole);
    write_domain(interface);
    auto cells = divided<4>(mesh.corners_of, whole.tetrahedra.reference, {});
    const std::size_t flat = first_bad(executor_, cells.origin.size(), [&](std::size_t i) {
      return orientation<3>(divider_.places(snapped_.place_of, cells.cells.vertices[i])) <= 0;
    });
    if (flat != no_index)
      refuse(name_of(whole) + ": " +
             entry(elements_array<3>(), element_name<3>(), cells.origin[flat]) +
             " is too flat to be cut; remove or repair it");
    made_.mesh.required_tetrahedra =
        required(cells, whole.required_tetrahedra, elements_array<3>(), element_name<3>());
    made_.report.cut_elements = count_cut(cells, mesh.element_count());
    made_.facet_origin = std::move(made_.element_origin);
    made_.element_origin = std::move(cells.origin);
    made_.mesh.tetrahedra = std::move(cells.cells);
    return std::move(made_);
  }

 private:
  /// Cells after they were divided.
  template <std::size_t N>
  struct Divided {
    Cells<N> cells;
    std::vector<std::uint32_t> origin;  // [cell] the one it is a piece of
    std::vector<std::uint32_t> first;   // [cell before] its first piece; and one past the last

    bool is_cut(std::size_t i) const { return first[i + 1] - first[i] > 1; }
  };

  void write_domain(std::int32_t interface) {
    made_.mesh.dimension = Space;
    made_.mesh.names = any_.names;
    made_.mesh.name = any_.name;
    made_.mesh.dropped_axis = any_.dropped_axis;
    made_.mesh.corners = any_.corners;
    made_.mesh.required_vertices = any_.required_vertices;
    made_.report.moved_vertices = snapped_.moved;
    made_.report.taken_vertices = snapped_.taken;
    write_vertices();
    write_elements();
    write_facets(interface);
    if constexpr (Dim == 3) write_edges();
  }

  void write_vertices() {
    const std::size_t before = any_.vertex_count(), all = before + snapped_.crossings.size();
    made_.mesh.vertex_reference = any_.vertex_reference;
    made_.mesh.vertex_reference.resize(all, 0);
    made_.mesh.coordinates.resize(Space * all);
    made_.vertex_origin = snapped_.origin_of;
    for (const auto& [a, b, t, square] : snapped_.crossings)
      made_.vertex_origin.push_back({a, b, t});
    runtime::parallel_for(executor_, all, [&](std::size_t v) {
      const Vector<Space> place = divider_.place(snapped_.place_of, static_cast<VertexId>(v));
      std::copy_n(place.x.begin(), Space, &made_.mesh.coordinates[Space * v]);
    });
  }

  // ---- Cells ----

  /// Divides cells, except those that are dropped; `dropped` may be empty. Their references are
  /// kept.
  template <std::size_t N>
  Divided<N> divided(const std::vector<std::array<VertexId, N>>& cells,
                     std::span<const std::int32_t> reference_of,
                     std::span<const std::uint8_t> dropped) const {
    Divided<N> made;
    made.first = runtime::make_vector<std::uint32_t>(executor_, cells.size() + 1);
    runtime::parallel_for(executor_, cells.size(), [&](std::size_t i) {
      if (dropped.empty() || dropped[i] == 0)
        made.first[i] = static_cast<std::uint32_t>(divider_.divide(cells[i]).count);
    });
    const std::size_t count = runtime::exclusive_scan(executor_, std::span(made.first));
    runtime::resize_empty(executor_, runtime::EmptyVector{made.cells.vertices, count},
                          runtime::EmptyVector{made.cells.reference, count},
                          runtime::EmptyVector{made.origin, count});
    runtime::parallel_for(executor_, cells.size(), [&](std::size_t i) {
      if (made.first[i] == made.first[i + 1]) return;
      std::size_t at = made.first[i];
      for (const auto& piece : divider_.divide(cells[i])) {
        made.origin[at] = static_cast<std::uint32_t>(i);
        made.cells.reference[at] = reference_of[i];
        made.cells.vertices[at++] = piece;
      }
    });
    return made;
  }

  template <std::size_t N>
  static std::size_t count_cut(const Divided<N>& cells, std::size_t count) {
    std::size_t cut = 0;
    for (std::size_t i = 0; i < count; ++i) cut += cells.is_cut(i);
    return cut;
  }

  /// The pieces of some cells, by their indices.
  template <std::size_t N>
  static std::vector<std::uint32_t> pieces_of(const Divided<N>& cells,
                                              const std::vector<std::uint32_t>& list) {
    std::vector<std::uint32_t> pieces;
    for (const std::uint32_t i : list)
      for (std::uint32_t piece = cells.first[i]; piece < cells.first[i + 1]; ++piece)
        pieces.push_back(piece);
    return pieces;
  }

  /// The same for cells that must not be cut; `array` and `kind` are what they are called.
  template <std::size_t N>
  std::vector<std::uint32_t> required(const Divided<N>& cells,
                                      const std::vector<std::uint32_t>& list, const char* array,
                                      const char* kind) const {
    for (const std::uint32_t i : list)
      if (cells.is_cut(i))
        refuse(name_of(any_) + ": the surface crosses " + entry(array, kind, i) +
               ", which is required; move the surface or do not require it");
    return pieces_of(cells, list);
  }

  void write_elements() {
    auto elements = divided<Dim + 1>(domain_.mesh.corners_of, elements_in<Dim>(any_).reference, {});
    runtime::parallel_for(executor_, elements.origin.size(), [&](std::size_t i) {
      const auto& material = domain_.materials[domain_.material_of[elements.origin[i]]];
      const int side = divider_.side(elements.cells.vertices[i]);
      if (material.split) elements.cells.reference[i] = side < 0 ? material.minus : material.plus;
    });
    (Dim == 2 ? made_.mesh.required_triangles : made_.mesh.required_tetrahedra) =
        required(elements, Dim == 2 ? any_.required_triangles : any_.required_tetrahedra,
                 elements_array<Dim>(), element_name<Dim>());
    made_.report.cut_elements = count_cut(elements, domain_.mesh.element_count());
    find_interface(elements);
    elements_in<Dim>(made_.mesh) = std::move(elements.cells);
    made_.element_origin = std::move(elements.origin);
  }

  bool is_below(const Divided<Dim + 1>& elements, std::size_t i) const {
    return domain_.is_split(elements.origin[i]) && divider_.side(elements.cells.vertices[i]) < 0;
  }

  /// Facets on the surface are seen from the negative side. There are two pieces on them if the
  /// element was cut; otherwise the element across must be on the other side.
  void find_interface(const Divided<Dim + 1>& elements) {
    interface_ = runtime::parallel_collect<Facet<Dim>>(
        executor_, elements.origin.size(), [&](std::size_t i, auto&& append) {
          if (!is_below(elements, i)) return;
          const ElementId from = elements.origin[i];
          for (std::size_t k = 0; k <= Dim; ++k) {
            const auto facet = facet_of<Dim>(elements.cells.vertices[i], static_cast<int>(k));
            if (divider_.side(facet) == 0 && (elements.is_cut(from) || separates(from, k)))
              append(facet);
          }
        });
  }

  bool separates(ElementId element, std::size_t facet) const {
    const ElementId other = domain_.mesh.neighbour_of[element][facet];
    return other != none && domain_.is_split(other) && domain_.listed_of[element][facet] == 0 &&
           divider_.side(domain_.mesh.corners_of[other]) > 0;
  }

  void write_facets(std::int32_t interface) {
    const auto& before = facets_in<Dim>(any_);
    auto facets = divided<Dim>(before.vertices, before.reference, domain_.drops_facet);
    (Dim == 2 ? made_.mesh.required_edges : made_.mesh.required_triangles) =
        required(facets, Dim == 2 ? any_.required_edges : any_.required_triangles,
                 facets_array<Dim>(), facet_name<Dim>());
    if (Dim == 2) made_.mesh.ridges = pieces_of(facets, any_.ridges);
    for (const Facet<Dim>& facet : interface_) facets.cells.add(facet, interface);
    made_.report.interface_facets = interface_.size();
    made_.facet_origin = std::move(facets.origin);
    made_.facet_origin.resize(facets.cells.size(), none);
    facets_in<Dim>(made_.mesh) = std::move(facets.cells);
  }

  void write_edges() {
    auto edges = divided<2>(any_.edges.vertices, any_.edges.reference, domain_.drops_edge);
    made_.mesh.required_edges = required(edges, any_.required_edges, "edges.vertices", "edge");
    made_.mesh.ridges = pieces_of(edges, any_.ridges);
    made_.mesh.edges = std::move(edges.cells);
  }

  const runtime::Executor& executor_;
  const CutDomain<Dim>& domain_;
  const AnyMesh& any_ = domain_.any;
  const Snapped<Space>& snapped_;
  Divider divider_;
  runtime::UnsetVector<Facet<Dim>> interface_;
  CutMesh made_;
};

}  // namespace ductile::meshadapt
