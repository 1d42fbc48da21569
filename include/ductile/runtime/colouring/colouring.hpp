/// @file
/// Colouring: gives the vertices of a graph colours so that neighbours differ. Vertices of one
/// colour are independent, so whatever concerns a vertex and its neighbours may be done for all of
/// them at once. All methods are first-fit: a vertex takes the least colour no neighbour has.
#pragma once

// The methods in detail/ share first_fit and, except for by_priority, take vertices in the order of
// their numbers:
//
//   Serial (in_order)        one thread, few vertices, and orders that are chains
//   together                 else: the same colours, in windows_in_order or in parts_in_order
//   priority_colouring       scattered vertices that are coloured anew, and to compare with
//   speculative_colouring    on request, and for the parts' borders: published schemes, which
//                            depend on timing; threads share vertices out by fronts

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
  automatic,      ///< the colours of `serial`, on all threads where that is faster; an executor
                  ///< that is not deterministic may take one colour more
  serial,         ///< first-fit in vertex order on the calling thread
  by_priority,    ///< a hash decides which neighbour comes first; deterministic, a yardstick
                  ///< (Jones, Plassmann, SIAM J. Sci. Comput. 14, 1993)
  largest_first,  ///< by_priority, but greater degrees go first: fewer colours, longer chains
  detect_again,   ///< speculate; detect and recolour at once, one barrier a round
                  ///< (Rokos, Gorman, Kelly, Euro-Par 2015)
  two_phase,      ///< speculate; colour, then detect, a barrier after each
                  ///< (Catalyurek et al., Parallel Computing 38, 2012)
};

/// A colour for each vertex: neighbours have different ones.
struct Colouring {
  static constexpr std::uint32_t none = ~std::uint32_t{0};  ///< instead of a colour

  std::vector<std::uint32_t> colour_of;  ///< [vertex]
  std::uint32_t count = 0;               ///< colours are less than this
};

namespace detail {

constexpr std::size_t few_vertices = 256;     // coloured on the caller, in order
constexpr std::size_t many_vertices = 32768;  // worth a team where it has little to do for each

/// What a method comes down to for so many vertices on these threads.
ColouringMethod choose(const Executor& executor, ColouringMethod method, std::size_t vertex_count);

/// The same for a graph.
template <Graph G>
ColouringMethod choose(const Executor& executor, ColouringMethod method, const G& graph) {
  method = choose(executor, method, graph.vertex_count());
  if (method != ColouringMethod::automatic) return method;
  const bool is_shared = OrderOfGraph<G>(executor, graph).shares().kind != Shares::none;
  return is_shared ? method : ColouringMethod::serial;
}

/// Calls use(Method()), with the class that choose() stands for, and returns what it returns.
template <class Use>
bool with_class_of(ColouringMethod chosen, Use&& use) {
  switch (chosen) {
    case ColouringMethod::serial:
      return use(Serial());
    case ColouringMethod::by_priority:
      return use(ByPriority());
    case ColouringMethod::largest_first:
      return use(ByDegree());
    case ColouringMethod::detect_again:
      return use(DetectAgain());
    case ColouringMethod::two_phase:
      return use(TwoPhase());
    default:
      return use(Together());
  }
}

/// Colours vertices by a method, in words of one byte, which say `none`. Returns false if there are
/// too many colours for them.
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

/// The same, with the kind of words that is read fastest and holds the colours. Hubs, which take
/// many, often come first, so that it shows soon what does not.
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
  if constexpr (requires { Method::lengthens; }) {
    return false;
  } else {
    return colour_in<Method, Long>(executor, graph, bytes, vertices);
  }
}

/// The same for all vertices by a method that is bound by memory: AnyGraph costs it little.
template <CompiledGraph G>
bool colour_slowly_in_bytes(const Executor& executor, const G& graph, ColouringMethod chosen,
                            std::vector<std::uint8_t>& bytes);

/// Colours all vertices with words of four bytes. Returns one more than the greatest colour.
template <CompiledGraph G>
std::uint32_t colour_in_words(const Executor& executor, const G& graph, ColouringMethod chosen,
                              std::vector<std::uint32_t>& colour_of);

/// Copies colours of one byte to words of four. Returns one more than the greatest.
std::uint32_t widen(const Executor& executor, std::span<const std::uint8_t> bytes,
                    std::span<std::uint32_t> colour_of);

/// One more than the greatest of colours, which all vertices have.
std::uint32_t colour_count(const Executor& executor, std::span<const std::uint8_t> bytes);

/// One more than the greatest colour.
std::uint32_t colour_count(const Executor& executor, std::span<const std::uint32_t> colour_of);

/// colour() by a method that choose() has chosen.
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

/// recolour(), in whatever team there is.
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
  // Scattered vertices hardly wait for each other.
  const bool are_scattered = vertices.size() < colour_of.size() / 16;
  if (vertices.size() >= few_vertices && are_scattered) {
    colour_by_priority<AwaitedByPlace>(executor, graph, vertices, colours, outranks);
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

/// Colours `vertices` (ascending, each once) anew and leaves the others as they are: those with a
/// colour are avoided, those with Colouring::none ignored. Serves recolouring after a change, and
/// colouring of a part. colour_of has the graph's vertex count. The result is deterministic.
/// Throws std::bad_alloc and what the graph throws. Thread safety: any thread.
template <Graph G>
void recolour(const Executor& executor, const G& graph, std::span<const std::uint32_t> vertices,
              Colouring& colouring) {
  detail::with_team_for(vertices.size(), executor,
                        [&] { detail::recolour_in_team(executor, graph, vertices, colouring); });
}

/// Vertices grouped by colour.
struct ColourClasses {
  std::vector<std::uint32_t> vertices;  ///< by (colour, vertex)
  std::vector<std::size_t> begin;       ///< [colour], and the end

  std::size_t count() const { return begin.size() - 1; }
  std::span<const std::uint32_t> members(std::size_t colour) const {
    return std::span(vertices).subspan(begin[colour], begin[colour + 1] - begin[colour]);
  }
};

/// The vertices of each colour, ascending; those with Colouring::none are left out.
/// Throws std::bad_alloc. Thread safety: any thread.
ColourClasses colour_classes(const Executor& executor, const Colouring& colouring);

/// Every vertex has a colour below count, and no two neighbours have the same.
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

// Of the common graphs: compiled once.
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
