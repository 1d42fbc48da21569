/// @file
/// The core number of each vertex: the greatest k such that it has k neighbours in what is left
/// when vertices with fewer than k neighbours are taken away again and again. Peels shell after
/// shell. This loop has no conflicts to find, so it uses the parts that run_rounds is made of: the
/// losses of a shell's neighbours are deferred, and who falls to k joins the worklist.

#include <cstdio>
#include <span>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/core_numbers.hpp>

#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/worklist.hpp"
#include "example.hpp"
#include "graphs.hpp"

namespace {

using example::Vertex;
namespace runtime = ductile::runtime;

class Peeling {
 public:
  Peeling(const runtime::Executor& executor, runtime::CsrGraph<> graph)
      : core_of(graph.vertex_count()),
        executor_(executor),
        graph_(graph),
        degree_of_(graph.vertex_count()),
        losses_(executor),
        fallen_(executor, {.order = runtime::WorkOrder::arrival}) {
    runtime::parallel_for(executor, degree_of_.size(), [&](std::size_t v) {
      degree_of_[v] = graph.offset[v + 1] - graph.offset[v];
    });
  }

  /// Peels the k-shell for k = 0, 1, ... until nothing is left.
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

  /// None that was peeled: those have kept the degree at which they were, less than k.
  runtime::UnsetVector<Vertex> vertices_of_degree(std::uint32_t k) const {
    return runtime::parallel_collect<Vertex>(executor_, degree_of_.size(),
                                             [&](std::size_t v, auto&& append) {
                                               if (degree_of_[v] == k)
                                                 append(static_cast<Vertex>(v));
                                             });
  }

  /// Takes vertices of degree k away. Degrees are read while they are taken, and change only when
  /// losses are committed; they stop at k, so a vertex falls to it once.
  void peel(std::span<const Vertex> shell, std::uint32_t k) {
    runtime::parallel_for(executor_, shell.size(), [&](std::size_t i) {
      core_of[shell[i]] = k;
      graph_.for_each_neighbour(shell[i], [&](Vertex other) {
        if (degree_of_[other] > k) losses_.defer(other, shell[i], {});
      });
    });
    losses_.commit([&](Vertex vertex, Loss) {
      if (degree_of_[vertex] > k && --degree_of_[vertex] == k) fallen_.append(vertex);
    });
  }

  const runtime::Executor& executor_;
  runtime::CsrGraph<> graph_;
  std::vector<std::uint32_t> degree_of_;  // [vertex], among those not peeled
  runtime::DeferredUpdate<Loss> losses_;
  runtime::Worklist<Vertex> fallen_;
};

/// Core numbers by Boost.Graph.
std::vector<std::uint32_t> boost_core_numbers(runtime::CsrGraph<> graph) {
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
  Graph copy(graph.vertex_count());
  for (Vertex a = 0; a < graph.vertex_count(); ++a)
    graph.for_each_neighbour(a, [&](Vertex b) {
      if (a < b) add_edge(a, b, copy);
    });
  std::vector<std::uint32_t> core_of(graph.vertex_count());
  const double seconds = example::seconds_of([&] {
    boost::core_numbers(
        copy, boost::make_iterator_property_map(core_of.begin(), get(boost::vertex_index, copy)));
  });
  example::print_yardstick("Boost.Graph, one thread", seconds);
  return core_of;
}

void compare(const example::Arguments& arguments) {
  const runtime::CsrRows random_graph =
      example::random_graph(runtime::Executor(), arguments.size, 8 * arguments.size);
  const runtime::CsrGraph<> graph = random_graph.view();
  std::printf("Core numbers of %zu vertices with %zu edges\n", graph.vertex_count(),
              graph.neighbour.size() / 2);
  const auto core_of = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        Peeling peeling(executor, graph);
        report = peeling.run();
        return peeling.core_of;
      });
  std::printf("greatest core number: %u\n", *std::max_element(core_of.begin(), core_of.end()));
  example::require(core_of == boost_core_numbers(graph), "Boost.Graph finds other core numbers");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
