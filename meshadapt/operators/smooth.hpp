/// @file
/// Smooth: moves vertices to where their elements are better. Each vertex first goes
/// towards the mean of the places where each of its elements would be regular (a Laplacian in
/// metric space, constrained by quality); where elements stay bad, it climbs towards the place
/// where the worst of them is best, or all are on the whole. Neighbours never move together, so a
/// sweep is a Gauss-Seidel iteration. It runs in tiles.
#pragma once

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "operators/background.hpp"
#include "operators/ball.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/edge_range.hpp"
#include "operators/surface_ball.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
struct VertexMove {
  ElementId host;
  Site<Space> site;
  BallQualities<Dim> qualities;  // of the elements around after the move
  bool far;                      // far enough for its neighbours to be worth another look
  friend bool operator==(const VertexMove&, const VertexMove&) = default;
};

struct SmoothOptions {
  bool laplacian = true;
  double optimise_below = 0.4;  ///< optimise where the worst mean ratio around is below this
  double mean_below = 0;        ///< ... where their mean is below this: the harmonic mean of all,
                                ///< though the worst may get worse
  double far = 0.08;            ///< metric length of a move that neighbours take notice of
  EdgeRange range = {};         ///< which no move leads edges out of, or farther out of
  bool to_surface = false;      ///< only bring vertices closer to the model of the surface
};

template <int Dim, int Space = Dim>
class Smooth {
 public:
  // ---- What it works on ----
  using Item = VertexId;
  using Plan = VertexMove<Dim, Space>;
  static constexpr bool keeps_conflicts = true;  // moving changes no adjacency
  static constexpr bool forgoes_wakes = true;    // the next sweep looks at what has changed

  Smooth(Mesh<Dim, Space>& mesh, const Background<Dim, Space>& background,
         const SmoothOptions& options)
      : mesh_(mesh), background_(background), options_(options) {}

  /// All vertices that may move, next to elements changed after an epoch.
  static runtime::UnsetVector<VertexId> movable_vertices(const runtime::Executor& executor,
                                                         const Mesh<Dim, Space>& mesh,
                                                         std::uint32_t after);
  /// All vertices that may move, next to elements of a mean ratio below a bound that changed after
  /// an epoch.
  static runtime::UnsetVector<VertexId> movable_vertices_of_poor(const runtime::Executor& executor,
                                                                 const Mesh<Dim, Space>& mesh,
                                                                 double mean_ratio,
                                                                 std::uint32_t after);

  /// All vertices of smooth patches and curves next to elements changed after an epoch.
  static runtime::UnsetVector<VertexId> vertices_on_surface(const runtime::Executor& executor,
                                                            const Mesh<Dim, Space>& mesh,
                                                            std::uint32_t after);

  // ---- Plan: a better place, if there is one. Reads only. ----
  bool plan(VertexId vertex, Plan& plan, auto& reach) const {
    return reach_ball(mesh_, vertex, reach) && decide(vertex, plan);
  }
  /// For whoever has reached for the vertex and its neighbours.
  bool decide(VertexId vertex, Plan& plan) const;

  // ---- Conflict rule: a vertex stands still while its neighbours move ----
  void conflicts(VertexId vertex, auto&& visit) const { visit_neighbours(mesh_, vertex, visit); }
  std::size_t resource_count() const { return mesh_.vertex_slots(); }
  void prefetch(VertexId vertex, int stage) const {
    prefetch_ball(mesh_, vertex, stage);
    if (stage == 1) background_.prefetch(mesh_.host_of[vertex]);
  }

  // ---- Apply: move it, renew the qualities around it ----
  void apply(VertexId vertex, const Plan& plan, auto&) { move(vertex, plan); }

  // ---- Rules: each one reason to refuse a place, named for what it protects ----
  bool keeps_volumes(VertexId vertex, const Vector<Space>& position) const;
  bool keeps_surface(VertexId vertex, const Vector<Space>& position) const;
  bool keeps_lengths(VertexId vertex, const Site<Space>& site) const;

 private:
  /// The quantity to raise: the worst quality around, or the harmonic mean of all.
  enum class Aim : std::uint8_t { worst, mean };
  using Score = typename VertexBall<Dim, Space>::Score;
  struct Place {
    Site<Space> site;
    ElementId host;
    Score score;
    BallQualities<Dim> qualities{};
  };
  void move(VertexId vertex, const Plan& plan);
  bool follow(VertexId vertex, const Place& best, Plan& plan) const;
  bool place(const VertexBall<Dim, Space>& ball, const Vector<Space>& position, const Place& near,
             const Score& bar, Place& result) const;
  Vector<Space> allowed(VertexId vertex, Vector<Space> displacement) const;
  Vector<Space> tangent(VertexId vertex) const;
  Vector<Space> normal(VertexId vertex) const;
  std::optional<Vector<Space>> stepped(VertexId vertex, const Vector<Space>& from,
                                       const Vector<Space>& step) const;
  auto visit_sheet(VertexId vertex, auto&& visit) const;
  std::array<VertexId, 2> next_on_curve(VertexId vertex) const;
  /// The patch of a vertex inside of one, of a surface.
  std::uint32_t region_of(VertexId vertex) const {
    return mesh_.region_of[mesh_.elements_of.of(vertex)[0]];
  }
  bool follows_function(VertexId vertex) const;
  bool settle(VertexId vertex, Place& best) const;
  bool relax(VertexId vertex, const VertexBall<Dim, Space>& ball, const Place& from,
             Place& to) const;
  bool optimise(VertexId vertex, const VertexBall<Dim, Space>& ball, Aim aim, Place& best) const;
  Vector<Space> ascent(VertexId vertex, const VertexBall<Dim, Space>& ball, Aim aim,
                       const Place& at) const;
  static double inverse_qualities(const VertexBall<Dim, Space>& ball, const Site<Space>& site);

  Mesh<Dim, Space>& mesh_;
  const Background<Dim, Space>& background_;
  SmoothOptions options_;
};

}  // namespace ductile::meshadapt
