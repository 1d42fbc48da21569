#include "ductile/meshadapt/make_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/flatten.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/orientation.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "geometry/classify.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/facet_key.hpp"
#include "mesh/first_bad.hpp"
#include "mesh/listed_twice.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim>
class MeshMaker {
 public:
  MeshMaker(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options,
            Neighbours<Dim>& neighbours, std::vector<std::string>& warnings)
      : executor_(executor),
        any_(any),
        options_(options),
        neighbours_(neighbours),
        warnings_(warnings) {}

  Mesh<Dim> make() {
    check_options();
    check_indices();
    fill();
    orient();
    rebuild_elements_of(executor_, mesh_);
    report_unused_vertices();
    find_neighbours();
    auto facets = listed_facets();
    add_unlisted_facets(facets);
    classify(executor_, mesh_, std::move(facets), listed_edges(), options_);
    return std::move(mesh_);
  }

 private:
  void check_options() const {
    const double tolerance = options_.surface_tolerance, angle = options_.ridge_angle;
    if (!(tolerance == 0 || (tolerance >= smallest_size && tolerance <= largest_size)))
      throw InputError("surface_tolerance: expected 0, or a length from 1e-75 to 1e75, found " +
                       number(tolerance));
    if (!(angle > 0 && angle < 90))
      throw InputError("ridge_angle: expected an angle between 0 and 90 degrees, found " +
                       number(angle));
    check_geometry();
    const auto& kept = options_.keep_facets_at;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] >= any_.vertex_count())
        throw InputError("keep_facets_at[" + std::to_string(i) + "]: expected a vertex below " +
                         std::to_string(any_.vertex_count()) + ", found " +
                         std::to_string(kept[i]));
  }

  void check_geometry() const {
    if (!options_.geometry) return;
    const double tolerance = options_.surface_tolerance;
    if (options_.geometry->dimension() != Dim)
      throw InputError("geometry: expected one of dimension " + std::to_string(Dim) +
                       ", as the mesh is, found dimension " +
                       std::to_string(options_.geometry->dimension()));
    if (tolerance != 0 && tolerance != options_.geometry->tolerance())
      throw InputError("surface_tolerance: expected that of the geometry, " +
                       number(options_.geometry->tolerance()) + ", found " + number(tolerance));
  }

  [[noreturn]] void fail(const Wording& what) const { refuse(name_of(any_) + ": " + what); }

  static Wording element_word(std::size_t e) {
    return entry(elements_array<Dim>(), element_name<Dim>(), e);
  }
  static Wording cell_word(const std::string& kind, std::size_t i) {
    const std::string array = kind == "tetrahedron" ? "tetrahedra" : kind + "s";
    return entry(array + ".vertices", kind, i);
  }
  static Wording place_word(std::size_t coordinate) {
    return {"coordinates[" + std::to_string(coordinate) + "] is",
            entity("vertex", coordinate / Dim) + " has a coordinate"};
  }

  /// The squares of volumes must be numbers, too.
  void check_scale() const {
    constexpr double largest = 1e50, smallest = 1e-50;
    const auto& x = any_.coordinates;
    const std::size_t far =
        first_bad(executor_, x.size(), [&](std::size_t i) { return std::abs(x[i]) > largest; });
    if (far != no_index) fail(place_word(far) + " beyond 1e50; scale the mesh");
    const double extent = runtime::parallel_reduce(
        executor_, x.size(), 0.0, [&](std::size_t i) { return std::abs(x[i] - x[i % Dim]); },
        [](double a, double b) { return std::max(a, b); });
    if (extent < smallest) fail("the mesh is smaller than 1e-50; scale it");
  }

  void check_indices() const {
    expect_coordinates(any_);
    expect_references(any_);
    const auto& cells = elements_in<Dim>(any_);
    if (any_.dimension != Dim) fail("the mesh has the wrong dimension");
    if (cells.size() == 0) {
      const std::string instead = Dim == 3 ? instead_of_tetrahedra(any_) : "";
      fail(std::string("no ") + element_name<Dim>() + " in the mesh" +
           (instead.empty() ? "; there is nothing to adapt" : ", " + instead));
    }
    if (Dim == 2 && any_.tetrahedra.size() != 0) fail("tetrahedra in a mesh of dimension 2");
    if (any_.vertex_count() >= none || cells.size() >= none / 4)
      fail("too many entities for 32-bit numbers");
    const std::size_t bad_vertex =
        first_bad(executor_, any_.coordinates.size(),
                  [&](std::size_t i) { return !std::isfinite(any_.coordinates[i]); });
    if (bad_vertex != no_index)
      fail(place_word(bad_vertex) + Wording(" not", " that is not") + " a finite number");
    check_scale();
    check_cells(cells, element_name<Dim>());
    check_cells(facets_in<Dim>(any_), facet_name<Dim>());
    if constexpr (Dim == 3) check_cells(any_.edges, "edge");
  }

  template <int N>
  void check_cells(const Cells<N>& cells, const char* kind) const {
    const std::size_t bad = first_bad(executor_, cells.size(), [&](std::size_t i) {
      const auto& corners = cells.vertices[i];
      for (std::size_t a = 0; a < corners.size(); ++a) {
        if (corners[a] >= any_.vertex_count()) return true;
        for (std::size_t b = 0; b < a; ++b)
          if (corners[a] == corners[b]) return true;
      }
      return false;
    });
    if (bad == no_index) return;
    for (const std::uint32_t v : cells.vertices[bad])
      if (v >= any_.vertex_count())
        fail(cell_word(kind, bad) + " names vertex " + index_word(v) + ", but there are only " +
             std::to_string(any_.vertex_count()));
    fail(cell_word(kind, bad) + " names the same vertex twice; remove it");
  }

  void fill() {
    const auto& cells = elements_in<Dim>(any_);
    mesh_.elements_of.reset(executor_, 0);
    mesh_.grow(executor_, any_.vertex_count(), cells.size());
    parallel_for(executor_, any_.vertex_count(), [&](std::size_t v) {
      mesh_.site_of[v].position = position_in<Dim>(any_, v);
      mesh_.reference_of[v] = any_.vertex_reference[v];
      mesh_.kind_of[v] = {};
    });
    for (const std::uint32_t v : any_.corners)
      mesh_.kind_of[checked_vertex(v, "corner")].corner = true;
    for (const std::uint32_t v : any_.required_vertices)
      mesh_.kind_of[checked_vertex(v, "required vertex")].required = true;
    parallel_for(executor_, cells.size(), [&](std::size_t e) {
      mesh_.corners_of[e] = cells.vertices[e];
      mesh_.patches_of[e].fill(0);
      mesh_.changed_at[e] = mesh_.epoch;
    });
    const auto& required = Dim == 2 ? any_.required_triangles : any_.required_tetrahedra;
    const auto locked = marked(cells.size(), required, element_name<Dim>());
    number_regions(cells.reference, locked);
  }

  /// Regions are numbered in the order of their first elements.
  void number_regions(const std::vector<std::int32_t>& reference_of,
                      const std::vector<bool>& locked) {
    using Key = std::pair<std::int32_t, bool>;
    constexpr std::size_t block = 8192;
    const std::size_t n = reference_of.size();
    std::vector<std::vector<Key>> found((n + block - 1) / block);  // [block], each once
    const auto key_of = [&](std::size_t e) { return Key{reference_of[e], locked[e]}; };
    const auto find = [&](std::size_t b, std::size_t begin, std::size_t end) {
      std::set<Key> known;
      for (std::size_t e = begin; e < end; ++e)
        if ((e == begin || key_of(e) != key_of(e - 1)) && known.insert(key_of(e)).second)
          found[b].push_back(key_of(e));
    };
    runtime::parallel_for_blocks(executor_, n, block, find);
    std::map<Key, std::uint32_t> number;
    for (const std::vector<Key>& keys : found)
      for (const Key& key : keys)
        if (number.try_emplace(key, static_cast<std::uint32_t>(number.size())).second)
          mesh_.regions.push_back({key.first, key.second});
    parallel_for(executor_, n, [&](std::size_t e) { mesh_.region_of[e] = number.at(key_of(e)); });
  }

  std::uint32_t checked_vertex(std::uint32_t v, const char* what) const {
    if (v >= any_.vertex_count())
      fail(std::string("a ") + what + " names vertex " + index_word(v) + ", but there are only " +
           std::to_string(any_.vertex_count()));
    return v;
  }

  /// One flag per entity: is it in this list of indices?
  std::vector<bool> marked(std::size_t count, const std::vector<std::uint32_t>& list,
                           const char* kind) const {
    std::vector<bool> flags(count, false);
    for (const std::uint32_t i : list) {
      if (i >= count)
        fail(std::string("a required or ridge ") + kind + " has number " + index_word(i) +
             ", but there are only " + std::to_string(count));
      flags[i] = true;
    }
    return flags;
  }

  int orientation(std::size_t e) const {
    std::array<Vector<Dim>, Dim + 1> p;
    for (std::size_t i = 0; i < p.size(); ++i)
      p[i] = mesh_.site_of[mesh_.corners_of[e][i]].position;
    return meshadapt::orientation<Dim>(p);
  }

  /// Turns over what has a negative volume. Whether it was only listed the other way round shows
  /// at its neighbours: an element that is inverted in space lies on their side of a facet then.
  void orient() {
    const std::size_t count = mesh_.element_slots();
    const auto turned = [&](std::size_t e) { return orientation(e) <= 0; };
    if (first_bad(executor_, count, turned) == no_index) return;
    const std::size_t flat =
        first_bad(executor_, count, [&](std::size_t e) { return orientation(e) == 0; });
    if (flat != no_index) fail(element_word(flat) + " has no volume; remove or repair it");
    turned_.resize(count);
    parallel_for(executor_, count, [&](std::size_t e) {
      turned_[e] = turned(e);
      if (turned_[e] != 0) std::swap(mesh_.corners_of[e][0], mesh_.corners_of[e][1]);
    });
    report_turned();
  }

  void report_turned() {
    const auto turned = std::count(turned_.begin(), turned_.end(), 1);
    const auto first = std::find(turned_.begin(), turned_.end(), 1) - turned_.begin();
    if (turned == std::ssize(turned_))
      warnings_.push_back(any_.name + ": all elements were inverted; they have been reoriented");
    else
      warnings_.push_back(any_.name + ": " + std::to_string(turned) + " of " +
                          std::to_string(turned_.size()) +
                          " elements were listed the other way round and have been turned; the "
                          "first is " +
                          entity(element_name<Dim>(), static_cast<std::size_t>(first)));
  }

  void report_unused_vertices() {
    const auto unused = runtime::parallel_reduce(
        executor_, mesh_.vertex_slots(), std::size_t{0},
        [&](std::size_t v) { return std::size_t{!mesh_.vertex_alive(static_cast<VertexId>(v))}; },
        [](std::size_t a, std::size_t b) { return a + b; });
    if (unused != 0)
      warnings_.push_back(any_.name + ": " + std::to_string(unused) + " of " +
                          std::to_string(mesh_.vertex_slots()) +
                          " vertices belong to no element and are left out");
  }

  // ---- Neighbours ----

  static constexpr ElementId crowded = none - 1;  // more than one element across a facet

  /// A facet that has been met, and of which element first; by its lowest corner, as a table keeps
  /// what it has of others.
  struct Met {
    std::uint64_t others = 0;
    VertexId lowest = none;
    ElementId element = none;
    std::uint8_t facet = 0;
    bool odd = false, twice = false;
  };

  void find_neighbours() {
    runtime::FreshMemory fresh;
    neighbours_.resize_for_overwrite(mesh_.element_slots(), fresh);
    fresh.touch(executor_);
    parallel_for(executor_, mesh_.element_slots(),
                 [&](std::size_t e) { neighbours_[e].fill(none); });
    runtime::PerThread<std::vector<Met>> table(executor_);
    parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t v) {
      find_neighbours_at(static_cast<VertexId>(v), table.mine());
    });
    const std::size_t bad = first_bad(executor_, mesh_.element_slots(), [&](std::size_t e) {
      return contains(neighbours_[e], crowded);
    });
    if (bad != no_index) fail_crowded(static_cast<ElementId>(bad));
  }

  /// Neighbours find each other at the lowest corner of their facet.
  void find_neighbours_at(VertexId lowest, std::vector<Met>& table) {
    const auto around = mesh_.elements_of.of(lowest);
    const std::size_t size = facet_table_size(Dim * around.size());
    table.resize(std::max(table.size(), size));
    for (const ElementId element : around) {
      const Corners<Dim>& corners = mesh_.corners_of[element];
      const auto lower = std::count_if(corners.begin(), corners.end(),
                                       [lowest](VertexId v) { return v < lowest; });
      for (int i = 0; i <= Dim; ++i) {
        const VertexId opposite = corners[static_cast<std::size_t>(i)];
        if (opposite != lowest && lower == (opposite < lowest ? 1 : 0))
          meet(lowest, element, i, std::span(table).first(size));
      }
    }
  }

  /// Elements come in order, so the first is the lowest. Facets belong to two, one on each side.
  void meet(VertexId lowest, ElementId element, int facet, std::span<Met> table) {
    const FacetKey key = key_of<Dim>(facet_of<Dim>(mesh_.corners_of[element], facet));
    const auto neighbour_at = [this](ElementId e, int i) -> ElementId& {
      return neighbours_[e][static_cast<std::size_t>(i)];
    };
    const auto is_free = [lowest](const Met& met) { return met.lowest != lowest; };
    Met& met = facet_place(table, key.others, is_free);
    if (is_free(met)) {
      met = {key.others, lowest, element, static_cast<std::uint8_t>(facet), key.odd};
    } else if (met.twice || met.odd == key.odd) {
      met.twice = true;
      neighbour_at(met.element, met.facet) = neighbour_at(element, facet) = crowded;
    } else {
      met.twice = true;
      neighbour_at(met.element, met.facet) = element;
      neighbour_at(element, facet) = met.element;
    }
  }

  bool has_all(ElementId element, const Facet<Dim>& corners) const {
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (!contains(mesh_.corners_of[element], corners[i])) return false;
    return true;
  }

  int facet_number(ElementId element, const Facet<Dim>& corners) const {
    for (int i = 0; i <= Dim; ++i)
      if (!contains(corners, mesh_.corners_of[element][static_cast<std::size_t>(i)])) return i;
    return -1;
  }

  [[noreturn]] void fail_crowded(ElementId element) const {
    const auto facet = corner_of(neighbours_[element], crowded);
    const Facet<Dim> corners = facet_of<Dim>(mesh_.corners_of[element], facet);
    std::vector<std::pair<Corners<Dim>, ElementId>> crowd;  // by their sorted corners
    for (const ElementId e : mesh_.elements_of.of(corners[0])) {
      Corners<Dim> key = mesh_.corners_of[e];
      std::sort(key.begin(), key.end());
      if (has_all(e, corners)) crowd.emplace_back(key, e);
    }
    std::sort(crowd.begin(), crowd.end());
    const auto both = [](ElementId a, ElementId b) {
      return element_word(a) + " and " + index_word(b);
    };
    for (std::size_t i = 1; i < crowd.size(); ++i)
      if (crowd[i].first == crowd[i - 1].first)
        fail(both(crowd[i - 1].second, crowd[i].second) + " are the same element; remove one");
    const ElementId other = crowd[0].second == element ? crowd[1].second : crowd[0].second;
    if (crowd.size() == 2 && !turned_.empty() && turned_[element] != turned_[other])
      fail_inverted(turned_[element] != 0 ? element : other,
                    turned_[element] != 0 ? other : element);
    fail(both(element, other) + " overlap, or share " + (Dim == 2 ? "an edge" : "a triangle") +
         " with a third; a facet may belong to two elements at most, one on each side");
  }

  [[noreturn]] void fail_inverted(ElementId element, ElementId neighbour) const {
    fail(entity(element_name<Dim>(), element) + " is inverted: it overlaps " + element_name<Dim>() +
         " " + std::to_string(neighbour + 1) + ", which it shares a facet with; repair the mesh");
  }

  // ---- Facets and edges ----

  std::vector<TaggedFacet<Dim>> listed_facets() {
    const auto& cells = facets_in<Dim>(any_);
    const auto& required_list = Dim == 2 ? any_.required_edges : any_.required_triangles;
    const auto required = marked(cells.size(), required_list, facet_name<Dim>());
    const auto ridge =
        marked(cells.size(), Dim == 2 ? any_.ridges : std::vector<std::uint32_t>{}, "edge");
    std::vector<TaggedFacet<Dim>> facets(cells.size());
    parallel_for(executor_, cells.size(), [&](std::size_t f) {
      facets[f].corners = cells.vertices[f];
      facets[f].data = {
          {}, cells.reference[f], true, required[f] || options_.lock_boundary, ridge[f]};
      attach(facets[f]);
    });
    ListedTwice twice(facet_name<Dim>(), cells.reference);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (facets[f].element == none)
        fail(cell_word(facet_name<Dim>(), f) + " is not a facet of any " + element_name<Dim>() +
             "; remove it or repair the mesh");
      PatchId& mark =
          mesh_.patches_of[facets[f].element][static_cast<std::size_t>(facets[f].facet)];
      if (mark != 0) {
        twice.add(mark - 1, f);
        merge(facets[mark - 1].data, facets[f].data);
        facets[f].element = none;  // to be taken out
        continue;
      }
      mark = static_cast<PatchId>(f + 1);
      if (facets[f].other != none)
        mesh_.patches_of[facets[f].other][static_cast<std::size_t>(facets[f].other_facet)] = mark;
    }
    if (!twice.empty()) {
      std::erase_if(facets, [](const TaggedFacet<Dim>& facet) { return facet.element == none; });
      warnings_.push_back(any_.name + ": " + twice.warning());
    }
    return facets;
  }

  /// What is listed twice is all that either one is; its reference is that of the first.
  template <class Listed>
  static void merge(Listed& first, const Listed& again) {
    first.required = first.required || again.required;
    first.ridge = first.ridge || again.ridge;
  }

  /// Finds the elements on both sides of a facet.
  void attach(TaggedFacet<Dim>& facet) const {
    for (const ElementId e : mesh_.elements_of.of(facet.corners[0]))
      if (facet.element == none && has_all(e, facet.corners)) {
        facet.element = e;
        facet.facet = facet_number(e, facet.corners);
      }
    if (facet.element == none) return;
    facet.other = neighbours_[facet.element][static_cast<std::size_t>(facet.facet)];
    if (facet.other != none) facet.other_facet = facet_number(facet.other, facet.corners);
  }

  /// Elements, and which of their facets is on the boundary or an interface and has no patch yet.
  runtime::UnsetVector<std::pair<ElementId, int>> unlisted_facets() const {
    return runtime::parallel_collect<std::pair<ElementId, int>>(
        executor_, mesh_.element_slots(), [&](std::size_t e, auto&& append) {
          for (std::size_t i = 0; i <= Dim; ++i) {
            const ElementId other = neighbours_[e][i];
            const bool interface =
                other != none && other > e && mesh_.region_of[e] != mesh_.region_of[other];
            if ((other == none || interface) && mesh_.patches_of[e][i] == 0)
              append({static_cast<ElementId>(e), static_cast<int>(i)});
          }
        });
  }

  /// Boundary facets the file does not list are refused or completed; interfaces between regions
  /// need no listing, but are kept all the same.
  void add_unlisted_facets(std::vector<TaggedFacet<Dim>>& facets) {
    const std::size_t listed = facets.size();
    std::size_t unlisted_boundary = 0;
    for (const auto& [e, i] : unlisted_facets()) {
      const bool boundary = neighbours_[e][static_cast<std::size_t>(i)] == none;
      if (boundary && !options_.complete_boundary) fail_unlisted(e, i);
      unlisted_boundary += boundary;
      TaggedFacet<Dim> facet;
      facet.corners = facet_of<Dim>(mesh_.corners_of[e], i);
      facet.data = {{}, 0, boundary, options_.lock_boundary, false};
      attach(facet);
      facets.push_back(facet);
    }
    if (unlisted_boundary != 0)
      warnings_.push_back(any_.name + ": " + std::to_string(unlisted_boundary) + " boundary " +
                          facet_name<Dim>() + "s were not listed (" + std::to_string(listed) +
                          " were); they get reference 0");
  }

  [[noreturn]] void fail_unlisted(ElementId element, int facet) const {
    Wording corners = "";
    for (const VertexId v : facet_of<Dim>(mesh_.corners_of[element], facet))
      corners = corners + " " + index_word(v);
    const Wording advice("in " + std::string(facets_array<Dim>()) +
                             "; list it, or set MakeMeshOptions::complete_boundary",
                         "in the file; list it, or pass --complete-boundary");
    fail("the boundary " + std::string(facet_name<Dim>()) + " with vertices" + corners + " (of " +
         element_word(element) + ") is not listed " + advice +
         " to give unlisted ones reference 0");
  }

  /// Edges that belong to no element, as construction lines do, are left out.
  std::vector<ListedEdge> listed_edges() {
    std::vector<ListedEdge> edges;
    if constexpr (Dim == 3) {
      const auto required = marked(any_.edges.size(), any_.required_edges, "edge");
      const auto ridge = marked(any_.edges.size(), any_.ridges, "edge");
      std::size_t first_loose = no_index, loose = 0;
      std::vector<ElementId> shell;
      std::vector<std::size_t> number_of;                          // [edge taken], as listed
      std::unordered_map<std::uint64_t, std::size_t> index_among;  // by both vertices
      ListedTwice twice("edge", any_.edges.reference);
      for (std::size_t i = 0; i < any_.edges.size(); ++i) {
        const auto [a, b] = any_.edges.vertices[i];
        shell_of(mesh_, a, b, shell);
        if (shell.empty()) {
          if (loose++ == 0) first_loose = i;
          continue;
        }
        const ListedEdge edge{a, b, any_.edges.reference[i], required[i], ridge[i]};
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
      if (!twice.empty()) warnings_.push_back(any_.name + ": " + twice.warning());
      report_loose_edges(loose, first_loose);
    }
    return edges;
  }

  void report_loose_edges(std::size_t count, std::size_t first) {
    if (count == 0) return;
    warnings_.push_back(any_.name + ": " + std::to_string(count) + " of " +
                        std::to_string(any_.edges.size()) +
                        " listed edges belong to no tetrahedron and are left out; the first is " +
                        entity("edge", first));
  }

  const Executor& executor_;
  const AnyMesh& any_;
  const MakeMeshOptions& options_;
  Neighbours<Dim>& neighbours_;
  std::vector<std::string>& warnings_;
  Mesh<Dim> mesh_;
  std::vector<std::uint8_t> turned_;  // [element], 1 if it had to be; empty: none had
};

}  // namespace

template <int Dim>
Mesh<Dim> make_mesh(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options,
                    Neighbours<Dim>& neighbours, std::vector<std::string>& warnings) {
  return MeshMaker<Dim>(executor, any, options, neighbours, warnings).make();
}

template Mesh<2> make_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&, Neighbours<2>&,
                           std::vector<std::string>&);
template Mesh<3> make_mesh(const Executor&, const AnyMesh&, const MakeMeshOptions&, Neighbours<3>&,
                           std::vector<std::string>&);

}  // namespace ductile::meshadapt
