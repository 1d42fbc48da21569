/// @file
/// Orderings: the order in which first-fit takes the vertices of a graph. A good order saves
/// colours; smallest last needs at most the degeneracy of the graph plus one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

enum class VertexOrder {
  natural,        ///< ascending
  largest_first,  ///< descending degree (Welsh, Powell, Computer J. 10, 1967)
  smallest_last,  ///< the last has the smallest degree, the one before the smallest without it, ...
                  ///< (Matula, Beck, J. ACM 30, 1983)
};

namespace detail {

/// Vertices sorted by key, ascending within a key; keys are less than `keys`.
std::vector<std::uint32_t> counting_sort(std::span<const std::uint32_t> key_of, std::size_t keys);

/// The remaining vertices, in buckets by degree; the buckets are adjacent, so one exchange moves a
/// vertex to the next bucket.
class DegreeBuckets {
 public:
  explicit DegreeBuckets(std::vector<std::uint32_t> degree_of);

  std::size_t size() const { return vertices_.size(); }
  /// Removes a remaining vertex of least degree, the i-th to be removed, and returns it.
  std::uint32_t remove(std::size_t i);
  /// Lowers the degree of u, because a neighbour was removed.
  void lower(std::uint32_t u);

 private:
  std::vector<std::uint32_t> degree_of_;  // [vertex], among the remaining ones
  std::vector<std::uint32_t> vertices_;   // ascending degree; the removed ones first
  std::vector<std::uint32_t> place_of_;   // [vertex], in vertices_
  std::vector<std::uint32_t> begin_of_;   // [degree], where its bucket begins
  std::size_t removed_ = 0;
};

template <Graph G>
std::vector<std::uint32_t> degrees(const Executor& executor, const G& graph) {
  std::vector<std::uint32_t> degree_of(graph.vertex_count());
  parallel_for(executor, degree_of.size(), [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    graph.for_each_neighbour(v, [&](std::uint32_t u) { degree_of[v] += u != v; });
  });
  return degree_of;
}

inline bool names_each_once(std::span<const std::uint32_t> order, std::size_t vertex_count) {
  std::vector<std::uint8_t> named(vertex_count);
  for (const std::uint32_t v : order)
    if (v >= vertex_count || named[v]++ != 0) return false;
  return order.size() == vertex_count;
}

/// Serial first-fit in the given order.
struct InOrder {
  static constexpr std::uint32_t marks = 0;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Width> colours) {
    if (executor.threads() == 1) return Serial::run(executor, graph, vertices, colours);
    std::vector<std::uint32_t> place_of(colours.vertex_count());
    for (std::size_t i = 0; i < vertices.count; ++i)
      place_of[vertices[i]] = static_cast<std::uint32_t>(i);
    colour_by_priority(executor, graph, listed(vertices), colours,
                       [&](std::uint32_t u, std::uint32_t v) { return place_of[u] < place_of[v]; });
  }
};

/// colour_in_order(), run in the current team, for an order known to be a permutation.
template <Graph G>
Colouring first_fit_in(const Executor& executor, const G& graph,
                       std::span<const std::uint32_t> order) {
  Colouring colouring{std::vector<std::uint32_t>(order.size(), Colouring::none)};
  const VertexSet vertices{order.size(), order.data()};
  std::vector<std::uint8_t> bytes(order.size(), Colours<OneByte<>>::none);
  if (colour_in_bytes<InOrder>(executor, graph, bytes, vertices)) {
    colouring.count = widen(executor, bytes, colouring.colour_of);
    return colouring;
  }
  const Colours<FourBytes<>> words(colouring.colour_of);
  InOrder::run(executor, graph, vertices, words);
  colouring.count = colour_count(executor, colouring.colour_of);
  return colouring;
}

}  // namespace detail

/// All vertices in this order. Ties are in ascending order; for smallest_last, in an order that is
/// the same in every run. Repeated edges count repeatedly, loops do not. smallest_last is serial.
/// Throws std::bad_alloc and what the graph throws.
/// Thread safety: any thread.
template <Graph G>
std::vector<std::uint32_t> vertex_order(const Executor& executor, const G& graph,
                                        VertexOrder order) {
  std::vector<std::uint32_t> all(graph.vertex_count());
  std::iota(all.begin(), all.end(), 0U);
  if (order == VertexOrder::natural || all.empty()) return all;
  std::vector<std::uint32_t> degree_of = detail::degrees(executor, graph);
  if (order == VertexOrder::largest_first) {
    const std::uint32_t most = *std::max_element(degree_of.begin(), degree_of.end());
    for (std::uint32_t& degree : degree_of) degree = most - degree;
    return detail::counting_sort(degree_of, std::size_t{most} + 1);
  }
  detail::DegreeBuckets buckets(std::move(degree_of));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::uint32_t v = all[all.size() - 1 - i] = buckets.remove(i);
    graph.for_each_neighbour(v, [&](std::uint32_t u) {
      if (u != v) buckets.lower(u);
    });
  }
  return all;
}

/// First-fit in the given order, a permutation of the vertices; the colours are those of the serial
/// algorithm at any thread count. Several threads use Jones and Plassmann's scheme, which is slow
/// where the order follows the graph, like the natural order of a mesh. Throws
/// std::invalid_argument if the order is not a permutation, std::bad_alloc and what the graph
/// throws.
/// Thread safety: any thread.
template <Graph G>
Colouring colour_in_order(const Executor& executor, const G& graph,
                          std::span<const std::uint32_t> order) {
  if (!detail::names_each_once(order, graph.vertex_count()))
    throw std::invalid_argument("colour_in_order: expected each vertex once");
  return detail::with_team_for(order.size(), executor,
                               [&] { return detail::first_fit_in(executor, graph, order); });
}

}  // namespace ductile::runtime
