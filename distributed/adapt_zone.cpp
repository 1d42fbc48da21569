#include "distributed/adapt_zone.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "distributed/listed.hpp"
#include "ductile/meshadapt/metric.hpp"

namespace ductile::distributed {

using meshadapt::Metric;
using meshadapt::none;

namespace {

/// Copies a vertex to another part. Returns its number there.
template <int Dim>
VertexId add_vertex(Part& to, const Part& from, VertexId v) {
  const auto tensor =
      from.wanted.values.begin() + static_cast<std::ptrdiff_t>(v) * Metric<Dim>::size;
  const auto place = from.mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(v) * Dim;
  to.wanted.values.insert(to.wanted.values.end(), tensor, tensor + Metric<Dim>::size);
  to.mesh.coordinates.insert(to.mesh.coordinates.end(), place, place + Dim);
  to.mesh.vertex_reference.push_back(from.mesh.vertex_reference[v]);
  to.number_of.push_back(from.number_of[v]);
  return static_cast<VertexId>(to.wanted.vertex_count++);
}

/// Copies elements, facets and edges with their vertices from one part to another.
template <int Dim>
class Taking {
 public:
  Taking(Part& to, const Part& from) : to_(to), from_(from), now_(from.number_of.size(), none) {}

  void add_elements(const AnyMesh& mesh, auto&& is_taken) {
    const auto& elements = meshadapt::elements_in<Dim>(mesh);
    for (std::uint32_t e = 0; e < elements.size(); ++e)
      if (is_taken(e))
        meshadapt::elements_in<Dim>(to_.mesh).add(there(elements.vertices[e]),
                                                  elements.reference[e]);
  }

  /// Copies facets or, in 3D, edges.
  template <int Corners>
  void add_listed(const AnyMesh& mesh, const meshadapt::Cells<Corners>& cells, auto&& is_taken) {
    const std::vector<Marks> marks = marks_of(mesh, cells);
    for (std::uint32_t i = 0; i < cells.size(); ++i)
      if (is_taken(cells.vertices[i], cells.reference[i]))
        list(to_.mesh, there(cells.vertices[i]), cells.reference[i], marks[i]);
  }

  /// The number of a vertex in the new part, or none.
  VertexId now(VertexId v) const { return now_[v]; }
  /// Sets the number of a vertex that is already there.
  void set(VertexId v, VertexId is) { now_[v] = is; }

 private:
  template <std::size_t N>
  std::array<VertexId, N> there(std::array<VertexId, N> corners) {
    for (VertexId& v : corners) {
      if (now_[v] == none) now_[v] = add_vertex<Dim>(to_, from_, v);
      v = now_[v];
    }
    return corners;
  }

  Part& to_;
  const Part& from_;
  std::vector<VertexId> now_;  // [vertex of from]
};

/// Splits a part in two, adapts the second and joins them again.
template <int Dim>
class Zone {
 public:
  Zone(const runtime::Executor& executor, const Part& part, const Interfaces& interfaces,
       const std::vector<std::uint8_t>& is_held)
      : part_(part),
        interfaces_(interfaces),
        is_held_(is_held),
        executor_(executor),
        around_(elements_around<Dim>(executor, part.mesh)),
        outer_(empty_part(Dim)),
        inner_(empty_part(Dim)),
        to_outer_(outer_, part),
        to_inner_(inner_, part) {}

  AdaptedPart adapt(const AdaptPartOptions& options) {
    divide();
    inner_.mesh.name = part_.mesh.name;
    list_boundary(executor_, inner_);
    find_required();
    AdaptedPart adapted = adapt_part(executor_, std::move(inner_), required_, options);
    return joined(std::move(adapted));
  }

 private:
  /// Splits the part. Facets and edges on the border go with the inner part.
  void divide() {
    const AnyMesh& mesh = part_.mesh;
    for (const bool inside : {true, false}) {
      Taking<Dim>& to = inside ? to_inner_ : to_outer_;
      to.add_elements(mesh, [&](std::uint32_t e) { return (is_held_[e] != 0) == inside; });
      const auto is_taken = [&](const auto& corners, std::int32_t) {
        bool is_inner = false;
        visit_beside<Dim>(mesh, around_, corners,
                          [&](std::uint32_t e) { is_inner = is_inner || is_held_[e] != 0; });
        return is_inner == inside;
      };
      to.add_listed(mesh, meshadapt::facets_in<Dim>(mesh),
                    [&](const auto& corners, std::int32_t reference) {
                      return reference != unlabelled && is_taken(corners, reference);
                    });
      if constexpr (Dim == 3) to.add_listed(mesh, mesh.edges, is_taken);
    }
  }

  /// Finds what the inner part shares with the outer one or with other ranks.
  void find_required() {
    std::vector<VertexId> was(inner_.number_of.size(), none);  // [inner vertex]
    for (VertexId v = 0; v < part_.number_of.size(); ++v)
      if (to_inner_.now(v) != none) was[to_inner_.now(v)] = v;
    std::vector<std::uint8_t> is_shared(part_.number_of.size(), 0);
    for (const SharedVertex& shared : interfaces_.vertices) is_shared[shared.vertex] = 1;
    for (VertexId v = 0; v < was.size(); ++v)
      if (is_shared[was[v]] != 0 || to_outer_.now(was[v]) != none) {
        required_.vertices.push_back({v, {}});
        was_required_.push_back(was[v]);
      }
    using Facet = meshadapt::Facet<Dim>;
    const auto sorted = [](Facet facet) {
      std::sort(facet.begin(), facet.end());
      return facet;
    };
    std::set<Facet> on_interfaces;
    for (const SharedFacet& shared : interfaces_.facets)
      on_interfaces.insert(sorted(meshadapt::facets_in<Dim>(part_.mesh).vertices[shared.facet]));
    const auto& facets = meshadapt::facets_in<Dim>(inner_.mesh).vertices;
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
      Facet facet = facets[f];
      for (VertexId& v : facet) v = was[v];
      bool cut = on_interfaces.contains(sorted(facet));
      visit_beside<Dim>(part_.mesh, around_, facet,
                        [&](std::uint32_t e) { cut = cut || is_held_[e] == 0; });
      if (cut) required_.facets.push_back({f, 0});
    }
  }

  /// Joins the outer part and the adapted inner one.
  AdaptedPart joined(AdaptedPart adapted) {
    Taking<Dim> taking(outer_, adapted.part);
    const auto& required = adapted.interfaces.vertices;
    for (std::size_t i = 0; i < required.size(); ++i)
      taking.set(required[i].vertex, to_outer_.now(was_required_[i]));
    const AnyMesh& inner = adapted.part.mesh;
    const auto all = [](const auto&...) { return true; };
    taking.add_elements(inner, all);
    taking.add_listed(inner, meshadapt::facets_in<Dim>(inner), all);
    if constexpr (Dim == 3) taking.add_listed(inner, inner.edges, all);
    std::vector<VertexId> now(part_.number_of.size(), none);
    for (VertexId v = 0; v < now.size(); ++v) now[v] = to_outer_.now(v);
    for (std::size_t i = 0; i < required.size(); ++i)
      now[was_required_[i]] = taking.now(required[i].vertex);
    AdaptedPart result{std::move(outer_), interfaces_, std::move(adapted.report)};
    result.interfaces.facets.clear();
    for (SharedVertex& shared : result.interfaces.vertices) shared.vertex = now[shared.vertex];
    return result;
  }

  const Part& part_;
  const Interfaces& interfaces_;
  const std::vector<std::uint8_t>& is_held_;
  const runtime::Executor& executor_;
  meshadapt::VertexElements around_;
  Part outer_, inner_;
  Taking<Dim> to_outer_, to_inner_;
  Interfaces required_;                 // in the inner part
  std::vector<VertexId> was_required_;  // [required vertex], in the whole part
};

}  // namespace

AdaptedPart adapt_zone(const runtime::Executor& executor, const Part& part,
                       const Interfaces& interfaces, const std::vector<std::uint8_t>& is_held,
                       const AdaptPartOptions& options) {
  const auto held = static_cast<std::size_t>(std::count(is_held.begin(), is_held.end(), 1));
  if (held == is_held.size()) return adapt_part(executor, part, interfaces, options);
  if (held > 0)
    return part.mesh.dimension == 2 ? Zone<2>(executor, part, interfaces, is_held).adapt(options)
                                    : Zone<3>(executor, part, interfaces, is_held).adapt(options);
  AdaptedPart result{part, interfaces, {}};
  result.interfaces.facets.clear();
  return result;
}

}  // namespace ductile::distributed
