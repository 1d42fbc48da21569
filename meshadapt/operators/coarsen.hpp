/// @file
/// Coarsen: collapses edges that are too short. A vertex is moved onto a neighbour and disappears,
/// with the elements on the edge between them; those left around it are stretched to the neighbour.
/// run_rounds runs it in surveyed tiles, as collapses change who conflicts with whom.
#pragma once

#include <optional>

#include "ductile/meshadapt/rules.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "operators/cavity.hpp"
#include "operators/edge_survey.hpp"

namespace ductile::meshadapt {

struct EdgeCollapse {
  /// Vertices that the collapse gives an edge shorter than the rules want; if there are more than
  /// fit, as rarely happens, `many` is set.
  struct Crowded {
    static constexpr std::size_t most = 8;
    boost::container::static_vector<VertexId, most> vertices;
    bool many = false;
    friend bool operator==(const Crowded&, const Crowded&) = default;
  };
  VertexId gone, kept;
  Crowded crowded = {};
  /// What the elements that stay will have, in the order of the list of `gone`; if there are more,
  /// the first.
  static constexpr std::size_t most_shapes = 40;
  boost::container::static_vector<float, most_shapes> shapes = {};
  friend bool operator==(const EdgeCollapse&, const EdgeCollapse&) = default;
};

template <int Dim>
class Coarsen {
 public:
  // ---- What it works on ----
  using Item = VertexId;
  using Plan = EdgeCollapse;
  struct Update {};  // lists of neighbours are changed at once, as they are sorted
  static constexpr bool keeps_to_neighbours = true;  // reads and writes its own elements
  static constexpr bool forgoes_wakes = true;  // the next sweep finds who is not worth it at once

  Coarsen(Mesh<Dim>& mesh, const Rules& rules);

  /// The vertices with an edge shorter than `short_edge` that could go, next to elements changed
  /// after an epoch.
  static runtime::UnsetVector<VertexId> crowded_vertices(const runtime::Executor& executor,
                                                         const Mesh<Dim>& mesh,
                                                         EdgeSurvey<Dim>& survey, double short_edge,
                                                         std::uint32_t after);

  // ---- Plan: the shortest edge that no rule refuses. Reads only. ----
  std::optional<Plan> plan(VertexId gone) const;

  // ---- Conflict rule: adjacent vertices share elements, so only one of them may go ----
  void conflicts(VertexId vertex, auto&& visit) const { visit_neighbours(mesh_, vertex, visit); }
  std::size_t item_count() const { return mesh_.vertex_slots(); }
  void prefetch(VertexId vertex, int stage) const { prefetch_ball(mesh_, vertex, stage); }

  // ---- Apply: stretch or remove own elements, hold and change lists, wake whom it concerns ----
  void apply(const Plan& plan, runtime::Commit<Coarsen>& commit);

  // ---- Commit: nothing is deferred ----
  void commit(std::uint32_t, const Update&) {}

 private:
  struct Candidate {
    double length;  ///< to the fourth power, by the geometric mean of both ends
    VertexId kept;
    friend auto operator<=>(const Candidate&, const Candidate&) = default;
  };
  /// The neighbours of the vertex that may go, and its edges to them.
  struct Ring {
    VertexBuffer vertices;
    Buffer<EndSquares, 64> edges;
  };
  Ring ring_around(VertexId gone) const;
  Buffer<Candidate, 32> candidates(VertexId gone, const Ring& ring) const;

  // ---- Rules: each one reason to refuse a collapse, named for what it protects ----
  bool keeps_geometry(const Plan& plan) const;
  bool keeps_patches(const Plan& plan) const;
  double longest_allowed(const Ring& ring) const;
  bool keeps_edges_short(const Plan& plan, const Ring& ring, double longest) const;
  bool keeps_shapes(Plan& plan, double worst_before) const;
  bool keeps_surface(const Plan& plan) const;
  bool keeps_sides_apart(const Plan& plan) const;
  bool ends_curve(const Plan& plan) const;
  bool joins_rim(const Plan& plan, ElementId element, std::size_t facet) const;

  bool becomes_crowded(VertexId vertex, const Plan& plan) const;
  EdgeCollapse::Crowded crowded_after(const Plan& plan, const Ring& ring) const;

  void remove_element(ElementId element, const Plan& plan);
  void pass_patch_on(ElementId element, const Plan& plan);
  void join_links(const Plan& plan);

  Mesh<Dim>& mesh_;
  Rules rules_;
  bool has_required_elements_;
};

}  // namespace ductile::meshadapt
