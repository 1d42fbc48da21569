/// @file
/// AnyGraph: a view of a graph whose type is forgotten, so that what works on it is compiled once,
/// in the library, and not in every program. It hands on neighbours some at a time, which costs two
/// calls for a row of a few dozen, and a nanosecond or so for an edge.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "ductile/runtime/graph.hpp"

namespace ductile::runtime {

/// Keeps a reference to the graph it shows, which must outlive it. Thread safety: as the graph.
class AnyGraph {
 public:
  template <Graph G>
  requires(!std::is_same_v<G, AnyGraph>) explicit AnyGraph(const G& graph)
      : graph_(&graph), vertex_count_(graph.vertex_count()), read_(&read<G>) {}

  std::size_t vertex_count() const { return vertex_count_; }

  /// Throws what the graph or `visit` throws.
  template <class Visit>
  void for_each_neighbour(std::uint32_t v, Visit&& visit) const {
    using Plain = std::remove_reference_t<Visit>;
    const auto take = [](const void* context, Neighbours some) {
      auto& visit_one = *static_cast<Plain*>(const_cast<void*>(context));
      for (const std::uint32_t u : some) visit_one(u);
    };
    read_(graph_, v, {take, &visit});
  }

 private:
  using Neighbours = std::span<const std::uint32_t>;
  struct Sink {
    void (*take)(const void* context, Neighbours some);
    const void* context;
  };

  template <class G>
  static void read(const void* graph, std::uint32_t v, Sink sink) {
    std::array<std::uint32_t, 32> some;
    std::size_t count = 0;
    static_cast<const G*>(graph)->for_each_neighbour(v, [&](std::uint32_t u) {
      some[count++] = u;
      if (count < some.size()) return;
      sink.take(sink.context, some);
      count = 0;
    });
    sink.take(sink.context, Neighbours(some).first(count));
  }

  const void* graph_;
  std::size_t vertex_count_;
  void (*read_)(const void* graph, std::uint32_t v, Sink sink);
};

static_assert(Graph<AnyGraph>);

}  // namespace ductile::runtime
