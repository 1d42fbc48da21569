#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime {

namespace detail {

template <CompiledGraph G>
bool colour_slowly_in_bytes(const Executor& executor, const G& graph, ColouringMethod chosen,
                            std::vector<std::uint8_t>& bytes) {
  const std::size_t n = bytes.size();
  return with_class_of(chosen, [&]<class Method>(Method) {
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
  with_class_of(chosen, [&]<class Method>(Method) {
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

template std::uint32_t colour_in_words(const Executor&, const Csr32&, ColouringMethod, Colours32&);
template std::uint32_t colour_in_words(const Executor&, const Csr64&, ColouringMethod, Colours32&);
template std::uint32_t colour_in_words(const Executor&, const AnyGraph&, ColouringMethod,
                                       Colours32&);
template bool colour_slowly_in_bytes(const Executor&, const Csr32&, ColouringMethod, Colours8&);
template bool colour_slowly_in_bytes(const Executor&, const Csr64&, ColouringMethod, Colours8&);
template bool colour_slowly_in_bytes(const Executor&, const AnyGraph&, ColouringMethod, Colours8&);

}  // namespace detail
}  // namespace ductile::runtime
