#include "operators/coarsen.hpp"

#include <algorithm>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/edges.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
runtime::UnsetVector<VertexId> Coarsen<Dim, Space>::short_edge_vertices(
    const runtime::Executor& executor, const Mesh<Dim, Space>& mesh, EdgeSurvey<Dim, Space>& survey,
    double short_edge, std::uint32_t after) {
  const auto marked = mark_changed(executor, mesh, after);
  const auto short_edge_vertices =
      mark_ends_of_short_edges(executor, mesh, survey, marked, short_edge);
  const auto find = [&](std::size_t v, auto&& append) {
    if (short_edge_vertices[v] && mesh.kind_of[v].class_dimension != 0)
      append(static_cast<VertexId>(v));
  };
  return runtime::parallel_collect<VertexId>(executor, mesh.vertex_slots(), find,
                                             runtime::few_nanoseconds.serial_below);
}

/// Corners stay, and so does whatever belongs to required entities: its class dimension is 0, too.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::decide(VertexId gone, Plan& plan) const {
  const auto ball = mesh_.elements_of.of(gone);
  if (ball.empty() || ball.size() > mesh_.largest_ball || mesh_.kind_of[gone].class_dimension == 0)
    return false;
  const Ring ring = ring_around(gone);
  const auto choices = candidates(gone, ring);
  if (choices.empty()) return false;
  const double longest = longest_allowed(ring);
  double worst = 1;
  for (const ElementId e : ball) worst = std::min<double>(worst, mesh_.quality_of[e]);
  plan.gone = gone;
  for (const Candidate& choice : choices) {
    plan.kept = choice.kept;
    if (!keeps_edges_short(plan, ring, longest) || !keeps_quality(plan, worst) ||
        !keeps_surface(plan) || !keeps_sides_apart(plan))
      continue;
    note_short_edges(plan, ring);
    return true;
  }
  return false;
}

template <int Dim, int Space>
auto Coarsen<Dim, Space>::ring_around(VertexId gone) const -> Ring {
  Ring ring{neighbours_of(mesh_, gone), {}};
  for (const VertexId v : ring.vertices)
    ring.edges.push_back(end_squares(mesh_.site_of[gone], mesh_.site_of[v]));
  return ring;
}

/// The neighbours to which it is short, and may move, the closest first.
template <int Dim, int Space>
auto Coarsen<Dim, Space>::candidates(VertexId gone, const Ring& ring) const
    -> Buffer<Candidate, 32> {
  Buffer<Candidate, 32> found;
  for (std::size_t i = 0; i < ring.edges.size(); ++i) {
    const EndSquares& edge = ring.edges[i];
    const VertexId kept = ring.vertices[i];
    if (shorter_than(edge, rules_.short_edge) && keeps_geometry(gone, kept))
      found.push_back({edge.at_a * edge.at_b, kept});
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// A vertex leaves a curve only along the curve, and a patch only within the patch. No element on
/// the edge may have two facets on patches there: it would take the boundary with it (such an
/// element is flat but for rounding).
template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_geometry(VertexId gone, VertexId kept) const {
  const int class_dimension = mesh_.kind_of[gone].class_dimension;
  if (class_dimension == Dim) return true;
  for (const ElementId e : mesh_.elements_of.of(gone)) {
    const int at_kept = corner_of(mesh_.corners_of[e], kept);
    if (at_kept >= 0 && mesh_.patches_of[e][static_cast<std::size_t>(at_kept)] != 0) return false;
  }
  if (Dim == 3 && class_dimension == 1)
    return mesh_.curve_of(gone, kept) != 0 && keeps_patches(gone, kept);
  for (const ElementId e : mesh_.elements_of.of(gone))
    if (contains(mesh_.corners_of[e], kept) &&
        patch_of_edge(mesh_, e, gone, kept) == mesh_.entity_of[gone])
      return true;
  return false;
}

/// Between the ends of two smooth curves there may be a last triangle of a patch.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_patches(VertexId gone, VertexId kept) const {
  if (!on_smooth_curve(mesh_, gone) || mesh_.kind_of[kept].class_dimension != 0) return true;
  for (const CurveLink& link : mesh_.links_of.of(gone)) {
    if (link.to == kept || mesh_.kind_of[link.to].class_dimension != 0) continue;
    for (const ElementId e : mesh_.elements_of.of(gone)) {
      const Corners<Dim>& corners = mesh_.corners_of[e];
      if (!contains(corners, kept) || !contains(corners, link.to)) continue;
      for (std::size_t i = 0; i <= Dim; ++i)
        if (mesh_.patches_of[e][i] != 0 && corners[i] != gone && corners[i] != kept &&
            corners[i] != link.to)
          return false;
    }
  }
  return true;
}

/// If edges are too long already, new ones may be nearly as long as the longest of them. The one
/// that looks longest is measured first, so that hardly any other has to be measured closely.
template <int Dim, int Space>
double Coarsen<Dim, Space>::longest_allowed(const Ring& ring) const {
  if (!rules_.extends_long_edges) return rules_.stretched_edge;
  double longest = rules_.long_edge / 1.02;
  const auto looks_shorter = [](const EndSquares& one, const EndSquares& other) {
    return one.at_a * one.at_b < other.at_a * other.at_b;
  };
  const auto first = std::max_element(ring.edges.begin(), ring.edges.end(), looks_shorter);
  if (!shorter_than(*first, longest)) longest = edge_length(*first);
  for (const EndSquares& edge : ring.edges)
    if (!shorter_than(edge, longest)) longest = edge_length(edge);
  return std::max(rules_.stretched_edge, 1.02 * longest);
}

template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_edges_short(const Plan& plan, const Ring& ring,
                                            double longest) const {
  const Site<Space>& kept = mesh_.site_of[plan.kept];
  return std::all_of(ring.vertices.begin(), ring.vertices.end(), [&](VertexId v) {
    return v == plan.kept || shorter_than(mesh_.site_of[v], kept, longest);
  });
}

/// Notes the qualities in the plan.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_quality(Plan& plan, double worst_before) const {
  plan.qualities.clear();
  const double least = std::min(rules_.kept_quality * worst_before, rules_.accepted_quality);
  const bool on_boundary = mesh_.kind_of[plan.gone].class_dimension < Space;
  const Site<Space>& kept = mesh_.site_of[plan.kept];
  for (const ElementId e : mesh_.elements_of.of(plan.gone)) {
    const Corners<Dim>& corners = mesh_.corners_of[e];
    if (contains(corners, plan.kept)) continue;
    if (on_boundary && !keeps_facets_turned(mesh_, e, plan.gone, kept.position)) return false;
    auto sites = mesh_.sites(corners);
    sites[static_cast<std::size_t>(corner_of(corners, plan.gone))] = &kept;
    const double quality = quality_if_above<Dim>(sites, least);
    if (!(quality > 0)) return false;
    plan.qualities.push_back(static_cast<float>(quality));
  }
  return true;
}

/// Last, as it takes the longest.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_surface(const Plan& plan) const {
  if (!mesh_.surface || mesh_.kind_of[plan.gone].class_dimension == Space) return true;
  const Vector<Space>& kept = mesh_.site_of[plan.kept].position;
  if constexpr (Dim == 3)
    if (on_smooth_curve(mesh_, plan.gone))
      for (const CurveLink& link : mesh_.links_of.of(plan.gone))
        if (link.to != plan.kept &&
            !mesh_.surface->edges.cover({mesh_.site_of[link.to].position, kept},
                                        mesh_.curves[link.curve].sheet))
          return false;
  const auto ball = mesh_.elements_of.of(plan.gone);
  return std::all_of(ball.begin(), ball.end(), [&](ElementId e) {
    return contains(mesh_.corners_of[e], plan.kept) ||
           meshadapt::keeps_surface(mesh_, e, plan.gone, kept);
  });
}

/// If another patch has the same rim, as on both sides of a closed crack, an edge from rim to
/// rim may be there as well. Both would become one, and the sides grow together. Such an edge is
/// not made, because the other patch may change at the same time. Nor is a triangle from rim to rim
/// to rim, which might be all that is left of both.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::keeps_sides_apart(const Plan& plan) const {
  const auto on_rim = [&](VertexId v) { return mesh_.kind_of[v].class_dimension < Dim - 1; };
  if (mesh_.kind_of[plan.gone].class_dimension == Dim || !on_rim(plan.kept)) return true;
  if (ends_curve(plan)) return false;
  const auto ball = mesh_.elements_of.of(plan.gone);
  const auto is_joined = [&](VertexId v) {  // by a facet at the edge, or along a curve
    if (Dim == 3 && mesh_.curve_of(plan.gone, v) != 0) return true;
    return std::any_of(ball.begin(), ball.end(), [&](ElementId e) {
      const Corners<Dim>& corners = mesh_.corners_of[e];
      if (!contains(corners, v) || !contains(corners, plan.kept)) return false;
      for (std::size_t i = 0; i <= Dim; ++i)
        if (corners[i] != plan.gone && corners[i] != plan.kept && corners[i] != v &&
            mesh_.patches_of[e][i] != 0)
          return true;
      return false;
    });
  };
  for (const ElementId e : ball)
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (mesh_.corners_of[e][i] == plan.gone || !mesh_.patches[mesh_.patches_of[e][i]].crack_side)
        continue;
      std::size_t joined = 0;
      bool at_kept = false;
      for (const VertexId v : facet_of<Dim>(mesh_.corners_of[e], static_cast<int>(i))) {
        at_kept = at_kept || v == plan.kept;
        if (v == plan.gone || v == plan.kept || !on_rim(v)) continue;
        if (!is_joined(v)) return false;
        ++joined;
      }
      if (Dim == 3 && (at_kept ? joins_rim(plan, e, i) : joined == 2)) return false;
    }
  return true;
}

/// Would a curve on a patch that another one faces become a single edge? Another curve between the
/// same ends might as well, as do the lips of a crack.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::ends_curve(const Plan& plan) const {
  const auto is_end = [&](VertexId v) { return mesh_.kind_of[v].class_dimension == 0; };
  if (Dim == 2 || mesh_.kind_of[plan.gone].class_dimension != 1 || !is_end(plan.kept)) return false;
  for (const CurveLink& link : mesh_.links_of.of(plan.gone))
    if (!is_end(link.to)) return false;
  const auto ball = mesh_.elements_of.of(plan.gone);
  return std::any_of(ball.begin(), ball.end(), [&](ElementId e) {
    for (std::size_t i = 0; i <= Dim; ++i)
      if (mesh_.corners_of[e][i] != plan.gone && mesh_.patches[mesh_.patches_of[e][i]].crack_side)
        return true;
    return false;
  });
}

/// Would the third side of a facet at the edge, opposite to the vertex that goes, be on the rim
/// then? It may be that of a triangle that is all of the patch, and of the other one.
template <int Dim, int Space>
bool Coarsen<Dim, Space>::joins_rim(const Plan& plan, ElementId element, std::size_t facet) const {
  if (Dim == 2 || mesh_.kind_of[plan.gone].class_dimension != 1) return false;
  for (const VertexId v : facet_of<Dim>(mesh_.corners_of[element], static_cast<int>(facet)))
    if (v != plan.gone && v != plan.kept && mesh_.curve_of(plan.gone, v) != 0) return true;
  return false;
}

template <int Dim, int Space>
void Coarsen<Dim, Space>::note_short_edges(Plan& plan, const Ring& ring) const {
  plan.short_edge_vertices.clear();
  for (const VertexId v : ring.vertices)
    if (v != plan.kept && mesh_.kind_of[v].class_dimension != 0 &&
        shorter_than(mesh_.site_of[v], mesh_.site_of[plan.kept], rules_.short_edge))
      plan.short_edge_vertices.push_back(v);
}

template <int Dim, int Space>
void Coarsen<Dim, Space>::collapse(const Plan& plan, const SharedLists<Dim, Space>& lists) {
  Buffer<ElementId, 64> removed, stretched;
  for (const ElementId e : mesh_.elements_of.of(plan.gone))
    (contains(mesh_.corners_of[e], plan.kept) ? removed : stretched).push_back(e);
  for (const ElementId e : removed) pass_patch_on(e, plan);
  for (std::size_t i = 0; i < stretched.size(); ++i) {
    const ElementId e = stretched[i];
    Corners<Dim>& corners = mesh_.corners_of[e];
    corners[static_cast<std::size_t>(corner_of(corners, plan.gone))] = plan.kept;
    mesh_.quality_of[e] = plan.qualities[i];
    mesh_.changed_at[e] = mesh_.epoch;
  }
  for (const ElementId e : removed) remove_element(e, plan, lists);
  lists.replace(plan.kept, std::span(removed.data(), removed.size()),
                std::span(stretched.data(), stretched.size()));
  if (Dim == 3 && mesh_.kind_of[plan.gone].class_dimension == 1) join_links(plan, lists);
  mesh_.elements_of.clear(plan.gone);
}

/// An element on the collapsing edge folds flat: what lies on the patch of its facet at `kept` is
/// afterwards the stretched element across its facet at `gone`.
template <int Dim, int Space>
void Coarsen<Dim, Space>::pass_patch_on(ElementId element, const Plan& plan) {
  const Corners<Dim>& corners = mesh_.corners_of[element];
  const auto at_gone = static_cast<std::size_t>(corner_of(corners, plan.gone));
  const PatchId patch = mesh_.patches_of[element][at_gone];  // of the facet at `kept`
  if (patch == 0) return;
  const int at_kept = corner_of(corners, plan.kept);
  for (const ElementId other : mesh_.elements_of.of(plan.gone)) {
    if (other == element || contains(mesh_.corners_of[other], plan.kept)) continue;
    int shared = 0;
    for (const VertexId v : facet_of<Dim>(corners, at_kept))
      shared += contains(mesh_.corners_of[other], v);
    if (shared < Dim) continue;
    for (std::size_t i = 0; i <= Dim; ++i)
      if (!contains(corners, mesh_.corners_of[other][i])) mesh_.patches_of[other][i] = patch;
  }
}

/// Removes the element, also from the lists of the corners that stay. Another collapse may take
/// elements from the same vertex at the same time.
template <int Dim, int Space>
void Coarsen<Dim, Space>::remove_element(ElementId element, const Plan& plan,
                                         const SharedLists<Dim, Space>& lists) {
  for (const VertexId v : mesh_.corners_of[element])
    if (v != plan.gone && v != plan.kept) lists.remove(v, element);
  mesh_.corners_of[element].fill(none);
}

/// The curve now goes from `kept` straight to the vertex on the other side of `gone`.
template <int Dim, int Space>
void Coarsen<Dim, Space>::join_links(const Plan& plan, const SharedLists<Dim, Space>& lists) {
  using Kind = ListChange::Kind;
  for (const CurveLink& link : mesh_.links_of.of(plan.gone)) {
    lists.change_link(link.to, {Kind::remove_link, plan.gone, link.curve});
    if (link.to == plan.kept) continue;
    lists.change_link(link.to, {Kind::add_link, plan.kept, link.curve});
    lists.change_link(plan.kept, {Kind::add_link, link.to, link.curve});
  }
  mesh_.links_of.clear(plan.gone);
}

template class Coarsen<2>;
template class Coarsen<2, 3>;
template class Coarsen<3>;

}  // namespace ductile::meshadapt
