#include "levelset/cut_domain.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/check_input.hpp"
#include "geometry/marked_points.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

constexpr std::uint32_t ambiguous = none;

/// The material of each reference: that of the same reference, otherwise the one that has it as a
/// side.
std::map<std::int32_t, std::uint32_t> materials_by_reference(std::span<const CutMaterial> table) {
  std::map<std::int32_t, std::uint32_t> found;
  for (std::uint32_t i = 0; i < table.size(); ++i)
    if (!found.emplace(table[i].reference, i).second)
      throw InputError("materials[" + std::to_string(i) +
                       "]: expected each reference once, found " +
                       std::to_string(table[i].reference) + " again");
  const auto parents = found;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    if (!table[i].split) continue;
    if (table[i].minus == table[i].plus)
      throw InputError("materials[" + std::to_string(i) +
                       "]: expected different references for the two sides, found " +
                       std::to_string(table[i].plus) + " for both");
    for (const std::int32_t side : {table[i].minus, table[i].plus}) {
      const auto [at, is_new] = found.emplace(side, i);
      if (!is_new && at->second != i && !parents.contains(side)) at->second = ambiguous;
    }
  }
  return found;
}

template <int Dim, int Space>
class DomainMaker {
 public:
  DomainMaker(const Executor& executor, const AnyMesh& any, const CutOptions& options)
      : executor_(executor), options_(options), domain_{any, {}, {}, {}, {}, {}, {}, {}, {}, {}} {}

  CutDomain<Dim> make() {
    check();
    make_elements();
    find_materials();
    find_listed_facets();
    domain_.is_ridge.assign(any_.edges.size(), 0);
    for (const std::uint32_t edge : any_.ridges) domain_.is_ridge[edge] = 1;
    if constexpr (Dim == 3) find_spokes();
    fix_vertices();
    return std::move(domain_);
  }

 private:
  void check() const {
    check_input<Dim, Space>(executor_, any_, {});
    for (const auto* list : {&any_.ridges, &any_.required_edges})
      marked(any_, any_.edges.size(), *list, "edge");
    marked(any_, any_.triangles.size(), any_.required_triangles, "triangle");
    marked(any_, any_.tetrahedra.size(), any_.required_tetrahedra, "tetrahedron");
  }

  void make_elements() {
    if constexpr (Space == Dim)
      domain_.mesh = make_fixed_mesh<Dim>(executor_, any_);
    else
      make_triangles();
  }

  /// The triangles of a surface, which stay turned as they are.
  void make_triangles() {
    FixedMesh<2>& mesh = domain_.mesh;
    mesh.corners_of = any_.triangles.vertices;
    mesh.position_of.resize(any_.vertex_count());
    mesh.volume_of.resize(mesh.element_count());
    parallel_for(executor_, mesh.element_count(), [&](std::size_t e) {
      const auto at = [&](std::size_t i) { return position_in<3>(any_, mesh.corners_of[e][i]); };
      mesh.volume_of[e] = 0.5 * norm(facet_normal(std::array{at(0), at(1), at(2)}));
    });
    const std::span<const Corners<2>> corners_of = mesh.corners_of;
    auto adjacency = make_adjacency<2>(
        executor_, corners_of, list_elements<2>(executor_, corners_of, any_.vertex_count()));
    mesh.first_around = std::move(adjacency.first_around);
    mesh.around = std::move(adjacency.around);
    mesh.neighbour_of = std::move(adjacency.neighbour_of);
    for (auto& neighbours : mesh.neighbour_of) std::ranges::replace(neighbours, crowded, none);
  }

  void find_materials() {
    const auto& reference_of = elements_in<Dim>(any_).reference;
    domain_.material_of = runtime::make_vector<std::uint32_t>(executor_, reference_of.size());
    domain_.materials = options_.materials;
    if (domain_.materials.empty()) {
      domain_.materials.push_back({0, true, options_.minus, options_.plus});
      if (options_.minus == options_.plus)
        throw InputError("expected different references for the two sides, found " +
                         std::to_string(options_.plus) + " for both");
      return;
    }
    const auto found = materials_by_reference(options_.materials);
    for (std::size_t e = 0; e < reference_of.size(); ++e) {
      if (e > 0 && reference_of[e] == reference_of[e - 1]) {
        domain_.material_of[e] = domain_.material_of[e - 1];
        continue;
      }
      const auto at = found.find(reference_of[e]);
      if (at == found.end() || at->second == ambiguous) refuse_reference(e, at != found.end());
      domain_.material_of[e] = at->second;
    }
  }

  [[noreturn]] void refuse_reference(std::size_t e, bool is_ambiguous) const {
    refuse(name_of(any_) + ": " + entry(elements_array<Dim>(), element_name<Dim>(), e) +
           " has the reference " + std::to_string(elements_in<Dim>(any_).reference[e]) +
           (is_ambiguous ? ", a side of several materials; give each material sides of its own"
                         : ", which is not in the table of materials; add it there"));
  }

  void find_listed_facets() {
    const auto& facets = facets_in<Dim>(any_);
    const FixedMesh<Dim>& mesh = domain_.mesh;
    domain_.listed_of =
        runtime::make_vector<std::array<std::uint32_t, Dim + 1>>(executor_, mesh.element_count());
    domain_.drops_facet.assign(facets.size(), 0);
    std::vector<ElementFacet> place_of(facets.size());
    parallel_for(executor_, facets.size(), [&](std::size_t f) {
      place_of[f] = find_facet<Dim>(mesh.elements_of(facets.vertices[f][0]), mesh.corners_of,
                                    facets.vertices[f]);
    });
    for (std::size_t f = facets.size(); f-- > 0;) {  // the first of several has the last word
      const auto [element, i] = place_of[f];
      if (element == none) continue;
      const ElementId other = mesh.neighbour_of[element][static_cast<std::size_t>(i)];
      domain_.drops_facet[f] = facets.reference[f] == options_.interface && other != none;
      if (domain_.drops_facet[f] != 0) continue;
      const auto number = static_cast<std::uint32_t>(f + 1);
      domain_.listed_of[element][static_cast<std::size_t>(i)] = number;
      if (other == none) continue;
      const int there = facet_number<Dim>(mesh.corners_of[other], facets.vertices[f]);
      domain_.listed_of[other][static_cast<std::size_t>(there)] = number;
    }
  }

  void find_spokes() {
    const auto& edges = any_.edges;
    domain_.drops_edge.assign(edges.size(), 0);
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      domain_.drops_edge[i] = edges.reference[i] == options_.interface;
      if (domain_.drops_edge[i] != 0) continue;
      const auto [a, b] = edges.vertices[i];
      domain_.spokes.push_back({a, b, i});
      domain_.spokes.push_back({b, a, i});
    }
    std::sort(domain_.spokes.begin(), domain_.spokes.end());
  }

  template <int N>
  void fix(const Cells<N>& cells, const std::vector<std::uint32_t>& required) {
    for (const std::uint32_t i : required)
      for (const VertexId v : cells.vertices[i]) domain_.is_fixed[v] = 1;
  }

  void fix_vertices() {
    domain_.is_fixed = marked_points(any_);
    for (const auto* list : {&any_.corners, &any_.required_vertices})
      for (const VertexId v : *list) domain_.is_fixed[v] = 1;
    fix(any_.edges, any_.required_edges);
    fix(any_.triangles, any_.required_triangles);
    fix(any_.tetrahedra, any_.required_tetrahedra);
  }

  const Executor& executor_;
  const CutOptions& options_;
  CutDomain<Dim> domain_;
  const AnyMesh& any_ = domain_.any;
};

}  // namespace

template <int Dim>
std::span<const ListedSpoke> CutDomain<Dim>::spokes_of(VertexId vertex) const {
  const auto first = std::lower_bound(spokes.begin(), spokes.end(), ListedSpoke{vertex, 0, 0});
  auto last = first;
  while (last != spokes.end() && last->from == vertex) ++last;
  return {first, last};
}

template <int Dim, int Space>
CutDomain<Dim> make_cut_domain(const Executor& executor, const AnyMesh& mesh,
                               const CutOptions& options) {
  return DomainMaker<Dim, Space>(executor, mesh, options).make();
}

template struct CutDomain<2>;
template struct CutDomain<3>;
template CutDomain<2> make_cut_domain<2, 2>(const Executor&, const AnyMesh&, const CutOptions&);
template CutDomain<2> make_cut_domain<2, 3>(const Executor&, const AnyMesh&, const CutOptions&);
template CutDomain<3> make_cut_domain<3, 3>(const Executor&, const AnyMesh&, const CutOptions&);

}  // namespace ductile::meshadapt
