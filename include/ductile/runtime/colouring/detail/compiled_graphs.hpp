/// @file
/// Which graphs' colourings the library brings along, so that no program has to compile them; and
/// how other graphs get at those, for what is too rare or too slow anyway to be compiled for them.
#pragma once

#include <cstdint>

#include "ductile/runtime/colouring/graph.hpp"

namespace ductile::runtime::detail {

template <class G>
constexpr bool is_compiled = false;
template <>
inline constexpr bool is_compiled<CsrGraph<std::uint32_t>> = true;
template <>
inline constexpr bool is_compiled<CsrGraph<std::uint64_t>> = true;
template <>
inline constexpr bool is_compiled<AnyGraph> = true;

template <class G>
concept CompiledGraph = is_compiled<G>;

/// The graph, or a view of it that is compiled.
template <Graph G>
decltype(auto) as_compiled(const G& graph) {
  if constexpr (CompiledGraph<G>) {
    return (graph);
  } else {
    return AnyGraph(graph);
  }
}

}  // namespace ductile::runtime::detail
