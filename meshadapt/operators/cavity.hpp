/// @file
/// Parts that the operators share: small buffers, changes to a vertex's lists, walks over a
/// vertex's neighbourhood, and the replacement of one set of elements by another.
#pragma once

#include <optional>
#include <span>

#include <boost/container/small_vector.hpp>
#include <boost/container/static_vector.hpp>

#include "ductile/runtime/deferred_update.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <class T, std::size_t N>
using Buffer = boost::container::small_vector<T, N>;

/// The elements around one edge; the usual ones fit without the heap.
using Shell = Buffer<ElementId, 16>;
using VertexBuffer = Buffer<VertexId, 64>;

/// Numbers vertices in the order in which they are first met; by hashing, for as few as meet around
/// one vertex. Whether one has been met before cannot be foreseen, so it is no branch.
class Numbering {
 public:
  std::size_t number_of(VertexId vertex) {
    if (size_ >= most_hashed) [[unlikely]]
      return search(vertex);
    vertices_[0] = vertex;  // free places lead here, so that the search ends at one
    std::size_t at = (vertex * 2654435761U) >> 24U;
    while (vertices_[slots_[at]] != vertex) at = (at + 1) % slots_.size();
    vertices_[size_ + 1] = vertex;
    const bool fresh = slots_[at] == 0;
    size_ += fresh;
    slots_[at] = fresh ? static_cast<std::uint8_t>(size_) : slots_[at];
    return slots_[at] - 1U;
  }
  std::size_t size() const { return size_; }
  std::span<const VertexId> vertices() const {
    return size_ <= most_hashed ? std::span(vertices_).subspan(1, size_) : std::span(more_);
  }

 private:
  static constexpr std::size_t most_hashed = 192;

  std::size_t search(VertexId vertex) {
    const std::span<const VertexId> known = vertices();
    const auto at = std::find(known.begin(), known.end(), vertex);
    const auto number = static_cast<std::size_t>(at - known.begin());
    if (at != known.end()) return number;
    if (size_ == most_hashed) more_.assign(known.begin(), known.end());
    more_.push_back(vertex);
    ++size_;
    return number;
  }

  std::size_t size_ = 0;
  std::array<VertexId, most_hashed + 1> vertices_;  // [number + 1], and one that may be anything
  std::vector<VertexId> more_;                      // [number], if there are more
  std::array<std::uint8_t, 256> slots_{};           // number + 1, or 0
};

/// One change to the lists of a vertex, carried out by whoever owns that vertex in the commit.
struct ListChange {
  enum class Kind : std::uint32_t { add_element, remove_element, add_link, remove_link };
  Kind kind;
  std::uint32_t element;  ///< or, for links, the vertex linked to
  CurveId curve = 0;
};

template <int Dim, int Space>
void change_list(Mesh<Dim, Space>& mesh, VertexId owner, const ListChange& change) {
  switch (change.kind) {
    case ListChange::Kind::add_element:
      mesh.elements_of.insert(owner, change.element);
      break;
    case ListChange::Kind::remove_element:
      mesh.elements_of.erase(owner, change.element);
      break;
    case ListChange::Kind::add_link:
      mesh.links_of.insert(owner, {change.element, change.curve});
      break;
    case ListChange::Kind::remove_link:
      mesh.links_of.erase(owner, {change.element, change.curve});
      break;
  }
}

/// Renews what is derived from an element's corners after they, or their sites, changed.
template <int Dim, int Space>
void update_element(Mesh<Dim, Space>& mesh, ElementId element) {
  mesh.quality_of[element] = static_cast<float>(mesh.quality_at(mesh.corners_of[element]));
  mesh.changed_at[element] = mesh.epoch;
}

/// Changes of lists that wait until nobody reads them.
using DeferredLists = runtime::DeferredUpdate<ListChange>;

template <int Dim, int Space>
std::size_t commit_lists(Mesh<Dim, Space>& mesh, DeferredLists& deferred) {
  return deferred.commit(
      [&](VertexId owner, const ListChange& change) { change_list(mesh, owner, change); });
}

/// Changes the lists of vertices, of which others may change the same at the same time: changes are
/// deferred, or made at once under its lock. Lists are sorted, so that they come out the same.
/// Nobody may read the list of a vertex that he shares with others meanwhile.
/// Thread safety: the thread that made it, within one iteration of a loop.
template <int Dim, int Space = Dim>
class SharedLists {
 public:
  using Kind = ListChange::Kind;

  explicit SharedLists(Mesh<Dim, Space>& mesh, DeferredLists* deferred = nullptr) : mesh_(mesh) {
    if (deferred != nullptr) deferrer_ = deferred->mine();
  }

  void add(VertexId owner, ElementId element) const {
    if (deferrer_) [[unlikely]]
      return defer(owner, {Kind::add_element, element});
    const auto held = mesh_.elements_of.hold(owner);
    mesh_.elements_of.insert(owner, element);
  }
  void remove(VertexId owner, ElementId element) const {
    if (deferrer_) [[unlikely]]
      return defer(owner, {Kind::remove_element, element});
    const auto held = mesh_.elements_of.hold(owner);
    mesh_.elements_of.erase(owner, element);
  }
  void replace(VertexId owner, std::span<const ElementId> gone,
               std::span<const ElementId> come) const {
    if (!deferrer_) [[likely]] {
      const auto held = mesh_.elements_of.hold(owner);
      return mesh_.elements_of.replace(owner, gone, come);
    }
    for (const ElementId e : gone) remove(owner, e);
    for (const ElementId e : come) add(owner, e);
  }
  void change_link(VertexId owner, const ListChange& change) const {
    if (deferrer_) return defer(owner, change);
    const auto held = mesh_.links_of.hold(owner);
    change_list(mesh_, owner, change);
  }

 private:
  /// Not inlined, so that changes at once stay as short as they are.
  [[gnu::noinline]] void defer(VertexId owner, const ListChange& change) const {
    deferrer_->defer(owner, change);
  }

  Mesh<Dim, Space>& mesh_;
  std::optional<runtime::Deferrer<ListChange, runtime::CommitOrder::any>> deferrer_;
};

/// Do elements close a ring around this vertex, in which each neighbour comes first in the facet
/// opposite to the vertex of one element?
template <int Dim, int Space>
bool is_in_a_ring(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  return Dim == 2 && mesh.kind_of[vertex].class_dimension == Dim;
}

/// Those corners of a triangle from which the other two follow in descending order: two, or one
/// twice; decided without branches. Triangles that close a ring around a corner all in the same
/// turn name it at least once, as what goes round in it cannot ascend in all of them.
inline std::array<VertexId, 2> before_descents(const Facet<3>& facet) {
  const auto [a, b, c] = facet;
  const VertexId if_not_c = c > a ? b : a, if_not_a = c > a ? b : c;
  return {b > c ? a : if_not_a, a > b ? c : if_not_c};
}

/// Visits the vertices that share an element with `vertex`, some of them several times, unless they
/// are in a ring.
template <int Dim, int Space>
void visit_neighbours(const Mesh<Dim, Space>& mesh, VertexId vertex, auto&& visit) {
  if (is_in_a_ring(mesh, vertex)) {
    for (const ElementId element : mesh.elements_of.of(vertex))
      visit(facet_opposite<Dim>(mesh.corners_of[element], vertex)[0]);
    return;
  }
  if constexpr (Dim == 3)
    // Inside there is a ring around every edge.
    if (mesh.kind_of[vertex].class_dimension == Dim) {
      for (const ElementId element : mesh.elements_of.of(vertex))
        for (const VertexId other :
             before_descents(facet_opposite<Dim>(mesh.corners_of[element], vertex)))
          visit(other);
      return;
    }
  for (const ElementId element : mesh.elements_of.of(vertex))
    for (const VertexId other : facet_opposite<Dim>(mesh.corners_of[element], vertex)) visit(other);
}

/// The vertices that share an element with `vertex`, each once, in an order that follows from the
/// order of its elements.
template <int Dim, int Space>
VertexBuffer neighbours_of(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  VertexBuffer neighbours;
  if (is_in_a_ring(mesh, vertex)) {
    visit_neighbours(mesh, vertex, [&](VertexId other) { neighbours.push_back(other); });
    return neighbours;
  }
  Numbering seen;
  visit_neighbours(mesh, vertex, [&](VertexId other) { seen.number_of(other); });
  neighbours.assign(seen.vertices().begin(), seen.vertices().end());
  return neighbours;
}

/// Gives an element the number of one that is gone.
template <int Dim, int Space>
void move_element(Mesh<Dim, Space>& mesh, ElementId from, ElementId to) {
  const SharedLists<Dim, Space> lists(mesh);
  for (const VertexId v : mesh.corners_of[from]) {
    if (v == none) break;
    lists.remove(v, from);
    lists.add(v, to);
  }
  mesh.corners_of[to] = mesh.corners_of[from];
  mesh.patches_of[to] = mesh.patches_of[from];
  mesh.region_of[to] = mesh.region_of[from];
  mesh.quality_of[to] = mesh.quality_of[from];
  mesh.changed_at[to] = mesh.changed_at[from];
  mesh.corners_of[from].fill(none);
}

/// Reaches for a vertex and its neighbours: whoever has these may change the elements around the
/// vertex, but not read the lists of its neighbours, which others may be changing; see SharedLists.
template <int Dim, int Space>
bool reach_ball(const Mesh<Dim, Space>& mesh, VertexId vertex, auto& reach) {
  if (!reach(vertex)) return false;
  bool reached = true;
  visit_neighbours(mesh, vertex, [&](VertexId other) { reached = reached && reach(other); });
  return reached;
}

/// The patch on which the edge a-b of this element lies, judging by the element's own facets.
template <int Dim, int Space>
PatchId patch_of_edge(const Mesh<Dim, Space>& mesh, ElementId element, VertexId a, VertexId b) {
  const Corners<Dim>& corners = mesh.corners_of[element];
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (corners[i] != a && corners[i] != b && mesh.patches_of[element][i] != 0)
      return mesh.patches_of[element][i];
  return 0;
}

/// Elements to go and elements to come, of the same region, filling the same space. Old numbers are
/// used again first; `fresh` ones only when there are more new elements than old.
template <int Dim>
struct Replacement {
  static constexpr std::size_t most_old = Dim == 2 ? 2 : 7;
  static constexpr std::size_t most_new = Dim == 2 ? 2 : 10;
  boost::container::static_vector<ElementId, most_old> old_elements;
  boost::container::static_vector<Corners<Dim>, most_new> new_elements;
  boost::container::static_vector<Facet<Dim>, 2> new_facets;  ///< new boundary facets ...
  PatchId new_patch = 0;                                      ///< ... and the patch they lie on
  friend bool operator==(const Replacement&, const Replacement&) = default;
};

template <std::size_t N>
std::array<VertexId, N> sorted(std::array<VertexId, N> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

template <int Dim>
struct FacetOnPatch {
  Facet<Dim> corners;  // sorted
  PatchId patch;
};

/// The facets that lie on patches before or after a replacement.
template <int Dim, int Space>
Buffer<FacetOnPatch<Dim>, 16> tagged_facets(const Mesh<Dim, Space>& mesh,
                                            const Replacement<Dim>& plan) {
  Buffer<FacetOnPatch<Dim>, 16> tagged;
  for (const ElementId e : plan.old_elements)
    for (std::size_t i = 0; i <= Dim; ++i)
      if (mesh.patches_of[e][i] != 0)
        tagged.push_back({sorted(facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i))),
                          mesh.patches_of[e][i]});
  for (const Facet<Dim>& facet : plan.new_facets) tagged.push_back({sorted(facet), plan.new_patch});
  return tagged;
}

/// Carries out a replacement: outer facets keep their patches. fresh() is the number of an element
/// that is not there yet. Thread safety: any thread, if nobody reads or writes the elements to go,
/// or reads the lists of their corners.
template <int Dim, int Space>
void replace(Mesh<Dim, Space>& mesh, const Replacement<Dim>& plan,
             const SharedLists<Dim, Space>& lists, auto&& fresh) {
  const auto tagged = tagged_facets(mesh, plan);
  const std::uint32_t region = mesh.region_of[plan.old_elements[0]];
  for (std::size_t n = 0; n < plan.new_elements.size(); ++n) {
    const ElementId e = n < plan.old_elements.size() ? plan.old_elements[n] : fresh();
    Corners<Dim> before;
    before.fill(none);
    if (n < plan.old_elements.size()) before = mesh.corners_of[e];
    for (const VertexId v : before)
      if (v != none && !contains(plan.new_elements[n], v)) lists.remove(v, e);
    for (const VertexId v : plan.new_elements[n])
      if (!contains(before, v)) lists.add(v, e);
    mesh.corners_of[e] = plan.new_elements[n];
    mesh.region_of[e] = region;
    update_element(mesh, e);
    mesh.patches_of[e].fill(0);
    for (std::size_t i = 0; i <= Dim && !tagged.empty(); ++i) {
      const Facet<Dim> facet = sorted(facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i)));
      for (const FacetOnPatch<Dim>& t : tagged)
        if (t.corners == facet) mesh.patches_of[e][i] = t.patch;
    }
  }
  for (std::size_t n = plan.new_elements.size(); n < plan.old_elements.size(); ++n) {
    Corners<Dim>& corners = mesh.corners_of[plan.old_elements[n]];
    for (const VertexId v : corners) lists.remove(v, plan.old_elements[n]);
    corners.fill(none);
  }
}

}  // namespace ductile::meshadapt
