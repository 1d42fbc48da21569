#include "levelset/cut_output.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "core/orientation.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/divide.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// Cells after they were divided, and the index of each one's origin.
template <int N>
struct Divided {
  Cells<N> cells;
  std::vector<std::uint32_t> origin;  // [cell]
  std::vector<std::uint32_t> first;   // [cell before], its first piece; and one past the last
};

template <int Dim>
class CutWriter {
 public:
  CutWriter(const Executor& executor, const CutDomain<Dim>& domain, const Snapped& snapped)
      : executor_(executor),
        domain_(domain),
        snapped_(snapped),
        divider_(snapped.crossings, snapped.sign_of) {}

  CutMesh write(std::int32_t interface) {
    made_.mesh.dimension = Dim;
    made_.mesh.names = any_.names;
    made_.mesh.name = any_.name;
    made_.mesh.dropped_axis = any_.dropped_axis;
    made_.mesh.corners = any_.corners;
    made_.mesh.required_vertices = any_.required_vertices;
    write_vertices();
    write_elements();
    write_facets(interface);
    if constexpr (Dim == 3) write_edges();
    return std::move(made_);
  }

 private:
  // ---- Vertices ----

  void write_vertices() {
    const std::size_t before = any_.vertex_count(), added = snapped_.crossings.size();
    AnyMesh& mesh = made_.mesh;
    mesh.vertex_reference = any_.vertex_reference;
    mesh.vertex_reference.resize(before + added, 0);
    mesh.coordinates.resize(Dim * (before + added));
    made_.vertex_origin = snapped_.origin_of;
    made_.vertex_origin.resize(before + added);
    parallel_for(executor_, before + added, [&](std::size_t v) {
      Vector<Dim> place;
      if (v < before) {
        place = domain_.mesh.position_of[v];
      } else {
        const Crossing& edge = snapped_.crossings[v - before];
        made_.vertex_origin[v] = {edge.a, edge.b, edge.t};
        const Vector<Dim> a = domain_.mesh.position_of[edge.a];
        place = a + edge.t * (domain_.mesh.position_of[edge.b] - a);
      }
      std::copy_n(place.x.begin(), Dim, &mesh.coordinates[Dim * v]);
    });
  }

  // ---- Cells ----

  /// Divides cells, except those that are dropped; `dropped` may be empty.
  template <int N>
  Divided<N> divided(const std::vector<std::array<std::uint32_t, N>>& cells,
                     std::span<const std::uint8_t> dropped) const {
    Divided<N> made;
    made.first = runtime::make_vector<std::uint32_t>(executor_, cells.size() + 1);
    parallel_for(executor_, cells.size(), [&](std::size_t i) {
      made.first[i] = !dropped.empty() && dropped[i] != 0
                          ? 0
                          : static_cast<std::uint32_t>(divider_.divide(cells[i]).count);
    });
    const std::size_t count = runtime::exclusive_scan(executor_, std::span(made.first));
    runtime::resize_empty(executor_, runtime::EmptyVector{made.cells.vertices, count},
                          runtime::EmptyVector{made.cells.reference, count},
                          runtime::EmptyVector{made.origin, count});
    parallel_for(executor_, cells.size(), [&](std::size_t i) {
      if (made.first[i] == made.first[i + 1]) return;
      std::size_t at = made.first[i];
      for (const auto& piece : divider_.divide(cells[i])) {
        made.origin[at] = static_cast<std::uint32_t>(i);
        made.cells.vertices[at++] = piece;
      }
    });
    return made;
  }

  /// Indices of the pieces of listed cells, none of which may have been cut if they are required.
  template <int N>
  std::vector<std::uint32_t> required_pieces(const Divided<N>& cells,
                                             const std::vector<std::uint32_t>& list,
                                             const char* array, const char* kind) const {
    for (const std::uint32_t i : list)
      if (cells.first[i + 1] - cells.first[i] > 1)
        refuse(name_of(any_) + ": the surface crosses " + entry(array, kind, i) +
               ", which is required; move the surface or do not require it");
    return pieces_of(cells, list);
  }

  template <int N>
  static std::vector<std::uint32_t> pieces_of(const Divided<N>& cells,
                                              const std::vector<std::uint32_t>& list) {
    std::vector<std::uint32_t> pieces;
    for (const std::uint32_t i : list)
      for (std::uint32_t piece = cells.first[i]; piece < cells.first[i + 1]; ++piece)
        pieces.push_back(piece);
    return pieces;
  }

  // ---- Elements ----

  /// The side that an element or a piece of one is on.
  int side_of(const Corners<Dim>& corners) const {
    for (const VertexId v : corners)
      if (const int sign = divider_.sign(v); sign != 0) return sign;
    return 0;
  }

  void write_elements() {
    auto elements = divided<Dim + 1>(domain_.mesh.corners_of, {});
    parallel_for(executor_, elements.origin.size(), [&](std::size_t i) {
      const ElementId from = elements.origin[i];
      const CutMaterial& material = domain_.materials[domain_.material_of[from]];
      elements.cells.reference[i] = !material.split ? elements_in<Dim>(any_).reference[from]
                                    : side_of(elements.cells.vertices[i]) < 0 ? material.minus
                                                                              : material.plus;
    });
    auto& required = Dim == 2 ? any_.required_triangles : any_.required_tetrahedra;
    (Dim == 2 ? made_.mesh.required_triangles : made_.mesh.required_tetrahedra) =
        required_pieces(elements, required, elements_array<Dim>(), element_name<Dim>());
    expect_volumes(elements);
    measure(elements);
    find_interface(elements);
    elements_in<Dim>(made_.mesh) = std::move(elements.cells);
    made_.element_origin = std::move(elements.origin);
  }

  void expect_volumes(const Divided<Dim + 1>& elements) const {
    const std::size_t bad = first_bad(executor_, elements.origin.size(), [&](std::size_t i) {
      const Corners<Dim>& corners = elements.cells.vertices[i];
      if (std::ranges::all_of(corners, [&](VertexId v) { return divider_.sign(v) != 0; }))
        return false;
      return orientation<Dim>(points(corners)) <= 0;
    });
    if (bad != no_index)
      refuse(name_of(any_) + ": " +
             entry(elements_array<Dim>(), element_name<Dim>(), elements.origin[bad]) +
             " is too flat to be cut; remove or repair it");
  }

  std::array<Vector<Dim>, Dim + 1> points(const Corners<Dim>& corners) const {
    std::array<Vector<Dim>, Dim + 1> result;
    for (std::size_t i = 0; i <= Dim; ++i) result[i] = position_in<Dim>(made_.mesh, corners[i]);
    return result;
  }

  void measure(const Divided<Dim + 1>& elements) {
    made_.report.minus_volume = runtime::parallel_reduce(
        executor_, elements.origin.size(), 0.0,
        [&](std::size_t i) {
          const Corners<Dim>& corners = elements.cells.vertices[i];
          return domain_.is_split(elements.origin[i]) && side_of(corners) < 0
                     ? plain_determinant(points(corners)) / (Dim == 2 ? 2 : 6)
                     : 0.0;
        },
        [](double a, double b) { return a + b; });
    for (std::size_t e = 0; e + 1 < elements.first.size(); ++e)
      made_.report.cut_elements += elements.first[e + 1] - elements.first[e] > 1;
  }

  // ---- Facets on the surface ----

  /// Each is seen from the piece on the negative side. Inside an element that was cut there are two
  /// pieces on it; otherwise the element across must be on the other side.
  void find_interface(const Divided<Dim + 1>& elements) {
    interface_ = runtime::parallel_collect<Facet<Dim>>(
        executor_, elements.origin.size(), [&](std::size_t i, auto&& append) {
          const ElementId from = elements.origin[i];
          const Corners<Dim>& corners = elements.cells.vertices[i];
          if (!domain_.is_split(from) || side_of(corners) >= 0) return;
          for (std::size_t k = 0; k <= Dim; ++k) {
            const Facet<Dim> facet = facet_of<Dim>(corners, static_cast<int>(k));
            if (std::ranges::any_of(facet, [&](VertexId v) { return divider_.sign(v) != 0; }))
              continue;
            const bool inside = elements.first[from + 1] - elements.first[from] > 1;
            if (inside || separates(from, k)) append(facet);
          }
        });
  }

  bool separates(ElementId element, std::size_t facet) const {
    const ElementId other = domain_.mesh.neighbour_of[element][facet];
    return other != none && domain_.is_split(other) && domain_.listed_of[element][facet] == 0 &&
           side_of(domain_.mesh.corners_of[other]) > 0;
  }

  void write_facets(std::int32_t interface) {
    auto facets = divided<Dim>(facets_in<Dim>(any_).vertices, domain_.drops_facet);
    parallel_for(executor_, facets.origin.size(), [&](std::size_t i) {
      facets.cells.reference[i] = facets_in<Dim>(any_).reference[facets.origin[i]];
    });
    const auto& required = Dim == 2 ? any_.required_edges : any_.required_triangles;
    (Dim == 2 ? made_.mesh.required_edges : made_.mesh.required_triangles) =
        required_pieces(facets, required, facets_array<Dim>(), facet_name<Dim>());
    if (Dim == 2) made_.mesh.ridges = pieces_of(facets, any_.ridges);
    for (const Facet<Dim>& facet : interface_) facets.cells.add(facet, interface);
    made_.report.interface_facets = interface_.size();
    made_.facet_origin = std::move(facets.origin);
    made_.facet_origin.resize(facets.cells.size(), none);
    facets_in<Dim>(made_.mesh) = std::move(facets.cells);
  }

  void write_edges() {
    auto edges = divided<2>(any_.edges.vertices, domain_.drops_edge);
    for (std::size_t i = 0; i < edges.origin.size(); ++i)
      edges.cells.reference[i] = any_.edges.reference[edges.origin[i]];
    made_.mesh.required_edges =
        required_pieces(edges, any_.required_edges, "edges.vertices", "edge");
    made_.mesh.ridges = pieces_of(edges, any_.ridges);
    made_.mesh.edges = std::move(edges.cells);
  }

  const Executor& executor_;
  const CutDomain<Dim>& domain_;
  const AnyMesh& any_ = domain_.any;
  const Snapped& snapped_;
  Divider divider_;
  runtime::UnsetVector<Facet<Dim>> interface_;
  CutMesh made_;
};

}  // namespace

template <int Dim>
CutMesh write_cut(const Executor& executor, const CutDomain<Dim>& domain, const Snapped& snapped,
                  std::int32_t interface) {
  return CutWriter<Dim>(executor, domain, snapped).write(interface);
}

template CutMesh write_cut(const Executor&, const CutDomain<2>&, const Snapped&, std::int32_t);
template CutMesh write_cut(const Executor&, const CutDomain<3>&, const Snapped&, std::int32_t);

}  // namespace ductile::meshadapt
