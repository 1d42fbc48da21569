/// @file
/// Together: the colours of serial first-fit, on many threads. A sample of vertices shows how the
/// order lies in the graph: short windows are used if neighbours are far apart, planes if it is a
/// 3D grid in natural order, parts if neighbours are close. In any other order vertices would wait
/// for each other in a chain, so one thread does all.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "ductile/runtime/colouring/detail/parts_in_order.hpp"
#include "ductile/runtime/colouring/detail/windows_in_order.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"

namespace ductile::runtime::detail {

/// How a colouring in order is divided.
struct Shares {
  enum Kind { none, windows, parts } kind = none;
  std::uint32_t window = 0;  ///< vertices in each
};

/// Examines the order of a graph that is not small.
template <Graph G>
class OrderOfGraph {
 public:
  OrderOfGraph(const Executor& executor, const G& graph)
      : executor_(executor), graph_(graph), n_(graph.vertex_count()) {
    for (std::size_t i = 0; i < sampled; ++i) look_at(sample_[i] = mix64(i + 1) % n_);
  }

  Shares shares() const {
    if (entries_of_hubs_ > entries_ / 8) return {};
    if (chained_ <= sampled / 8) return {Shares::windows, short_window};
    if (const std::size_t row = row_of_grid(); row > 0) {
      // Reading few neighbours takes less time than fetching the colours of the previous row from
      // another core, so planes are shared, and rows are not.
      const bool pays = row >= least_row && row * 4 * threads_ <= n_ && entries_ >= 10 * sampled;
      return pays ? Shares{Shares::windows, static_cast<std::uint32_t>(row)} : Shares{};
    }
    // Repair in order takes longer than resolving clashes.
    const std::size_t share = executor_.deterministic() ? 64 : 16;
    return crossing_ <= sampled / share ? Shares{Shares::parts} : Shares{};
  }

 private:
  static constexpr std::size_t sampled = 512, least_row = 512, most_looks = 16384;

  void look_at(std::size_t v) {
    const std::size_t part = v * threads_ / n_;
    const std::size_t begin = n_ * part / threads_, end = n_ * (part + 1) / threads_;
    std::size_t degree = 0;
    bool crosses = false;
    each(v, [&](std::size_t u) {
      ++degree;
      crosses = crosses || u < begin || u >= end;
    });
    entries_ += degree;
    if (degree >= many_neighbours) entries_of_hubs_ += degree;
    if (crosses) ++crossing_;
    if (gap_before(v) <= threads_ * short_window) ++chained_;
  }

  template <class Visit>
  void each(std::size_t v, Visit visit) const {
    graph_.for_each_neighbour(static_cast<std::uint32_t>(v),
                              [&](std::uint32_t u) { visit(std::size_t{u}); });
  }

  /// Distance from v back to its nearest earlier neighbour; more than n if there is none.
  std::size_t gap_before(std::size_t v) const {
    std::size_t gap = n_ + 1;
    each(v, [&](std::size_t u) {
      if (u < v) gap = std::min(gap, v - u);
    });
    return gap;
  }

  /// Distance from v back to its farthest earlier neighbour.
  std::size_t reach_before(std::size_t v) const {
    std::size_t reach = 0;
    each(v, [&](std::size_t u) { reach = std::max(reach, u < v ? v - u : 0); });
    return reach;
  }

  /// Length of a grid's rows, or of its planes if larger; 0 if it is no grid. Where a row begins,
  /// the previous vertex is no neighbour; where a plane begins, nor is any vertex of the previous
  /// row. All neighbours reach equally far back, farther than a row.
  std::size_t row_of_grid() const {
    std::array<std::size_t, sampled> reach_of;
    std::transform(sample_.begin(), sample_.end(), reach_of.begin(),
                   [&](std::size_t v) { return reach_before(v); });
    const std::size_t reach = *std::max_element(reach_of.begin(), reach_of.end());
    if (std::count(reach_of.begin(), reach_of.end(), reach) < long{sampled} / 2) return 0;
    std::size_t row = 1;
    for (std::size_t v = row; v <= reach && v <= most_looks * row; v += row)
      if (gap_before(v) > row) row = v;
    const bool is_grid = std::all_of(sample_.begin(), sample_.end(), [&](std::size_t v) {
      return follows_row_before(v, row) && follows_row_before(v / row * row, row);
    });
    return row > 1 && is_grid ? row : 0;
  }

  /// Are v's earlier neighbours in its own row, or nearly a whole row before it?
  bool follows_row_before(std::size_t v, std::size_t row) const {
    bool follows = true;
    each(v, [&](std::size_t u) {
      follows = follows && (u >= v || u / row == v / row || v - u >= row - row / 4);
    });
    return follows;
  }

  const Executor& executor_;
  const G& graph_;
  std::size_t n_, threads_ = static_cast<std::size_t>(executor_.threads());
  std::array<std::size_t, sampled> sample_{};      // vertices
  std::size_t entries_ = 0, entries_of_hubs_ = 0;  // in the sample's rows
  std::size_t chained_ = 0;                        // wait for one just before them
  std::size_t crossing_ = 0;                       // have neighbours in another thread's part
};

struct Together {
  static constexpr std::uint32_t marks = 2 * window_marks;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> colours) {
    const Shares shares = OrderOfGraph<G>(executor, graph).shares();
    if (shares.kind == Shares::windows) {
      WindowsRun<Width, G>(executor, graph, colours, shares.window).run();
    } else {
      PartsRun<Width, G>(executor, graph, colours).run();
    }
  }
};

}  // namespace ductile::runtime::detail
