/// @file
/// balance: evens out the classes of a colouring. Classes that run one after the other keep all
/// threads busy only if none is tiny, and first-fit gives the first colours to most vertices.
/// Each oversized class offers its vertices to undersized ones. Vertices of a class are not
/// neighbours, so all choose at once; prefix sums over fixed blocks decide which ones move.
#pragma once

#include <algorithm>
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

/// Surplus and room of each class of a colouring; decides which vertices move.
class ClassSizes {
 public:
  explicit ClassSizes(const ColourClasses& classes);

  std::size_t surplus(std::uint32_t colour) const;
  std::size_t room(std::uint32_t colour) const;
  std::size_t room() const { return room_before_.back(); }
  /// A colour with room, chosen with probability proportional to it; `number` is any hash.
  std::uint32_t colour_with_room(std::uint32_t number) const;
  /// Moves vertices of one class to the colours they want (Colouring::none: nowhere) while there is
  /// room and surplus; returns how many moved.
  std::size_t move(const Executor& executor, std::span<const std::uint32_t> vertices,
                   std::span<const std::uint32_t> wanted, std::vector<std::uint32_t>& colour_of);

 private:
  void find_room();

  std::size_t fair_;                      // the size of a class if all were equal, rounded up
  std::vector<std::size_t> size_of_;      // [colour]
  std::vector<std::size_t> room_before_;  // [colour], total room of all colours before it; last, of
                                          // all
};

/// The colours of v's neighbours, as bits.
template <Graph G>
void find_taken(const G& graph, std::uint32_t v, const std::vector<std::uint32_t>& colour_of,
                std::vector<std::uint64_t>& taken) {
  std::fill(taken.begin(), taken.end(), 0);
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    const std::uint32_t colour = colour_of[u];
    if (colour != Colouring::none) taken[colour / 64] |= std::uint64_t{1} << (colour % 64);
  });
}

/// A colour with room that v may take, or Colouring::none.
inline std::uint32_t choose(const ClassSizes& sizes, std::uint32_t v, std::uint32_t colours,
                            const std::vector<std::uint64_t>& taken) {
  const std::uint32_t first = sizes.colour_with_room(mix32(v));
  for (std::uint32_t i = 0; i < colours; ++i) {
    const std::uint32_t colour = first + i < colours ? first + i : first + i - colours;
    if ((taken[colour / 64] >> (colour % 64) & 1U) == 0 && sizes.room(colour) > 0) return colour;
  }
  return Colouring::none;
}

/// balance(), run in the current team.
template <Graph G>
void balance_in_team(const Executor& executor, const G& graph, Colouring& colouring,
                     const BalanceOptions& options) {
  PerThread<std::vector<std::uint64_t>> taken(executor);
  for (std::size_t t = 0; t < taken.size(); ++t) taken[t].resize(colouring.count / 64 + 1);
  for (int pass = 0; pass < options.most_passes; ++pass) {
    const ColourClasses classes = colour_classes(executor, colouring);
    ClassSizes sizes(classes);
    std::size_t moved = 0;
    for (std::uint32_t c = 0; c < colouring.count && sizes.room() > 0; ++c) {
      if (sizes.surplus(c) == 0) continue;
      const std::span vertices = classes.members(c);
      std::vector<std::uint32_t> wanted(vertices.size());
      parallel_for(executor, vertices.size(),
                   [&](std::size_t i) {
                     find_taken(graph, vertices[i], colouring.colour_of, taken.mine());
                     wanted[i] = choose(sizes, vertices[i], colouring.count, taken.mine());
                   },
                   {.grain = 256, .serial_below = 1024});
      moved += sizes.move(executor, vertices, wanted, colouring.colour_of);
    }
    if (moved == 0) break;
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
