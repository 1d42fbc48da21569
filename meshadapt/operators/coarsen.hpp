/// @file
/// Coarsen: collapses edges that are too short. A vertex is moved onto a neighbour and disappears,
/// with the elements on the edge between them; those left around it are stretched to the neighbour.
/// It runs in tiles, or by colours: collapses change who conflicts with whom.
#pragma once

#include <optional>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "operators/cavity.hpp"
#include "operators/edge_survey.hpp"

namespace ductile::meshadapt {

struct EdgeCollapse {
  VertexId gone, kept;
  Buffer<VertexId, 8> short_edge_vertices;  ///< get an edge shorter than the rules want
  Buffer<float, 40> qualities;  ///< of the elements that stay, in the order of the list of `gone`
  friend bool operator==(const EdgeCollapse&, const EdgeCollapse&) = default;
};

template <int Dim, int Space = Dim>
class Coarsen {
 public:
  // ---- What it works on ----
  using Item = VertexId;
  using Plan = EdgeCollapse;
  static constexpr bool forgoes_wakes = true;  // the next sweep finds who is not worth it at once

  Coarsen(Mesh<Dim, Space>& mesh, const Rules& rules) : mesh_(mesh), rules_(rules) {}

  /// For the strategy `colours`: lists are not changed at once, but by deferred updates.
  void defer_lists(const runtime::Executor& executor) { deferred_.emplace(executor); }

  /// The vertices with an edge shorter than `short_edge` that could go, next to elements changed
  /// after an epoch.
  static runtime::UnsetVector<VertexId> short_edge_vertices(const runtime::Executor& executor,
                                                            const Mesh<Dim, Space>& mesh,
                                                            EdgeSurvey<Dim, Space>& survey,
                                                            double short_edge, std::uint32_t after);

  // ---- Plan: the shortest edge that no rule refuses. Reads only. ----
  bool plan(VertexId gone, Plan& plan, auto& reach) const {
    return reach_ball(mesh_, gone, reach) && decide(gone, plan);
  }
  /// For whoever has reached for the vertex and its neighbours.
  bool decide(VertexId gone, Plan& plan) const;

  // ---- Conflict rule: adjacent vertices share elements, so only one of them may go ----
  void conflicts(VertexId vertex, auto&& visit) const { visit_neighbours(mesh_, vertex, visit); }
  std::size_t resource_count() const { return mesh_.vertex_slots(); }
  void prefetch(VertexId vertex, int stage) const { prefetch_ball(mesh_, vertex, stage); }

  // ---- Apply: stretch or remove own elements, hold and change lists, wake neighbours with a short
  // edge. Only `kept` gets neighbours that it did not have, so it waits for the next round. ----
  void apply(VertexId, const Plan& plan, auto& commit) {
    collapse(plan, SharedLists<Dim, Space>(mesh_, deferred_ ? &*deferred_ : nullptr));
    for (const VertexId v : plan.short_edge_vertices) commit.wake(v);
    if (mesh_.kind_of[plan.kept].class_dimension != 0) commit.postpone(plan.kept);
  }
  std::size_t commit() { return deferred_ ? commit_lists(mesh_, *deferred_) : 0; }

  /// The neighbours of the vertex that may go, and its edges to them.
  struct Ring {
    VertexBuffer vertices;
    Buffer<EndSquares, 64> edges;
  };
  Ring ring_around(VertexId gone) const;

  // ---- Rules: each one reason to refuse a collapse, named for what it protects. Without effect
  // on the mesh, so that a test may ask for each; decide() asks for all. A rule may read the lists
  // of `gone`, but not those of `kept` or another neighbour: a collapse two rings away, with which
  // there is no conflict, may be changing them, and the result would depend on threads ----
  bool keeps_geometry(VertexId gone, VertexId kept) const;
  bool keeps_patches(VertexId gone, VertexId kept) const;
  double longest_allowed(const Ring& ring) const;
  bool keeps_edges_short(const Plan& plan, const Ring& ring, double longest) const;
  bool keeps_quality(Plan& plan, double worst_before) const;
  bool keeps_surface(const Plan& plan) const;
  bool keeps_sides_apart(const Plan& plan) const;

 private:
  struct Candidate {
    double length;  ///< to the fourth power, by the geometric mean of both ends
    VertexId kept;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
  };
  Buffer<Candidate, 32> candidates(VertexId gone, const Ring& ring) const;

  bool ends_curve(const Plan& plan) const;
  bool joins_rim(const Plan& plan, ElementId element, std::size_t facet) const;
  void note_short_edges(Plan& plan, const Ring& ring) const;

  void collapse(const Plan& plan, const SharedLists<Dim, Space>& lists);
  void remove_element(ElementId element, const Plan& plan, const SharedLists<Dim, Space>& lists);
  void pass_patch_on(ElementId element, const Plan& plan);
  void join_links(const Plan& plan, const SharedLists<Dim, Space>& lists);

  Mesh<Dim, Space>& mesh_;
  Rules rules_;
  std::optional<DeferredLists> deferred_;
};

}  // namespace ductile::meshadapt
