/// @file
/// DUCTILE_COMPILE_COLOURINGS: instantiates the colourings of one type of graph for the library,
/// see detail/compiled_graphs.hpp. Each has its own source, because it takes seconds to compile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"
#include "ductile/runtime/colouring/graph.hpp"

namespace ductile::runtime::detail {

template <CompiledGraph G>
bool colour_slowly_in_bytes(const Executor& executor, const G& graph, ColouringMethod chosen,
                            std::vector<std::uint8_t>& bytes) {
  const std::size_t n = bytes.size();
  return with_class_of(chosen, [&]<class Method>(Method) {
    if constexpr (requires { Method::bound_by_memory; })
      return colour_in_bytes<Method>(executor, graph, bytes, {n});
    return false;  // never called for others
  });
}

template <CompiledGraph G>
std::uint32_t colour_in_words(const Executor& executor, const G& graph, ColouringMethod chosen,
                              std::vector<std::uint32_t>& colour_of) {
  std::fill(colour_of.begin(), colour_of.end(), Colouring::none);
  const std::size_t n = colour_of.size();
  with_class_of(chosen, [&]<class Method>(Method) {
    Method::run(executor, graph, {n}, Colours<FourBytes<Method::marks>>(colour_of));
    return true;
  });
  return colour_count(executor, colour_of);
}

}  // namespace ductile::runtime::detail

#define DUCTILE_COMPILE_COLOURINGS(GRAPH)                                                        \
  template Colouring colour(const Executor&, const GRAPH&, ColouringMethod);                     \
  template void recolour(const Executor&, const GRAPH&, std::span<const std::uint32_t>,          \
                         Colouring&);                                                            \
  template std::uint32_t detail::colour_in_words(const Executor&, const GRAPH&, ColouringMethod, \
                                                 std::vector<std::uint32_t>&);                   \
  template bool detail::colour_slowly_in_bytes(const Executor&, const GRAPH&, ColouringMethod,   \
                                               std::vector<std::uint8_t>&)
