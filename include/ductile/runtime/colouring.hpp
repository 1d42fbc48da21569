/// @file
/// Colouring: gives the vertices of a graph colours so that neighbours differ. Vertices of one
/// colour are independent, so whatever concerns a vertex and its neighbours may be done for all of
/// them at once. All methods are first-fit: a vertex takes the least colour no neighbour has.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ductile/runtime/detail/blocked_colouring.hpp"
#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/detail/marked_colouring.hpp"
#include "ductile/runtime/detail/priority_colouring.hpp"
#include "ductile/runtime/detail/speculative_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

enum class ColouringMethod {
  automatic,          ///< blocked: parallel, and the same at any thread count
  serial,             ///< first-fit in vertex order on the calling thread
  blocked,            ///< blocks side by side, clashes repaired by priority; deterministic
  by_priority,        ///< hashed priority decides who waits for whom; deterministic, a yardstick
                      ///< (Jones, Plassmann, SIAM J. Sci. Comput. 14, 1993)
  largest_first,      ///< by_priority, but greater degrees go first: fewer colours, longer chains
  largest_log_first,  ///< by_priority, greater logarithms of degrees first: a compromise
  detect_again,       ///< speculate; detect and recolour at once, one barrier a round
                      ///< (Rokos, Gorman, Kelly, Euro-Par 2015)
  two_phase,          ///< speculate; colour, then detect, a barrier after each
                      ///< (Catalyurek et al., Parallel Computing 38, 2012)
};

struct Colouring {
  static constexpr std::uint32_t none = ~std::uint32_t{0};  ///< instead of a colour

  std::vector<std::uint32_t> colour_of;  ///< [vertex]
  std::uint32_t count = 0;               ///< colours are less than this
};

namespace detail {

constexpr std::size_t few_vertices = 256;    // coloured on the caller, in order
constexpr std::size_t many_vertices = 8192;  // worth the launches of MarkedBlocks

/// Copies colours of one byte to words of four. Returns one more than the greatest.
std::uint32_t widen(const Executor& executor, std::span<const std::uint8_t> bytes,
                    std::span<std::uint32_t> colour_of);

/// One more than the greatest colour.
std::uint32_t colour_count(const Executor& executor, std::span<const std::uint32_t> colour_of);

/// Colours all, in this order, by a method, with words of one byte: these, which say `none`.
/// Returns one more than the greatest colour. Throws TooManyColours.
template <class Method, class Width, Graph G>
std::uint32_t colour_in_bytes(const Executor& executor, const G& graph,
                              std::vector<std::uint32_t>& colour_of, VertexSet vertices,
                              std::vector<std::uint8_t>& bytes) {
  Method::run(executor, graph, vertices, Colours<Width>(bytes));
  return widen(executor, bytes, colour_of);
}

/// The same, with the shortest words that hold the colours. Hubs, which take many, often come
/// first, so that it shows soon what does not.
template <class Method, Graph G>
std::uint32_t colour_all(const Executor& executor, const G& graph,
                         std::vector<std::uint32_t>& colour_of, VertexSet vertices) {
  using Short = Narrow<Method::marks>;
  using Long = OneByte<Method::marks>;
  std::vector<std::uint8_t> bytes(colour_of.size(), Colours<Short>::none);
  try {
    return colour_in_bytes<Method, Short>(executor, graph, colour_of, vertices, bytes);
  } catch (const TooManyColours&) {
  }
  if constexpr (!requires { Method::lengthens; }) {
    if constexpr (!requires { Method::resumes; })
      std::fill(bytes.begin(), bytes.end(), Colours<Long>::none);
    try {
      return colour_in_bytes<Method, Long>(executor, graph, colour_of, vertices, bytes);
    } catch (const TooManyColours&) {
    }
  }
  std::fill(colour_of.begin(), colour_of.end(), Colouring::none);
  Method::run(executor, graph, vertices, Colours<FourBytes<Method::marks>>(colour_of));
  return colour_count(executor, colour_of);
}

}  // namespace detail

/// Colours all vertices. `detect_again` and `two_phase` depend on timing, and on one thread are
/// `serial`; the others give the same colours at any thread count. Throws std::bad_alloc and what
/// the graph throws. Thread safety: any thread.
template <Graph G>
Colouring colour(const Executor& executor, const G& graph,
                 ColouringMethod method = ColouringMethod::automatic) {
  Colouring colouring;
  auto& colour_of = colouring.colour_of;
  colour_of.resize(graph.vertex_count());
  const bool by_degree =
      method == ColouringMethod::largest_first || method == ColouringMethod::largest_log_first;
  // A team of one has no clashes to look for.
  const bool alone = executor.threads() == 1 && (method == ColouringMethod::detect_again ||
                                                 method == ColouringMethod::two_phase);
  if (alone || (colour_of.size() < detail::few_vertices && !by_degree))
    method = ColouringMethod::serial;
  const auto by = [&]<class Method>(Method) {
    colouring.count =
        detail::colour_all<Method>(executor, graph, colour_of, detail::VertexSet{colour_of.size()});
  };
  switch (method) {
    case ColouringMethod::serial:
      by(detail::Serial());
      break;
    case ColouringMethod::automatic:  // blocked is deterministic and not far from the fastest
    case ColouringMethod::blocked:
      if (colour_of.size() < detail::many_vertices) {
        by(detail::Blocked());
      } else {
        by(detail::MarkedBlocks());
      }
      break;
    case ColouringMethod::by_priority:
      by(detail::ByPriority());
      break;
    case ColouringMethod::largest_first:
      by(detail::ByDegree<false>());
      break;
    case ColouringMethod::largest_log_first:
      by(detail::ByDegree<true>());
      break;
    case ColouringMethod::detect_again:
      by(detail::DetectAgain());
      break;
    case ColouringMethod::two_phase:
      by(detail::TwoPhase());
      break;
  }
  return colouring;
}

/// Colours `vertices` (ascending, each once) anew and leaves the others as they are: those with a
/// colour are avoided, those with Colouring::none ignored. Serves recolouring after a change, and
/// colouring of a part. colour_of has the graph's vertex count. The result is deterministic.
/// Throws std::bad_alloc and what the graph throws. Thread safety: any thread.
template <Graph G>
void recolour(const Executor& executor, const G& graph, std::span<const std::uint32_t> vertices,
              Colouring& colouring) {
  const LoopOptions loop{.grain = 1024, .serial_below = detail::few_vertices};
  auto& colour_of = colouring.colour_of;
  parallel_for(
      executor, vertices.size(), [&](std::size_t i) { colour_of[vertices[i]] = Colouring::none; },
      loop);
  const detail::VertexSet set{vertices.size(), vertices.data()};
  const detail::Colours<detail::FourBytes<>> colours(colour_of);
  if (vertices.size() < detail::few_vertices) {
    detail::Serial::run(executor, graph, set, colours);
  } else if (vertices.size() < colour_of.size() / 16) {
    // Scattered vertices hardly wait for each other, and blocks would cost as if all were there.
    detail::colour_by_priority(executor, graph, vertices, colours, detail::outranks);
  } else {
    detail::Blocked::run(executor, graph, set, colours);
  }
  const auto next = [&](std::size_t i) { return colour_of[vertices[i]] + 1; };
  const auto greater = [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); };
  colouring.count = parallel_reduce(executor, vertices.size(), colouring.count, next, greater);
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

}  // namespace ductile::runtime
