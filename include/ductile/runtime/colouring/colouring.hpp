/// @file
/// Colouring: gives the vertices of a graph colours so that neighbours differ. Vertices of one
/// colour are independent, so operations on a vertex and its neighbours may run for all of them at
/// once. All methods are first-fit: a vertex takes the lowest colour that no neighbour has.
#pragma once

// The methods in detail/ share first_fit. All except by_priority take vertices in numerical order:
//
//   Serial (in_order)        one thread, few vertices, and orders that are chains
//   together                 otherwise: the same colours, in windows_in_order or parts_in_order
//   priority_colouring       recolouring scattered vertices, and comparison
//   speculative_colouring    on request, and for borders of parts: published schemes, whose result
//                            depends on timing

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"
#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/detail/priority_colouring.hpp"
#include "ductile/runtime/colouring/detail/speculative_colouring.hpp"
#include "ductile/runtime/colouring/detail/together.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

enum class ColouringMethod {
  automatic,     ///< the colours of `serial`, on all threads where that is faster; an executor
                 ///< that is not deterministic may take one colour more
  serial,        ///< first-fit in vertex order on the calling thread
  by_priority,   ///< a hash decides which neighbour comes first; deterministic, a yardstick
                 ///< (Jones, Plassmann, SIAM J. Sci. Comput. 14, 1993)
  detect_again,  ///< speculate; detect and recolour at once, one barrier a round
                 ///< (Rokos, Gorman, Kelly, Euro-Par 2015)
  two_phase,     ///< speculate; colour, then detect, a barrier after each
                 ///< (Catalyurek et al., Parallel Computing 38, 2012)
};

/// One colour per vertex, different for neighbours.
struct Colouring {
  static constexpr std::uint32_t none = ~std::uint32_t{0};  ///< means no colour

  std::vector<std::uint32_t> colour_of;  ///< [vertex]
  std::uint32_t count = 0;               ///< colours are less than this
};

namespace detail {

constexpr std::size_t few_vertices = 256;     // coloured on the caller, in order
constexpr std::size_t many_vertices = 32768;  // below this, short rows are not worth a team

/// The method actually used for so many vertices on these threads.
ColouringMethod choose(const Executor& executor, ColouringMethod method, std::size_t vertex_count);

/// The same for a graph.
template <Graph G>
ColouringMethod choose(const Executor& executor, ColouringMethod method, const G& graph) {
  method = choose(executor, method, graph.vertex_count());
  if (method != ColouringMethod::automatic) return method;
  const bool is_shared = OrderOfGraph<G>(executor, graph).shares().kind != Shares::none;
  return is_shared ? method : ColouringMethod::serial;
}

/// Calls use(Method()) with the class of the chosen method; returns its result.
template <class Use>
bool with_class_of(ColouringMethod chosen, Use&& use) {
  switch (chosen) {
    case ColouringMethod::serial:
      return use(Serial());
    case ColouringMethod::by_priority:
      return use(ByPriority());
    case ColouringMethod::detect_again:
      return use(DetectAgain());
    case ColouringMethod::two_phase:
      return use(TwoPhase());
    default:
      return use(Together());
  }
}

/// Colours vertices using words of one byte, which must hold `none`. Returns false if they cannot
/// hold all colours.
template <class Method, class Width, Graph G>
bool colour_in(const Executor& executor, const G& graph, std::vector<std::uint8_t>& bytes,
               VertexSet vertices) {
  try {
    Method::run(executor, graph, vertices, Colours<Width>(bytes));
    return true;
  } catch (const TooManyColours&) {
    return false;
  }
}

/// The same, in the fastest kind of word that holds the colours. Hubs, which need many colours,
/// often come first, so that overflow shows early.
template <class Method, Graph G>
bool colour_in_bytes(const Executor& executor, const G& graph, std::vector<std::uint8_t>& bytes,
                     VertexSet vertices) {
  using Short = Narrow<Method::marks>;
  using Long = OneByte<Method::marks>;
  if constexpr (!requires { Method::bound_by_memory; }) {
    if (colour_in<Method, Short>(executor, graph, bytes, vertices)) return true;
    if constexpr (!requires { Method::resumes; })
      std::fill(bytes.begin(), bytes.end(), Colours<Long>::none);
  }
  return colour_in<Method, Long>(executor, graph, bytes, vertices);
}

/// The same for all vertices with a memory-bound method, for which the overhead of AnyGraph is
/// small.
template <CompiledGraph G>
bool colour_slowly_in_bytes(const Executor& executor, const G& graph, ColouringMethod chosen,
                            std::vector<std::uint8_t>& bytes);

/// Colours all vertices with words of four bytes. Returns one more than the greatest colour.
template <CompiledGraph G>
std::uint32_t colour_in_words(const Executor& executor, const G& graph, ColouringMethod chosen,
                              std::vector<std::uint32_t>& colour_of);

/// One more than the greatest colour; every vertex has one.
std::uint32_t colour_count(const Executor& executor, std::span<const std::uint8_t> bytes);

/// One more than the greatest colour.
std::uint32_t colour_count(const Executor& executor, std::span<const std::uint32_t> colour_of);

/// colour() by the method that choose() returned.
template <Graph G>
Colouring colour_by(const Executor& executor, const G& graph, ColouringMethod method) {
  const std::size_t n = graph.vertex_count();
  std::vector<std::uint8_t> bytes(n, Colours<OneByte<>>::none);
  const bool fits = with_class_of(method, [&]<class Method>(Method) {
    if constexpr (requires { Method::bound_by_memory; }) {
      return colour_slowly_in_bytes(executor, as_compiled(graph), method, bytes);
    } else {
      return colour_in_bytes<Method>(executor, graph, bytes, {n});
    }
  });
  if (fits) return {{bytes.begin(), bytes.end()}, colour_count(executor, bytes)};
  Colouring colouring{std::vector<std::uint32_t>(n)};
  colouring.count = colour_in_words(executor, as_compiled(graph), method, colouring.colour_of);
  return colouring;
}

/// recolour(), run in the current team.
template <Graph G>
void recolour_in_team(const Executor& executor, const G& graph,
                      std::span<const std::uint32_t> vertices, Colouring& colouring) {
  const LoopOptions loop{.grain = 1024, .serial_below = few_vertices};
  auto& colour_of = colouring.colour_of;
  parallel_for(
      executor, vertices.size(), [&](std::size_t i) { colour_of[vertices[i]] = Colouring::none; },
      loop);
  const VertexSet set{vertices.size(), vertices.data()};
  const Colours<FourBytes<>> colours(colour_of);
  // Scattered vertices rarely wait for each other.
  const bool are_scattered = vertices.size() < colour_of.size() / 16;
  if (vertices.size() >= few_vertices && are_scattered) {
    colour_by_priority<AwaitedByPlace>(executor, graph, vertices, colours);
  } else {
    Serial::run(executor, graph, set, colours);
  }
  const auto next = [&](std::size_t i) { return colour_of[vertices[i]] + 1; };
  const auto greater = [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); };
  colouring.count = parallel_reduce(executor, vertices.size(), colouring.count, next, greater);
}

}  // namespace detail

/// Colours all vertices. `detect_again` and `two_phase` depend on timing, and so does `automatic`
/// if the executor is not deterministic; on one thread they are `serial`. The others give the same
/// colours at any thread count. Throws std::bad_alloc and what the graph throws.
/// Thread safety: any thread.
template <Graph G>
Colouring colour(const Executor& executor, const G& graph,
                 ColouringMethod method = ColouringMethod::automatic) {
  method = detail::choose(executor, method, graph);
  const auto colour_all = [&] { return detail::colour_by(executor, graph, method); };
  if (method == ColouringMethod::serial) return colour_all();
  return with_team(executor, colour_all);
}

/// Recolours `vertices` (ascending, each once) and keeps the others: their colours are avoided,
/// Colouring::none is ignored. Use it after a change, or to colour a part. colour_of has the
/// graph's vertex count. Deterministic. Throws std::bad_alloc and what the graph throws. Thread
/// safety: any thread.
template <Graph G>
void recolour(const Executor& executor, const G& graph, std::span<const std::uint32_t> vertices,
              Colouring& colouring) {
  detail::with_team_for(vertices.size(), executor,
                        [&] { detail::recolour_in_team(executor, graph, vertices, colouring); });
}

/// Vertices grouped by colour.
struct ColourClasses {
  std::vector<std::uint32_t> vertices;  ///< by (colour, vertex)
  std::vector<std::size_t> begin;       ///< [colour], and one past the last

  std::size_t count() const { return begin.size() - 1; }
  std::span<const std::uint32_t> members(std::size_t colour) const {
    return std::span(vertices).subspan(begin[colour], begin[colour + 1] - begin[colour]);
  }
};

/// The vertices of each colour, ascending; those with Colouring::none are left out.
/// Throws std::bad_alloc. Thread safety: any thread.
ColourClasses colour_classes(const Executor& executor, const Colouring& colouring);

/// Does every vertex have a colour below count, different from its neighbours'?
template <Graph G>
bool is_proper(const Executor& executor, const G& graph, const Colouring& colouring) {
  if (colouring.colour_of.size() != graph.vertex_count()) return false;
  const auto bad = [&](std::size_t i) {
    const auto v = static_cast<std::uint32_t>(i);
    bool clash = colouring.colour_of[v] >= colouring.count;
    graph.for_each_neighbour(v, [&](std::uint32_t u) {
      clash = clash || (u != v && colouring.colour_of[u] == colouring.colour_of[v]);
    });
    return clash ? 1 : 0;
  };
  return parallel_reduce(executor, graph.vertex_count(), 0, bad, std::plus<>()) == 0;
}

// Common graphs are instantiated once, in the library.
extern template Colouring colour(const Executor&, const CsrGraph<std::uint32_t>&, ColouringMethod);
extern template Colouring colour(const Executor&, const CsrGraph<std::uint64_t>&, ColouringMethod);
extern template Colouring colour(const Executor&, const AnyGraph&, ColouringMethod);
extern template void recolour(const Executor&, const CsrGraph<std::uint32_t>&,
                              std::span<const std::uint32_t>, Colouring&);
extern template void recolour(const Executor&, const CsrGraph<std::uint64_t>&,
                              std::span<const std::uint32_t>, Colouring&);
extern template void recolour(const Executor&, const AnyGraph&, std::span<const std::uint32_t>,
                              Colouring&);

}  // namespace ductile::runtime
