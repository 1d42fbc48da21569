#include <utility>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/detail/colour_rounds.hpp"

namespace ductile::runtime::detail {

ConflictClasses classes_of_conflicts(const Executor& executor, std::span<const std::uint64_t> begin,
                                     std::span<const std::uint32_t> neighbours) {
  const CsrGraph<std::uint64_t> graph{begin, neighbours};
  ColourClasses classes = colour_classes(executor, colour(executor, graph));
  return {std::move(classes.vertices), std::move(classes.begin)};
}

}  // namespace ductile::runtime::detail
