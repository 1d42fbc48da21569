/// @file
/// Graphs for colouring: any type that gives its vertex count and visits the neighbours of a
/// vertex. Here are the concept, compressed rows, and views of callbacks, of squares and of type-
/// erased graphs; boost_graph.hpp adapts Boost.Graph.
/// Edges are symmetric: if u is a neighbour of v, v is one of u. Repeated neighbours and loops are
/// allowed. Views do not own their data; visiting only reads, so it is thread-safe.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace ductile::runtime {

/// vertex_count() is less than 2^32; for_each_neighbour(v, visit) calls visit(u) for every
/// neighbour u of vertex v. Thread safety: called by many threads.
template <class G>
concept Graph = requires(const G& graph, std::uint32_t v) {
  { graph.vertex_count() } -> std::convertible_to<std::size_t>;
  graph.for_each_neighbour(v, [](std::uint32_t) {});
};

/// A graph that can fetch a vertex's neighbours into the cache ahead of use: prefetch(v). It takes
/// a few instructions and changes nothing. It helps where the rows of many vertices are read in
/// sequence and everything else hits the cache, which the hardware does not anticipate. It is
/// called for the vertex 32 places ahead. Thread safety: as visiting.
template <class G>
concept PrefetchingGraph = Graph<G> && requires(const G& graph, std::uint32_t v) {
  graph.prefetch(v);
};

/// A graph whose neighbours of a vertex lie side by side in memory: row(v). Thread safety: as
/// visiting.
template <class G>
concept RowGraph = Graph<G> && requires(const G& graph, std::uint32_t v) {
  { graph.row(v) } -> std::convertible_to<std::span<const std::uint32_t>>;
};

/// Rows stored without gaps: row(v) runs from row_begin(v) to row_begin(v + 1). Optionally,
/// prefetch_row_begins(begin, end) fetches what row_begin() reads for vertices [begin, end). Thread
/// safety: as visiting.
template <class G>
concept PackedRowGraph = RowGraph<G> && requires(const G& graph, std::uint32_t v) {
  { graph.row_begin(v) } -> std::same_as<const std::uint32_t*>;
};

/// Compressed rows: the neighbours of v are neighbour[offset[v]] to neighbour[offset[v + 1] - 1].
template <std::unsigned_integral Offset = std::uint32_t>
struct CsrGraph {
  std::span<const Offset> offset;            ///< [vertex_count + 1]
  std::span<const std::uint32_t> neighbour;  ///< [offset.back()]

  std::size_t vertex_count() const { return offset.empty() ? 0 : offset.size() - 1; }
  template <class Visit>
  void for_each_neighbour(std::uint32_t v, Visit&& visit) const {
    const Offset end = offset[std::size_t{v} + 1];
    for (Offset i = offset[v]; i < end; ++i) visit(neighbour[i]);
  }
  std::span<const std::uint32_t> row(std::uint32_t v) const {
    return {row_begin(v), neighbour.data() + offset[std::size_t{v} + 1]};
  }
  /// For v = vertex_count(), the end of the last row.
  const std::uint32_t* row_begin(std::size_t v) const { return neighbour.data() + offset[v]; }
  // Always inlined: GCC drops calls of functions that do nothing except prefetch.
  [[gnu::always_inline]] void prefetch(std::uint32_t v) const {
    __builtin_prefetch(neighbour.data() + offset[v]);
  }
  [[gnu::always_inline]] void prefetch_row_begins(std::size_t begin, std::size_t end) const {
    constexpr std::size_t line = 64 / sizeof(Offset);
    for (std::size_t v = begin; v < end; v += line) __builtin_prefetch(offset.data() + v);
  }
};

/// Compressed rows of a symmetric graph; view() shows them as a Graph.
struct CsrRows {
  std::vector<std::uint32_t> offset, neighbour;  ///< [vertex + 1]; [offset.back()]

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(view().vertex_count()); }
  CsrGraph<> view() const { return {offset, neighbour}; }
};

/// Rows with both directions of every edge (fewer than 2^31); neighbours keep the order of the
/// edges. Loops and repeated edges stay. Throws std::out_of_range for an invalid vertex,
/// std::bad_alloc. Thread safety: any thread; runs on the caller.
inline CsrRows csr_rows(std::uint32_t vertex_count,
                        std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
  CsrRows rows{std::vector<std::uint32_t>(std::size_t{vertex_count} + 1), {}};
  for (const auto& [u, v] : edges) {
    ++rows.offset.at(std::size_t{u} + 1);
    ++rows.offset.at(std::size_t{v} + 1);
  }
  std::partial_sum(rows.offset.begin(), rows.offset.end(), rows.offset.begin());
  rows.neighbour.resize(rows.offset.back());
  std::vector<std::uint32_t> next = rows.offset;
  for (const auto& [u, v] : edges) {
    rows.neighbour[next[u]++] = v;
    rows.neighbour[next[v]++] = u;
  }
  return rows;
}

/// A graph given by a function neighbours_of(v, visit).
template <class Neighbours>
class CallbackGraph {
 public:
  CallbackGraph(std::size_t vertex_count, Neighbours neighbours_of)
      : vertex_count_(vertex_count), neighbours_of_(std::move(neighbours_of)) {}

  std::size_t vertex_count() const { return vertex_count_; }
  template <class Visit>
  void for_each_neighbour(std::uint32_t v, Visit&& visit) const {
    neighbours_of_(v, visit);
  }

 private:
  std::size_t vertex_count_;
  Neighbours neighbours_of_;
};

/// The square of a graph: vertices two edges apart are neighbours too, so its colourings are
/// distance-2 colourings of the graph.
template <Graph G>
class SquareGraph {
 public:
  explicit SquareGraph(const G& graph) : graph_(&graph) {}

  std::size_t vertex_count() const { return graph_->vertex_count(); }
  template <class Visit>
  void for_each_neighbour(std::uint32_t v, Visit&& visit) const {
    graph_->for_each_neighbour(v, [&](std::uint32_t u) {
      visit(u);
      graph_->for_each_neighbour(u, [&](std::uint32_t w) {
        if (w != v) visit(w);
      });
    });
  }

 private:
  const G* graph_;
};

/// A type-erased view of a graph, so that code for it is compiled once, in the library, and not in
/// every program. It passes neighbours in groups, which costs two calls for a row of a few dozen,
/// about a nanosecond per edge. The graph must outlive it. Thread safety: as the graph.
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
