/// @file
/// The core number of each vertex: the greatest k such that the vertex has k neighbours left when
/// vertices with fewer than k neighbours are removed repeatedly. Peels one shell after the other.
/// This loop has no conflicts, so it uses the building blocks of run_rounds: the losses of a
/// shell's neighbours are deferred, and a vertex that falls to k joins the worklist. As an operator
/// with levels, a vertex would have to reach for all its neighbours, because a count is no minimum
/// that several may lower: the neighbours of a hub would run one by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/worklist.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

class Peeling {
 public:
  Peeling(const runtime::Executor& executor, runtime::CsrGraph<> graph)
      : core_of(graph.vertex_count()),
        executor_(executor),
        graph_(graph),
        degree_of_(graph.vertex_count()),
        losses_(executor),
        fallen_(executor) {
    runtime::parallel_for(executor, degree_of_.size(), [&](std::size_t v) {
      degree_of_[v] = graph.offset[v + 1] - graph.offset[v];
    });
  }

  /// Peels the k-shells for k = 0, 1, ... until no vertex is left.
  runtime::RoundsReport run() {
    runtime::RoundsReport report;
    for (std::uint32_t k = 0; report.applied < core_of.size(); ++k) {
      for (runtime::UnsetVector<Vertex> shell = vertices_of_degree(k); !shell.empty();) {
        ++report.rounds;
        report.planned += shell.size();
        report.applied += shell.size();
        peel(shell, k);
        fallen_.collect();
        shell = fallen_.take();
      }
    }
    return report;
  }

  std::vector<std::uint32_t> core_of;  // [vertex]

 private:
  struct Loss {};

  /// Vertices of degree k that are left. Peeled vertices keep their last degree, which is less than
  /// k.
  runtime::UnsetVector<Vertex> vertices_of_degree(std::uint32_t k) const {
    return runtime::parallel_collect<Vertex>(executor_, degree_of_.size(),
                                             [&](std::size_t v, auto&& append) {
                                               if (degree_of_[v] == k)
                                                 append(static_cast<Vertex>(v));
                                             });
  }

  /// Removes vertices of degree k. Degrees are read meanwhile and change only when losses are
  /// committed; they stop at k, so a vertex falls to k only once.
  void peel(std::span<const Vertex> shell, std::uint32_t k) {
    const auto take_away = [&](std::size_t i, auto& losses) {
      core_of[shell[i]] = k;
      graph_.for_each_neighbour(shell[i], [&](Vertex other) {
        if (degree_of_[other] > k) losses.defer(other, {});
      });
    };
    runtime::parallel_for(executor_, shell.size(), runtime::with(losses_), take_away);
    losses_.commit([&](Vertex vertex, Loss) {
      if (degree_of_[vertex] > k && --degree_of_[vertex] == k) fallen_.mine().append(vertex);
    });
  }

  const runtime::Executor& executor_;
  runtime::CsrGraph<> graph_;
  std::vector<std::uint32_t> degree_of_;  // [vertex], among those not peeled
  runtime::DeferredUpdate<Loss> losses_;
  runtime::Worklist<Vertex> fallen_;
};

/// Returns the core numbers, [vertex]; fills in a report if there is one.
inline std::vector<std::uint32_t> core_numbers_in_parallel(
    const runtime::Executor& executor, runtime::CsrGraph<> graph,
    runtime::RoundsReport* report = nullptr) {
  Peeling peeling(executor, graph);
  const runtime::RoundsReport rounds = peeling.run();
  if (report) *report = rounds;
  return peeling.core_of;
}

}  // namespace example
