/// @file
/// The check of a mesh as it will be written. Facets, those of elements and those listed, are put
/// into buckets by their lowest vertex; equal facets then lie close together.
#include "ductile/meshadapt/check_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "checks/problems.hpp"
#include "core/orientation.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/facet_key.hpp"
#include "mesh/grouping.hpp"

namespace ductile::meshadapt {

using runtime::atomic_count;
using runtime::Executor;
using runtime::parallel_for;

namespace {

/// A facet in the bucket of its lowest vertex.
struct Entry {
  std::uint64_t others;  // its other vertices, ascending
  std::uint32_t owner;   // element, or number in the list
  std::uint8_t kind;     // of Kind
  friend bool operator<(const Entry& a, const Entry& b) {
    if (a.others != b.others) return a.others < b.others;
    return a.kind != b.kind ? a.kind < b.kind : a.owner < b.owner;
  }
};

/// An element's facet, by the parity of its corners' order, or a listed one.
enum Kind : std::uint8_t { even, odd, listed };

/// The faults of one facet. The first entry with this number of its bucket's group is `owner`.
enum Fault : std::uint8_t { sound, crowded, unlisted, not_a_facet, listed_twice };

template <int Dim>
class AnyMeshChecker {
 public:
  AnyMeshChecker(const Executor& executor, const AnyMesh& mesh)
      : executor_(executor), mesh_(mesh), problems_(executor) {}

  std::vector<std::string> run() {
    if (check_indices()) {
      check_volumes();
      check_vertices();
      check_facets();
      if constexpr (Dim == 3) check_edges();
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
        mesh_.coordinates.size() == mesh_.vertex_count() * Dim ? 0 : 1,
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
    std::array<Vector<Dim>, Dim + 1> p;
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t axis = 0; axis < Dim; ++axis)
        p[i].x[axis] = mesh_.coordinates[elements().vertices[element][i] * std::size_t{Dim} + axis];
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

  static Entry make_entry(const Facet<Dim>& corners, std::uint32_t owner) {
    const FacetKey key = key_of<Dim>(corners);
    return {key.others, owner, static_cast<std::uint8_t>(key.odd ? odd : even)};
  }

  /// Those of the elements, one after the other, then those listed.
  std::size_t facet_count() const { return elements().size() * (Dim + 1) + facets().size(); }

  Facet<Dim> corners_of(std::size_t facet) const {
    const std::size_t element = facet / (Dim + 1);
    if (element < elements().size())
      return facet_of<Dim>(elements().vertices[element], static_cast<int>(facet % (Dim + 1)));
    return facets().vertices[facet - elements().size() * (Dim + 1)];
  }

  Entry entry_of(std::size_t facet) const {
    const std::size_t element = facet / (Dim + 1);
    if (element < elements().size())
      return make_entry(corners_of(facet), static_cast<std::uint32_t>(element));
    const std::size_t number = facet - elements().size() * (Dim + 1);
    Entry entry = make_entry(corners_of(facet), static_cast<std::uint32_t>(number));
    entry.kind = listed;
    return entry;
  }

  void fill_buckets() {
    const auto lowest_corner = [this](std::uint32_t facet, auto&& visit) {
      const Facet<Dim> corners = corners_of(facet);
      visit(*std::min_element(corners.begin(), corners.end()));
    };
    end_.resize(mesh_.vertex_count());
    Grouping grouping(executor_,
                      GroupingBounds::even(executor_, facet_count(), mesh_.vertex_count()),
                      std::span(end_), lowest_corner);
    entries_ = runtime::make_unset_vector<Entry>(executor_, grouping.size());
    grouping.list(
        [&](std::uint32_t place, std::uint32_t facet) { entries_[place] = entry_of(facet); });
  }

  std::span<Entry> bucket(std::size_t v) {
    const std::uint32_t begin = v == 0 ? 0 : end_[v - 1];
    return {entries_.data() + begin, end_[v] - begin};
  }

  /// Are these all sound, and few? Counts each facet in a table.
  static bool are_few_and_sound(std::span<const Entry> bucket) {
    constexpr std::size_t most = 128;  // an inner vertex has 72 in the mean, if it is the lowest
    static_assert(most < 256, "a counter is a byte");
    if (bucket.size() > most) return false;
    struct Place {
      std::uint64_t others;
      std::uint32_t counts;  // a byte for each kind; 0 if it is free
    };
    std::array<Place, 4 * most> places;
    const std::span table = std::span(places).first(facet_table_size(bucket.size()));
    std::fill(table.begin(), table.end(), Place{0, 0});
    const auto is_free = [](const Place& place) { return place.counts == 0; };
    for (const Entry& entry : bucket) {
      Place& place = facet_place(table, entry.others, is_free);
      place.others = entry.others;
      place.counts += 1U << 8U * entry.kind;
    }
    return std::all_of(table.begin(), table.end(), [&](const Place& place) {
      const auto count = [&place](Kind kind) {
        return static_cast<int>(place.counts >> 8U * kind & 255U);
      };
      return is_free(place) || fault({count(even), count(odd), count(listed)}) == sound;
    });
  }

  /// Sorts a bucket and sets its faults.
  void find_faults(std::size_t v) {
    const std::span<Entry> all = bucket(v);
    std::sort(all.begin(), all.end());
    for (std::size_t at = 0, end = 0; at != all.size(); at = end) {
      std::array<int, 3> count{};
      for (; end != all.size() && all[end].others == all[at].others; ++end) ++count[all[end].kind];
      faults_[static_cast<std::size_t>(&all[at] - entries_.data())] = fault(count);
    }
  }

  static Fault fault(const std::array<int, 3>& count) {
    if (count[even] > 1 || count[odd] > 1) return crowded;
    if (count[even] + count[odd] == 0) return not_a_facet;
    if (count[listed] > 1) return listed_twice;
    return count[even] + count[odd] + count[listed] == 1 ? unlisted : sound;
  }

  void check_facets() {
    fill_buckets();
    const auto suspects = runtime::parallel_collect<VertexId>(executor_, mesh_.vertex_count(),
                                                              [&](std::size_t v, auto&& append) {
                                                                if (!are_few_and_sound(bucket(v)))
                                                                  append(static_cast<VertexId>(v));
                                                              });
    if (suspects.empty()) return;
    faults_.assign(facet_count(), sound);
    parallel_for(executor_, suspects.size(), [&](std::size_t i) { find_faults(suspects[i]); });
    const auto expect_no = [&](Fault fault, const std::string& before, const char* after) {
      problems_.expect_none(
          faults_.size(), [&](std::size_t i) { return faults_[i] == fault; },
          [&](std::size_t i) { return before + number(entries_[i].owner) + after; });
    };
    expect_no(crowded, std::string("a facet of ") + element_name,
              " has two elements on one side, or more than two");
    expect_no(unlisted, std::string("a boundary facet of ") + element_name, " is not listed");
    expect_no(not_a_facet, facet_name, " is no facet of an element");
    expect_no(listed_twice, std::string("a facet of ") + element_name, " is listed twice");
  }

  // ---- Vertices and edges ----

  void check_vertices() {
    std::vector<std::uint8_t> used(mesh_.vertex_count(), 0);
    parallel_for(executor_, elements().size(), [&](std::size_t e) {
      for (const VertexId v : elements().vertices[e]) runtime::atomic_set(used[v]);
    });
    problems_.expect_none(
        used.size(), [&](std::size_t v) { return used[v] == 0; },
        [](std::size_t v) { return "vertex " + number(v) + " belongs to no element"; });
  }

  /// Listed edges are few: the edges of elements are looked up among them.
  void check_edges() {
    const std::size_t count = mesh_.edges.size();
    std::vector<std::uint64_t> key(count);
    std::vector<std::uint8_t> at_edge(mesh_.vertex_count(), 0);
    for (std::size_t i = 0; i < count; ++i) {
      const auto [a, b] = mesh_.edges.vertices[i];
      key[i] = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
      at_edge[a] = at_edge[b] = 1;
    }
    std::sort(key.begin(), key.end());
    problems_.expect_none(
        count, [&](std::size_t i) { return i > 0 && key[i] == key[i - 1]; },
        [&](std::size_t i) {
          return "the edge of vertices " + number(key[i] >> 32U) + " and " +
                 number(key[i] & 0xffffffffU) + " is listed twice";
        });
    std::vector<std::uint32_t> found(count, 0);
    parallel_for(executor_, elements().size(), [&](std::size_t e) {
      for (const auto& [i, j] : Simplex<Dim>::edge) {
        const VertexId a = elements().vertices[e][static_cast<std::size_t>(i)];
        const VertexId b = elements().vertices[e][static_cast<std::size_t>(j)];
        if (!at_edge[a] || !at_edge[b]) continue;
        const std::uint64_t wanted = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
        const auto at = std::lower_bound(key.begin(), key.end(), wanted);
        if (at != key.end() && *at == wanted)
          atomic_count(found[static_cast<std::size_t>(at - key.begin())]);
      }
    });
    problems_.expect_none(
        count, [&](std::size_t i) { return found[i] == 0 && (i == 0 || key[i] != key[i - 1]); },
        [&](std::size_t i) {
          return "the listed edge of vertices " + number(key[i] >> 32U) + " and " +
                 number(key[i] & 0xffffffffU) + " is no edge of an element";
        });
  }

  const Executor& executor_;
  const AnyMesh& mesh_;
  Problems problems_;
  std::vector<std::uint32_t> end_;       // [vertex], of its bucket in entries_
  runtime::UnsetVector<Entry> entries_;  // by bucket; sorted where they may have faults
  std::vector<std::uint8_t> faults_;     // [entry], of the group that starts there
};

}  // namespace

std::vector<std::string> check_mesh(const Executor& executor, const AnyMesh& mesh) {
  if (mesh.dimension == 2) return AnyMeshChecker<2>(executor, mesh).run();
  if (mesh.dimension == 3) return AnyMeshChecker<3>(executor, mesh).run();
  return {"the dimension is " + std::to_string(mesh.dimension) + ", expected 2 or 3"};
}

}  // namespace ductile::meshadapt
