#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime {

namespace detail {

namespace {

/// Of the pairs that have one colour, those that are outranked; ascending.
template <class Word>
UnsetVector<std::uint32_t> losers(const Executor& executor, const BlindPairs& blind,
                                  std::span<const Word> colour_of) {
  std::vector<std::span<const std::pair<std::uint32_t, std::uint32_t>>> parts;
  for (std::size_t t = 0; t < blind.size(); ++t)
    for (std::span left(blind[t]); !left.empty(); left = left.subspan(parts.back().size()))
      parts.push_back(left.first(std::min<std::size_t>(left.size(), 256)));
  auto lost =
      parallel_collect<std::uint32_t>(executor, parts.size(), [&](std::size_t p, auto&& append) {
        for (const auto& [u, v] : parts[p])
          if (colour_of[u] == colour_of[v]) append(outranks(u, v) ? v : u);
      });
  parallel_sort(executor, std::span(lost));
  lost.resize(parallel_unique(executor, std::span(lost)));
  return lost;
}

/// What colour_by_priority() does, one after the other.
template <class Width, CompiledGraph G>
void colour_few_by_priority(const G& graph, std::span<std::uint32_t> few, Colours<Width> colours) {
  for (const std::uint32_t v : few) colours.set(v, Colours<Width>::waiting);
  std::sort(few.begin(), few.end(), outranks);
  for (const std::uint32_t v : few) colours.set(v, least_free(graph, v, colours));
}

}  // namespace

template <std::unsigned_integral Word, CompiledGraph G>
void repair(const Executor& executor, const G& graph, const BlindPairs& blind,
            std::span<Word> colour_of) {
  constexpr std::size_t few = 64;
  UnsetVector<std::uint32_t> lost = losers<Word>(executor, blind, colour_of);
  const Colours<Words<Word, 0>> colours(colour_of);
  if (lost.size() <= few) return colour_few_by_priority(graph, std::span(lost), colours);
  colour_by_priority(executor, graph, lost, colours, outranks);
}

template <CompiledGraph G>
bool colour_slowly_in_bytes(const Executor& executor, const G& graph, ColouringMethod chosen,
                            std::vector<std::uint8_t>& bytes) {
  const std::size_t n = bytes.size();
  return with_class_of(chosen, n, [&]<class Method>(Method) {
    if constexpr (requires { Method::bound_by_memory; })
      return colour_in_bytes<Method>(executor, graph, bytes, {n});
    return false;  // not called for others
  });
}

template <CompiledGraph G>
std::uint32_t colour_in_words(const Executor& executor, const G& graph, ColouringMethod chosen,
                              std::vector<std::uint32_t>& colour_of) {
  std::fill(colour_of.begin(), colour_of.end(), Colouring::none);
  const std::size_t n = colour_of.size();
  with_class_of(chosen, n, [&]<class Method>(Method) {
    Method::run(executor, graph, {n}, Colours<FourBytes<Method::marks>>(colour_of));
    return true;
  });
  return colour_count(executor, colour_of);
}

}  // namespace detail

// ---- Graphs of compiled_graphs.hpp ----

using Csr32 = CsrGraph<std::uint32_t>;
using Csr64 = CsrGraph<std::uint64_t>;
using Vertices = std::span<const std::uint32_t>;

template Colouring colour(const Executor&, const Csr32&, ColouringMethod);
template Colouring colour(const Executor&, const Csr64&, ColouringMethod);
template Colouring colour(const Executor&, const AnyGraph&, ColouringMethod);
template void recolour(const Executor&, const Csr32&, Vertices, Colouring&);
template void recolour(const Executor&, const Csr64&, Vertices, Colouring&);
template void recolour(const Executor&, const AnyGraph&, Vertices, Colouring&);

namespace detail {

using Colours32 = std::vector<std::uint32_t>;
using Colours8 = std::vector<std::uint8_t>;
using Bytes = std::span<std::uint8_t>;
using Words32 = std::span<std::uint32_t>;

template std::uint32_t colour_in_words(const Executor&, const Csr32&, ColouringMethod, Colours32&);
template std::uint32_t colour_in_words(const Executor&, const Csr64&, ColouringMethod, Colours32&);
template std::uint32_t colour_in_words(const Executor&, const AnyGraph&, ColouringMethod,
                                       Colours32&);
template bool colour_slowly_in_bytes(const Executor&, const Csr32&, ColouringMethod, Colours8&);
template bool colour_slowly_in_bytes(const Executor&, const Csr64&, ColouringMethod, Colours8&);
template bool colour_slowly_in_bytes(const Executor&, const AnyGraph&, ColouringMethod, Colours8&);
template void repair(const Executor&, const Csr32&, const BlindPairs&, Bytes);
template void repair(const Executor&, const Csr64&, const BlindPairs&, Bytes);
template void repair(const Executor&, const AnyGraph&, const BlindPairs&, Bytes);
template void repair(const Executor&, const Csr32&, const BlindPairs&, Words32);
template void repair(const Executor&, const Csr64&, const BlindPairs&, Words32);
template void repair(const Executor&, const AnyGraph&, const BlindPairs&, Words32);

}  // namespace detail
}  // namespace ductile::runtime
