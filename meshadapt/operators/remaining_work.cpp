#include "operators/remaining_work.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/coarsen.hpp"
#include "operators/edges.hpp"
#include "operators/refine.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
std::size_t RemainingWork<Dim, Space>::count(EdgeSurvey<Dim, Space>& survey) {
  const std::size_t lengths = changes_of_lengths(survey);
  if (lengths > settings_.few) return lengths;
  if (settings_.moves) raised_ = raised();
  if (!settings_.swaps) return lengths + raised_.size();
  const auto swaps = Swap<Dim, Space>::improvements(executor_, mesh_, 0, settings_.swap_below,
                                                    settings_.smooth.range);
  return lengths + raised_.size() + swaps.size();
}

/// From a sample of those that lengths call for; looked at part by part, until they are not few.
template <int Dim, int Space>
std::size_t RemainingWork<Dim, Space>::changes_of_lengths(EdgeSurvey<Dim, Space>& survey) const {
  const Rules& rules = settings_.rules;
  const Coarsen<Dim, Space> coarsening(mesh_, rules);
  const Refine<Dim, Space> refinement(executor_, mesh_, background_, rules);
  ++mesh_.epoch;  // the survey can tell what is there from what will change
  const auto short_edge_vertices =
      Coarsen<Dim, Space>::short_edge_vertices(executor_, mesh_, survey, rules.short_edge, 0);
  const auto edges = long_edges(executor_, mesh_, survey, rules.long_edge, 0);
  const std::size_t all = short_edge_vertices.size() + edges.size(), step = 1 + all / 4096;
  const auto changes_at = [&](std::size_t k) -> std::size_t {
    if (k < short_edge_vertices.size()) {
      EdgeCollapse collapse{};
      return coarsening.decide(short_edge_vertices[k], collapse) ? 1 : 0;
    }
    const LongEdge& edge = edges[k - short_edge_vertices.size()];
    return refinement.splits(edge) ? splits_of(edge, rules.long_edge) : 0;
  };
  std::size_t changes = 0;
  std::array<std::size_t, 256> part;
  for (std::size_t first = 0; first < all / step && changes <= settings_.few;
       first += part.size()) {
    const std::size_t count = std::min(part.size(), all / step - first);
    const auto look = [&](std::size_t i) { part[i] = changes_at((first + i) * step); };
    runtime::parallel_for(executor_, count, look, {.grain = 2});
    changes += step * std::accumulate(part.begin(), part.begin() + count, std::size_t{0});
  }
  return changes;
}

/// Does a move make the worst element around the vertex clearly better? A little better it gets by
/// each move, for ever.
template <int Dim, int Space>
bool RemainingWork<Dim, Space>::is_raised(const Smooth<Dim, Space>& smoothing,
                                          VertexId vertex) const {
  const auto elements = mesh_.elements_of.of(vertex);
  if (elements.size() > BallQualities<Dim>::most) return false;
  VertexMove<Dim, Space> move;
  if (!smoothing.decide(vertex, move)) return false;
  float before = 1, after = 1;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    before = std::min(before, mesh_.quality_of[elements[i]]);
    after = std::min(after, move.qualities[i]);
  }
  return after > 1.1F * before + 0.01F;
}

/// The vertices whose moves make poor elements clearly better.
template <int Dim, int Space>
runtime::UnsetVector<VertexId> RemainingWork<Dim, Space>::raised() const {
  SmoothOptions options = settings_.smooth;
  options.optimise_below = poor;
  const Smooth<Dim, Space> smoothing(mesh_, background_, options);
  const auto around = Smooth<Dim, Space>::movable_vertices_of_poor(executor_, mesh_, poor, 0);
  return runtime::parallel_collect<VertexId>(executor_, around.size(),
                                             [&](std::size_t i, auto&& append) {
                                               if (is_raised(smoothing, around[i]))
                                                 append(around[i]);
                                             });
}

template <int Dim, int Space>
void RemainingWork<Dim, Space>::touch_poor() {
  for (const VertexId v : raised_)
    for (const ElementId e : mesh_.elements_of.of(v)) mesh_.changed_at[e] = mesh_.epoch;
}

template class RemainingWork<2>;
template class RemainingWork<2, 3>;
template class RemainingWork<3>;

}  // namespace ductile::meshadapt
