/// @file
/// Refine: splits edges that are too long. One edge at a time and the longest first, in independent
/// sets: a new vertex near the middle of the edge cuts every element around it in two.
#pragma once

#include <array>
#include <optional>

#include "ductile/meshadapt/background.hpp"
#include "ductile/meshadapt/rules.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

struct LongEdge {
  VertexId a, b;
  float length;
  friend auto operator<=>(const LongEdge&, const LongEdge&) = default;
};

template <int Dim>
struct EdgeSplit {
  VertexId a = none, b = none;
  Site<Dim> site;  // of the new vertex
  ElementId host = none;
  VertexKind kind;
  std::uint32_t entity = 0;  // patch or curve that the edge lies on, or 0
  std::int32_t reference = 0;
  Shell shell;  // the elements to be halved
  friend bool operator==(const EdgeSplit&, const EdgeSplit&) = default;
};

template <int Dim>
class Refine {
 public:
  // ---- What it works on ----
  using Item = LongEdge;
  using Plan = EdgeSplit<Dim>;
  using Update = ListChange;
  static constexpr bool forgoes_wakes = true;  // the next stage looks at what has changed

  Refine(Mesh<Dim>& mesh, const Background<Dim>& background, const Rules& rules)
      : mesh_(mesh), background_(background), rules_(rules) {}

  /// The edges no shorter than `long_edge`, each once, next to elements changed after an epoch.
  static std::vector<LongEdge> long_edges(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                          double long_edge, std::uint32_t after);

  // ---- Plan: where the new vertex goes, unless a rule refuses. Reads only. ----
  std::optional<Plan> plan(const Item& edge) const;

  // ---- Conflict rule: nobody else touches the elements around the edge; the longest goes first
  // ----
  void footprint(const Item& edge, auto&& visit) const {
    for (const ElementId element : mesh_.elements_of.of(edge.a))
      if (contains(mesh_.corners_of[element], edge.b)) visit(element);
  }
  std::size_t resource_count() const { return mesh_.element_slots(); }
  std::uint8_t priority(const Item& edge) const;

  // ---- Apply: halve the elements around the edge, defer the change of their vertices' lists ----
  std::array<std::uint32_t, 2> demand(const Plan& plan) const {
    return {1, static_cast<std::uint32_t>(plan.shell.size())};
  }
  std::array<std::uint32_t, 2> grow(const std::array<std::uint32_t, 2>& total);
  void apply(const Plan& plan, runtime::Commit<Refine>& commit);

  // ---- Commit: one owner's list ----
  void commit(std::uint32_t owner, const Update& update) { change_list(mesh_, owner, update); }

 private:
  // ---- Rules ----
  bool may_split(const Shell& shell, VertexId a, VertexId b) const;
  bool keeps_shapes(const Plan& plan, double length) const;
  bool makes_no_short_edge(const Plan& plan) const;

  void locate(Plan& plan) const;
  void split_element(ElementId element, ElementId fresh, VertexId middle, const Plan& plan);

  Mesh<Dim>& mesh_;
  const Background<Dim>& background_;
  Rules rules_;
};

}  // namespace ductile::meshadapt
