/// @file
/// The check of a mesh as it will be written.
#include "ductile/meshadapt/check_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "checks/faults.hpp"
#include "checks/problems.hpp"
#include "core/determinant.hpp"
#include "core/orientation.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/scale.hpp"
#include "mesh/sorted_cells.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim, int Space = Dim>
class AnyMeshChecker {
 public:
  explicit AnyMeshChecker(const AdjacentMesh& mesh)
      : executor_(mesh.executor()), adjacent_(mesh), mesh_(mesh.mesh()), problems_(executor_) {}

  std::vector<std::string> run() {
    if (check_indices()) {
      check_volumes();
      check_vertices();
      if constexpr (Dim == Space)
        check_facets();
      else
        check_doubled();
      if constexpr (Space == 3) check_edges();
    }
    return problems_.take();
  }

 private:
  static constexpr const char* element_name = Dim == 2 ? "triangle " : "tetrahedron ";
  static constexpr const char* facet_name = Dim == 2 ? "edge " : "triangle ";

  const Cells<Dim + 1>& elements() const { return elements_in<Dim>(mesh_); }
  const Cells<Dim>& facets() const { return facets_in<Dim>(mesh_); }
  static std::string number(std::size_t i) { return std::to_string(i + 1); }

  // ---- Indices ----

  template <int N>
  bool check_cells(const Cells<N>& cells, const std::string& name) {
    problems_.expect_none(
        cells.reference.size() == cells.size() ? 0 : 1, [](std::size_t) { return true; },
        [&](std::size_t) { return "not every " + name + "has a reference"; });
    return problems_.expect_none(
        cells.size(),
        [&](std::size_t i) {
          const auto& corners = cells.vertices[i];
          for (std::size_t a = 0; a < N; ++a) {
            if (corners[a] >= mesh_.vertex_count()) return true;
            for (std::size_t b = 0; b < a; ++b)
              if (corners[a] == corners[b]) return true;
          }
          return false;
        },
        [&](std::size_t i) {
          return name + number(i) + " names a vertex twice or one that does not exist";
        });
  }

  bool check_list(const std::vector<std::uint32_t>& list, std::size_t limit, const char* name) {
    return problems_.expect_none(
        list.size(), [&](std::size_t i) { return list[i] >= limit; },
        [&](std::size_t i) { return std::string(name) + " " + number(i) + " does not exist"; });
  }

  bool check_indices() {
    bool good = problems_.expect_none(
        mesh_.coordinates.size() == mesh_.vertex_count() * Space ? 0 : 1,
        [](std::size_t) { return true; },
        [](std::size_t) { return "not every vertex has its coordinates"; });
    good = check_cells(elements(), element_name) && good;
    good = check_cells(facets(), facet_name) && good;
    if constexpr (Dim == 3) good = check_cells(mesh_.edges, "edge ") && good;
    good = check_list(mesh_.corners, mesh_.vertex_count(), "corner") && good;
    good = check_list(mesh_.required_vertices, mesh_.vertex_count(), "required vertex") && good;
    good = check_list(mesh_.ridges, mesh_.edges.size(), "ridge") && good;
    good = check_list(mesh_.required_edges, mesh_.edges.size(), "required edge") && good;
    good =
        check_list(mesh_.required_triangles, mesh_.triangles.size(), "required triangle") && good;
    return check_list(mesh_.required_tetrahedra, mesh_.tetrahedra.size(), "required tetrahedron") &&
           good;
  }

  // ---- Volumes ----

  int orientation_of(std::size_t element) const {
    const auto p = points_in<Space>(mesh_, elements().vertices[element]);
    if constexpr (Dim < Space)
      return certain_area(p[0], p[1], p[2]) > 0 ? 1 : 0;
    else
      return orientation<Dim>(p);
  }

  void check_volumes() {
    problems_.expect_none(
        elements().size(), [&](std::size_t e) { return orientation_of(e) <= 0; },
        [&](std::size_t e) {
          return element_name + number(e) +
                 (orientation_of(e) < 0 ? " is inverted" : " has no volume");
        });
  }

  // ---- Facets ----

  static ElementFacet place(std::size_t i) {
    return {static_cast<ElementId>(i / (Dim + 1)), static_cast<int>(i % (Dim + 1))};
  }
  std::uint32_t& first_listed(const ElementFacet& place) {
    return first_listed_[place.element * std::size_t{Dim + 1} +
                         static_cast<std::size_t>(place.facet)];
  }

  /// Finds which facets of elements are listed, and where each listed facet is.
  void find_listed() {
    const Adjacency<Dim>& adjacency = adjacent_.adjacency<Dim>();
    first_listed_ =
        runtime::make_filled<std::uint32_t>(executor_, (Dim + 1) * elements().size(), none);
    place_of_ = runtime::make_unset_vector<ElementFacet>(executor_, facets().size());
    parallel_for(executor_, facets().size(), [&](std::size_t f) {
      const ElementFacet here = place_of_[f] = adjacency.find(facets().vertices[f]);
      if (here.element == none) return;
      runtime::atomic_min(first_listed(here), static_cast<std::uint32_t>(f));
      const ElementFacet there = adjacency.other_side(here);
      if (there.element != none)
        runtime::atomic_min(first_listed(there), static_cast<std::uint32_t>(f));
    });
  }

  bool is_crowded(const ElementFacet& at) const {
    return adjacent_.adjacency<Dim>().across(at.element, at.facet) == crowded;
  }
  static std::string facet_of_element(ElementId element) {
    return std::string("facet of ") + element_name + number(element);
  }

  void check_facets() {
    const Adjacency<Dim>& adjacency = adjacent_.adjacency<Dim>();
    find_listed();
    problems_.expect_none(
        first_listed_.size(),
        [&](std::size_t i) { return is_crowded(place(i)) && adjacency.is_first(place(i)); },
        [&](std::size_t i) {
          return "a " + facet_of_element(place(i).element) +
                 " has two elements on one side, or more than two";
        });
    problems_.expect_none(
        first_listed_.size(),
        [&](std::size_t i) {
          const auto [element, facet] = place(i);
          return first_listed_[i] == none && adjacency.across(element, facet) == none;
        },
        [&](std::size_t i) {
          return "a boundary " + facet_of_element(place(i).element) + " is not listed";
        });
    problems_.expect_none(
        place_of_.size(), [&](std::size_t f) { return place_of_[f].element == none; },
        [&](std::size_t f) { return facet_name + number(f) + " is no facet of an element"; });
    check_listed_once();
  }

  void check_listed_once() {
    std::vector<std::uint8_t> again(place_of_.size(), 0);
    parallel_for(executor_, again.size(), [&](std::size_t f) {
      if (place_of_[f].element == none || is_crowded(place_of_[f])) return;
      const std::uint32_t first = first_listed(place_of_[f]);
      if (first != f) runtime::atomic_set(again[first]);
    });
    problems_.expect_none(
        again.size(), [&](std::size_t f) { return again[f] != 0; },
        [&](std::size_t f) {
          const ElementId other = adjacent_.adjacency<Dim>().other_side(place_of_[f]).element;
          return "a " + facet_of_element(other == none ? place_of_[f].element : other) +
                 " is listed twice";
        });
  }

  /// Of a surface, because facets show that of other meshes.
  void check_doubled() {
    const auto key = sorted_cells(executor_, elements().vertices);
    problems_.expect_none(
        key.size(), [&](std::size_t i) { return i != 0 && key[i].first == key[i - 1].first; },
        [&](std::size_t i) {
          return element_name + number(key[i].second) + " has the corners of " + element_name +
                 number(key[i - 1].second);
        });
  }

  // ---- Vertices and edges ----

  void check_vertices() {
    const VertexElements& lists = adjacent_.lists<Dim>();
    problems_.expect_none(
        mesh_.vertex_count(),
        [&](std::size_t v) { return lists.elements_of(static_cast<VertexId>(v)).empty(); },
        [](std::size_t v) { return "vertex " + number(v) + " belongs to no element"; });
  }

  void check_edges() {
    const std::size_t count = mesh_.edges.size();
    std::vector<std::uint64_t> key(count);
    parallel_for(executor_, count, [&](std::size_t i) {
      const auto [a, b] = mesh_.edges.vertices[i];
      key[i] = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
    });
    runtime::parallel_sort(executor_, std::span(key));
    const auto name_of = [&](std::size_t i) {
      return "edge of vertices " + number(key[i] >> 32U) + " and " + number(key[i] & 0xffffffffU);
    };
    const auto is_first = [&](std::size_t i) { return i == 0 || key[i] != key[i - 1]; };
    problems_.expect_none(
        count, [&](std::size_t i) { return !is_first(i); },
        [&](std::size_t i) { return "the " + name_of(i) + " is listed twice"; });
    const VertexElements& lists = adjacent_.lists<Dim>();
    const auto is_edge = [&](std::size_t i) {
      const auto a = static_cast<VertexId>(key[i] >> 32U), b = static_cast<VertexId>(key[i]);
      const auto around = lists.elements_of(a);
      return std::any_of(around.begin(), around.end(),
                         [&](ElementId e) { return contains(elements().vertices[e], b); });
    };
    problems_.expect_none(
        count, [&](std::size_t i) { return is_first(i) && !is_edge(i); },
        [&](std::size_t i) { return "the listed " + name_of(i) + " is no edge of an element"; });
  }

  const Executor& executor_;
  const AdjacentMesh& adjacent_;
  const AnyMesh& mesh_;
  Problems problems_;
  runtime::UnsetVector<std::uint32_t> first_listed_;  // [element][facet], none
  runtime::UnsetVector<ElementFacet> place_of_;       // [listed facet]
};

}  // namespace

std::vector<std::string> mesh_faults(const AdjacentMesh& mesh) {
  const int dimension = mesh.mesh().dimension;
  if (is_surface(mesh.mesh())) return AnyMeshChecker<2, 3>(mesh).run();
  if (dimension == 2) return AnyMeshChecker<2>(mesh).run();
  if (dimension == 3) return AnyMeshChecker<3>(mesh).run();
  return {"the dimension is " + std::to_string(dimension) + ", expected 2 or 3"};
}

std::vector<std::string> check_mesh(const Executor& executor, const AnyMesh& mesh) {
  return mesh_faults({executor, mesh});
}

}  // namespace ductile::meshadapt
