/// @file
/// Graphs whose colourings the library contains, so that no program has to compile them, and type
/// erasure by which other graphs use those for rare or slow methods.
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

/// The graph, or a compiled view of it.
template <Graph G>
decltype(auto) as_compiled(const G& graph) {
  if constexpr (CompiledGraph<G>) {
    return (graph);
  } else {
    return AnyGraph(graph);
  }
}

}  // namespace ductile::runtime::detail
