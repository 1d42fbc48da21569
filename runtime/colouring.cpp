#include "ductile/runtime/colouring.hpp"

#include <algorithm>
#include <utility>

namespace ductile::runtime {

namespace detail {

std::uint32_t colour_count(const Executor& executor, std::span<const std::uint32_t> colour_of) {
  constexpr std::size_t block = 4096;
  std::vector<std::uint32_t> most((colour_of.size() + block - 1) / block);
  parallel_for_blocks(executor, colour_of.size(), block,
                      [&](std::size_t b, std::size_t begin, std::size_t end) {
                        std::uint32_t greatest = 0;
                        for (std::size_t i = begin; i < end; ++i)
                          greatest = std::max(greatest, colour_of[i] + 1);  // none counts as 0
                        most[b] = greatest;
                      });
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

}  // namespace detail

ColourClasses colour_classes(const Executor& executor, const Colouring& colouring) {
  const std::vector<std::uint32_t>& colour_of = colouring.colour_of;
  const std::size_t n = colour_of.size(), colours = colouring.count;
  // Blocks long enough that their counters do not outweigh the vertices.
  const std::size_t block = std::max<std::size_t>({1024, 16 * colours, n / 256});
  const std::size_t blocks = (n + block - 1) / block;
  std::vector<std::size_t> place(blocks * colours);  // [block][colour]
  parallel_for_blocks(executor, n, block, [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (colour_of[v] != Colouring::none) ++place[b * colours + colour_of[v]];
  });
  ColourClasses classes;
  std::size_t sum = 0;
  for (std::size_t c = 0; c < colours; ++c) {
    classes.begin.push_back(sum);
    for (std::size_t b = 0; b < blocks; ++b) sum += std::exchange(place[b * colours + c], sum);
  }
  classes.begin.push_back(sum);
  classes.vertices.resize(sum);
  parallel_for_blocks(executor, n, block, [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (colour_of[v] != Colouring::none)
        classes.vertices[place[b * colours + colour_of[v]]++] = static_cast<std::uint32_t>(v);
  });
  return classes;
}

}  // namespace ductile::runtime
