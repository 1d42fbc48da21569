#include "geometry/tag_boundary.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "geometry/check_input.hpp"
#include "mesh/flatten.hpp"
#include "mesh/listed_twice.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

namespace {

/// An entity that is listed twice has the properties of both and the reference of the first.
template <class Listed>
void merge(Listed& first, const Listed& again) {
  first.required = first.required || again.required;
  first.ridge = first.ridge || again.ridge;
}

template <int Dim>
class BoundaryTagger {
 public:
  explicit BoundaryTagger(MeshInMaking<Dim>& making) : making_(making) {}

  std::vector<TaggedFacet<Dim>> facets() {
    auto facets = listed_facets();
    add_unlisted_facets(facets);
    return facets;
  }

  /// Edges that belong to no element, as construction lines do, are left out.
  std::vector<ListedEdge> edges() {
    std::vector<ListedEdge> edges;
    if constexpr (Dim == 3) {
      const auto required =
          marked(making_.any, making_.any.edges.size(), making_.any.required_edges, "edge");
      const auto ridge = marked(making_.any, making_.any.edges.size(), making_.any.ridges, "edge");
      std::size_t first_loose = no_index, loose = 0;
      std::vector<ElementId> shell;
      std::vector<std::size_t> number_of;                          // [edge taken], as listed
      std::unordered_map<std::uint64_t, std::size_t> index_among;  // by both vertices
      ListedTwice twice("edge", making_.any.edges.reference);
      for (std::size_t i = 0; i < making_.any.edges.size(); ++i) {
        const auto [a, b] = making_.any.edges.vertices[i];
        shell_of(making_.mesh, a, b, shell);
        if (shell.empty()) {
          if (loose++ == 0) first_loose = i;
          continue;
        }
        const ListedEdge edge{a, b, making_.any.edges.reference[i], required[i], ridge[i]};
        const auto [at, is_new] = index_among.emplace(
            std::uint64_t{std::min(a, b)} << 32U | std::max(a, b), edges.size());
        if (is_new) {
          edges.push_back(edge);
          number_of.push_back(i);
        } else {
          twice.add(number_of[at->second], i);
          merge(edges[at->second], edge);
        }
      }
      if (!twice.empty()) making_.warnings.push_back(name_of(making_.any) + ": " + twice.warning());
      report_loose_edges(loose, first_loose);
    }
    return edges;
  }

 private:
  [[noreturn]] void fail(const Wording& what) const { refuse_mesh(making_.any, what); }

  std::vector<TaggedFacet<Dim>> listed_facets() {
    const auto& cells = facets_in<Dim>(making_.any);
    const auto& required_list =
        Dim == 2 ? making_.any.required_edges : making_.any.required_triangles;
    const auto required = marked(making_.any, cells.size(), required_list, facet_name<Dim>());
    const auto ridge = marked(making_.any, cells.size(),
                              Dim == 2 ? making_.any.ridges : std::vector<std::uint32_t>{}, "edge");
    std::vector<TaggedFacet<Dim>> facets(cells.size());
    parallel_for(making_.executor, cells.size(), [&](std::size_t f) {
      facets[f].corners = cells.vertices[f];
      facets[f].data = {
          {}, cells.reference[f], true, required[f] || making_.options.lock_boundary, ridge[f]};
      attach(facets[f]);
    });
    ListedTwice twice(facet_name<Dim>(), cells.reference);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (facets[f].element == none)
        fail(cell_word(facet_name<Dim>(), f) + " is not a facet of any " + element_name<Dim>() +
             "; remove it or repair the mesh");
      PatchId& mark =
          making_.mesh.patches_of[facets[f].element][static_cast<std::size_t>(facets[f].facet)];
      if (mark != 0) {
        twice.add(mark - 1, f);
        merge(facets[mark - 1].data, facets[f].data);
        facets[f].element = none;  // to be taken out
        continue;
      }
      mark = static_cast<PatchId>(f + 1);
      if (facets[f].other != none)
        making_.mesh.patches_of[facets[f].other][static_cast<std::size_t>(facets[f].other_facet)] =
            mark;
    }
    if (!twice.empty()) {
      std::erase_if(facets, [](const TaggedFacet<Dim>& facet) { return facet.element == none; });
      making_.warnings.push_back(name_of(making_.any) + ": " + twice.warning());
    }
    return facets;
  }

  /// Finds the elements on both sides of a facet.
  void attach(TaggedFacet<Dim>& facet) const {
    const auto [element, number] = find_facet<Dim>(making_.mesh.elements_of.of(facet.corners[0]),
                                                   making_.mesh.corners_of, facet.corners);
    facet.element = element;
    facet.facet = number;
    if (facet.element == none) return;
    facet.other = making_.neighbours[facet.element][static_cast<std::size_t>(facet.facet)];
    if (facet.other != none)
      facet.other_facet = facet_number<Dim>(making_.mesh.corners_of[facet.other], facet.corners);
  }

  /// Elements, and which of their facets is on the boundary or an interface and has no patch yet.
  runtime::UnsetVector<std::pair<ElementId, int>> unlisted_facets() const {
    return runtime::parallel_collect<std::pair<ElementId, int>>(
        making_.executor, making_.mesh.element_slots(), [&](std::size_t e, auto&& append) {
          for (std::size_t i = 0; i <= Dim; ++i) {
            const ElementId other = making_.neighbours[e][i];
            const bool interface = other != none && other > e &&
                                   making_.mesh.region_of[e] != making_.mesh.region_of[other];
            if ((other == none || interface) && making_.mesh.patches_of[e][i] == 0)
              append({static_cast<ElementId>(e), static_cast<int>(i)});
          }
        });
  }

  /// Boundary facets the file does not list are refused or completed; interfaces between regions
  /// need no listing, but are kept all the same.
  void add_unlisted_facets(std::vector<TaggedFacet<Dim>>& facets) {
    const std::size_t listed = facets.size();
    std::size_t unlisted_boundary = 0;
    const auto unlisted = unlisted_facets();
    for (const auto& [e, i] : unlisted) {
      const bool boundary = making_.neighbours[e][static_cast<std::size_t>(i)] == none;
      if (boundary && !making_.options.complete_boundary) {
        if (making_.is_cut) continue;
        fail_unlisted(e, i, at_one_place(unlisted));
      }
      unlisted_boundary += boundary;
      TaggedFacet<Dim> facet;
      facet.corners = facet_of<Dim>(making_.mesh.corners_of[e], i);
      facet.data = {{}, 0, boundary, making_.options.lock_boundary, false};
      attach(facet);
      facets.push_back(facet);
    }
    if (unlisted_boundary != 0)
      making_.warnings.push_back(name_of(making_.any) + ": " + std::to_string(unlisted_boundary) +
                                 " boundary " + facet_name<Dim>() + "s were not listed (" +
                                 std::to_string(listed) + " were); they get reference 0" +
                                 at_one_place(unlisted).in_file);
  }

  /// Says which vertices of these facets lie where another one does, as on both sides of a crack,
  /// or where a mesh was put together of pieces. Nothing if there are none.
  Wording at_one_place(std::span<const std::pair<ElementId, int>> facets) const {
    std::vector<VertexId> vertices;
    for (const auto& [element, facet] : facets)
      for (const VertexId v : facet_of<Dim>(making_.mesh.corners_of[element], facet))
        vertices.push_back(v);
    const auto key = [&](VertexId v) { return std::pair(position_in<Dim>(making_.any, v).x, v); };
    std::sort(vertices.begin(), vertices.end(),
              [&](VertexId a, VertexId b) { return key(a) < key(b); });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto together = [&](VertexId a, VertexId b) {
      return position_in<Dim>(making_.any, a).x == position_in<Dim>(making_.any, b).x;
    };
    const auto first = std::adjacent_find(vertices.begin(), vertices.end(), together);
    if (first == vertices.end()) return "";
    return "; vertices " + index_word(*first) + " and " + index_word(*(first + 1)) +
           " are at one place: join such vertices, unless there is a crack";
  }

  [[noreturn]] void fail_unlisted(ElementId element, int facet, const Wording& note) const {
    Wording corners = "";
    for (const VertexId v : facet_of<Dim>(making_.mesh.corners_of[element], facet))
      corners = corners + " " + index_word(v);
    const Wording advice("in " + std::string(facets_array<Dim>()) +
                             "; list it, or set MakeMeshOptions::complete_boundary",
                         "in the file; list it, or pass --complete-boundary");
    fail("the boundary " + std::string(facet_name<Dim>()) + " with vertices" + corners + " (of " +
         cell_word(element_name<Dim>(), element) + ") is not listed " + advice +
         " to give unlisted ones reference 0" + note);
  }

  void report_loose_edges(std::size_t count, std::size_t first) {
    if (count == 0) return;
    making_.warnings.push_back(
        name_of(making_.any) + ": " + std::to_string(count) + " of " +
        std::to_string(making_.any.edges.size()) +
        " listed edges belong to no tetrahedron and are left out; the first is " +
        entity("edge", first));
  }

  MeshInMaking<Dim>& making_;
};

}  // namespace

template <int Dim>
std::vector<TaggedFacet<Dim>> tag_facets(MeshInMaking<Dim>& making) {
  return BoundaryTagger<Dim>(making).facets();
}

template <int Dim>
std::vector<ListedEdge> tag_edges(MeshInMaking<Dim>& making) {
  return BoundaryTagger<Dim>(making).edges();
}

template std::vector<TaggedFacet<2>> tag_facets(MeshInMaking<2>&);
template std::vector<TaggedFacet<3>> tag_facets(MeshInMaking<3>&);
template std::vector<ListedEdge> tag_edges(MeshInMaking<2>&);
template std::vector<ListedEdge> tag_edges(MeshInMaking<3>&);

}  // namespace ductile::meshadapt
