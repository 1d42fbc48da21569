/// @file
/// The minimum spanning tree of a grid with random weights by contraction, Boruvka's way: every
/// vertex looks for the lightest edge that leaves it, and the two ends become one. Each keeps the
/// edges that leave it in a skew heap, so two heaps melt into one in logarithmic time (Sleator &
/// Tarjan, SIAM J. Comput. 15, 1986). A contraction reserves its two ends. Compared with Kruskal's
/// in Boost.Graph.

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>

#include "ductile/runtime/run_rounds.hpp"
#include "example.hpp"
#include "graphs.hpp"

namespace {

using example::Vertex;
using ArcId = std::uint32_t;
using Weight = std::uint64_t;
namespace runtime = ductile::runtime;

/// All weights differ: the mixer is a bijection.
Weight weight_of(Vertex a, Vertex b) {
  return runtime::mix64(std::uint64_t{std::min(a, b)} << 32U | std::max(a, b));
}

class Contraction {
 public:
  // ---- What it works on: vertices, those contracted into others included ----
  using Item = Vertex;
  struct Plan {
    Vertex item, gone, kept;
  };
  struct Update {
    Vertex parent;
  };

  Contraction(const runtime::Executor& executor, runtime::CsrGraph<> graph)
      : tree_edge_of(graph.vertex_count()),
        parent_of_(graph.vertex_count()),
        size_of_(graph.vertex_count(), 1),
        heap_of_(graph.vertex_count(), none),
        arcs_(graph.neighbour.size()) {
    runtime::parallel_for(executor, graph.vertex_count(), [&](std::size_t i) {
      const auto from = static_cast<Vertex>(i);
      parent_of_[from] = from;
      for (ArcId arc = graph.offset[from]; arc < graph.offset[from + 1]; ++arc) {
        const Vertex to = graph.neighbour[arc];
        arcs_[arc] = {weight_of(from, to), to, none, none};
        heap_of_[from] = melt(heap_of_[from], arc);
      }
    });
  }

  // ---- Plan: contract the lightest edge. Reads only. ----
  std::optional<Plan> plan(Vertex vertex) const {
    const Vertex other = nearest(vertex);
    if (size_of_[vertex] > size_of_[other]) return Plan{vertex, other, vertex};
    return Plan{vertex, vertex, other};
  }
  // ---- Conflict rule: both ends change. A vertex that is gone, or has no edge left, is void. ----
  void footprint(Vertex vertex, auto&& visit) const {
    if (parent_of_[vertex] != vertex || heap_of_[vertex] == none) return;
    visit(vertex);
    visit(nearest(vertex));
  }
  std::size_t resource_count() const { return parent_of_.size(); }
  // ---- Apply: one heap out of two. Others look for `gone`, so telling them has to wait. ----
  void apply(const Plan& plan, auto& commit) {
    tree_edge_of[plan.gone] = arcs_[heap_of_[plan.item]].weight;
    ArcId heap = melt(heap_of_[plan.gone], heap_of_[plan.kept]);
    size_of_[plan.kept] += size_of_[plan.gone];
    if (size_of_[plan.kept] == size_of_.size()) heap = none;  // that was the last edge
    while (heap != none && leads_into(heap, plan)) heap = melt(arcs_[heap].left, arcs_[heap].right);
    heap_of_[plan.kept] = heap;
    commit.defer(plan.gone, {plan.kept});
    if (plan.kept == plan.item) commit.wake(plan.kept);  // else it still waits for its own turn
  }
  // ---- Commit: from now on the vertex is its parent ----
  void commit(std::uint32_t gone, const Update& update) { parent_of_[gone] = update.parent; }

  std::vector<Weight> tree_edge_of;  // [vertex], the edge by which it was contracted, or 0

 private:
  struct Arc {
    Weight weight;
    Vertex target;  // it may have been contracted since
    ArcId left, right;
  };
  static constexpr ArcId none = 0xffffffffU;

  /// What a vertex has become. The larger takes in the smaller, so the way there is short.
  Vertex root(Vertex vertex) const {
    while (parent_of_[vertex] != vertex) vertex = parent_of_[vertex];
    return vertex;
  }
  Vertex nearest(Vertex vertex) const { return root(arcs_[heap_of_[vertex]].target); }

  bool leads_into(ArcId arc, const Plan& plan) {
    arcs_[arc].target = root(arcs_[arc].target);
    return arcs_[arc].target == plan.gone || arcs_[arc].target == plan.kept;
  }

  /// One heap of two: merges their right spines and swaps the children on the way.
  ArcId melt(ArcId a, ArcId b) {
    ArcId top = none;
    for (ArcId* place = &top;; place = &arcs_[*place].left) {
      if (a == none || b == none) {
        *place = a == none ? b : a;
        return top;
      }
      if (arcs_[b].weight < arcs_[a].weight) std::swap(a, b);
      *place = a;
      a = std::exchange(arcs_[a].right, arcs_[a].left);
    }
  }

  std::vector<Vertex> parent_of_;       // [vertex], itself unless contracted
  std::vector<std::uint32_t> size_of_;  // [vertex], how many it has become
  std::vector<ArcId> heap_of_;          // [vertex], the lightest arc that leaves it
  std::vector<Arc> arcs_;               // as the graph's neighbours
};

/// The weights of the tree by Boost.Graph, ascending.
std::vector<Weight> kruskal(runtime::CsrGraph<> graph) {
  using Weighted = boost::property<boost::edge_weight_t, Weight>;
  boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, Weighted>
      copy(graph.vertex_count());
  for (Vertex a = 0; a < graph.vertex_count(); ++a)
    graph.for_each_neighbour(a, [&](Vertex b) {
      if (a < b) add_edge(a, b, weight_of(a, b), copy);
    });
  std::vector<decltype(copy)::edge_descriptor> tree;
  const double seconds = example::seconds_of(
      [&] { boost::kruskal_minimum_spanning_tree(copy, std::back_inserter(tree)); });
  example::print_yardstick("Boost.Graph, Kruskal, one thread", seconds);
  std::vector<Weight> weights;
  for (const auto& edge : tree) weights.push_back(get(boost::edge_weight, copy, edge));
  std::sort(weights.begin(), weights.end());
  return weights;
}

void compare(const example::Arguments& arguments) {
  const example::GraphArrays grid = example::grid_graph(arguments.size);
  const runtime::CsrGraph<> graph = grid.view();
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  std::printf("The minimum spanning tree of %zu vertices with %zu edges\n", vertices.size(),
              graph.neighbour.size() / 2);

  auto tree = example::solve_at_each_thread_count(
      arguments, [&](const runtime::Executor& executor, runtime::RoundsReport& report) {
        Contraction contraction(executor, graph);
        report = runtime::run_rounds(executor, contraction, vertices);
        return contraction.tree_edge_of;
      });
  std::erase(tree, Weight{0});
  std::sort(tree.begin(), tree.end());
  std::printf("edges in the tree: %zu\n", tree.size());
  example::require(tree == kruskal(graph), "not the minimum spanning tree");
}

}  // namespace

int main(int argument_count, char** argument) {
  return example::run(argument_count, argument, 100000, compare);
}
