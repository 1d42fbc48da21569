/// @file
/// balance: evens out the classes of a colouring. Classes that run one after the other keep all
/// threads busy only if none is tiny, and first-fit gives the first colours to most vertices.
/// Each oversized class offers its vertices to undersized ones. Vertices of a class are not
/// neighbours, so all choose at once; then they move in order, while there is room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Options of balance().
struct BalanceOptions {
  int most_passes = 8;  ///< over all classes; stops earlier if a pass changes nothing
};

namespace detail {

/// The sizes of classes, and how far they are from equal.
struct ClassSizes {
  std::size_t fair;                  ///< the size of a class if all were equal, rounded up
  std::vector<std::size_t> size_of;  ///< [colour]

  explicit ClassSizes(const ColourClasses& classes)
      : fair(classes.vertices.empty() ? 0 : (classes.vertices.size() - 1) / classes.count() + 1) {
    for (std::size_t c = 0; c < classes.count(); ++c) size_of.push_back(classes.members(c).size());
  }
  bool has_surplus(std::uint32_t colour) const { return size_of[colour] > fair; }
  bool has_room(std::uint32_t colour) const { return size_of[colour] < fair; }
};

/// A colour with room that no neighbour of v has, or Colouring::none. Vertices begin to search at
/// different colours. `is_taken` is for scratch.
template <Graph G>
std::uint32_t colour_with_room(const G& graph, std::uint32_t v, const ClassSizes& sizes,
                               const std::vector<std::uint32_t>& colour_of,
                               std::vector<bool>& is_taken) {
  const auto colours = static_cast<std::uint32_t>(sizes.size_of.size());
  is_taken.assign(colours, false);
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    if (colour_of[u] != Colouring::none) is_taken[colour_of[u]] = true;
  });
  const std::uint32_t first = mix32(v) % colours;
  for (std::uint32_t i = 0; i < colours; ++i) {
    const std::uint32_t colour = first + i < colours ? first + i : first + i - colours;
    if (!is_taken[colour] && sizes.has_room(colour)) return colour;
  }
  return Colouring::none;
}

/// balance(), run in the current team.
template <Graph G>
void balance_in_team(const Executor& executor, const G& graph, Colouring& colouring,
                     const BalanceOptions& options) {
  PerThread<std::vector<bool>> is_taken(executor);
  std::size_t moved = 1;
  for (int pass = 0; pass < options.most_passes && moved > 0; ++pass) {
    moved = 0;
    const ColourClasses classes = colour_classes(executor, colouring);
    ClassSizes sizes(classes);
    for (std::uint32_t c = 0; c < colouring.count; ++c) {
      if (!sizes.has_surplus(c)) continue;
      const std::span vertices = classes.members(c);
      std::vector<std::uint32_t> wanted(vertices.size());
      parallel_for(executor, vertices.size(),
                   [&](std::size_t i) {
                     wanted[i] = colour_with_room(graph, vertices[i], sizes, colouring.colour_of,
                                                  is_taken.mine());
                   },
                   {.grain = 256, .serial_below = 1024});
      for (std::size_t i = 0; i < vertices.size() && sizes.has_surplus(c); ++i) {
        if (wanted[i] == Colouring::none || !sizes.has_room(wanted[i])) continue;
        colouring.colour_of[vertices[i]] = wanted[i];
        --sizes.size_of[c];
        ++sizes.size_of[wanted[i]];
        ++moved;
      }
    }
  }
}

}  // namespace detail

/// Moves vertices between classes of a proper colouring until all have about the same size, as far
/// as neighbours allow. The colouring stays proper and gets no new colour; no class grows beyond
/// the even size or shrinks below it. Deterministic. Throws std::bad_alloc and what the graph
/// throws.
/// Thread safety: any thread.
template <Graph G>
void balance(const Executor& executor, const G& graph, Colouring& colouring,
             const BalanceOptions& options = {}) {
  detail::with_team_for(colouring.colour_of.size(), executor,
                        [&] { detail::balance_in_team(executor, graph, colouring, options); });
}

}  // namespace ductile::runtime
