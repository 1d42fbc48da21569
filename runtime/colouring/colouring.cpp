#include "ductile/runtime/colouring/colouring.hpp"

#include <algorithm>
#include <utility>

namespace ductile::runtime {

namespace detail {

namespace {

/// The maximum of greatest_in(begin, end) over blocks of [0, n); 0 if there are none.
template <class GreatestIn>
std::uint32_t greatest(const Executor& executor, std::size_t n, GreatestIn greatest_in) {
  constexpr std::size_t block = 16384;
  std::vector<std::uint32_t> most((n + block - 1) / block);
  parallel_for_blocks(
      executor, n, block,
      [&](std::size_t b, std::size_t begin, std::size_t end) { most[b] = greatest_in(begin, end); },
      {.grain = 1, .serial_below = 2});
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

}  // namespace

ColouringMethod choose(const Executor& executor, ColouringMethod method, std::size_t vertex_count) {
  // One thread shares with nobody and has no clashes to look for.
  const bool alone = executor.threads() == 1 && (method == ColouringMethod::automatic ||
                                                 method == ColouringMethod::detect_again ||
                                                 method == ColouringMethod::two_phase);
  const bool few =
      vertex_count < (method == ColouringMethod::automatic ? many_vertices : few_vertices);
  return alone || few ? ColouringMethod::serial : method;
}

std::uint32_t colour_count(const Executor& executor, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return 0;
  return 1 + greatest(executor, bytes.size(), [&](std::size_t begin, std::size_t end) {
           std::uint8_t most = 0;
           for (std::size_t i = begin; i < end; ++i) most = std::max(most, bytes[i]);
           return std::uint32_t{most};
         });
}

std::uint32_t colour_count(const Executor& executor, std::span<const std::uint32_t> colour_of) {
  return greatest(executor, colour_of.size(), [&](std::size_t begin, std::size_t end) {
    std::uint32_t most = 0;
    for (std::size_t i = begin; i < end; ++i)
      most = std::max(most, colour_of[i] + 1);  // none counts as 0
    return most;
  });
}

}  // namespace detail

ColourClasses colour_classes(const Executor& executor, const Colouring& colouring) {
  const std::vector<std::uint32_t>& colour_of = colouring.colour_of;
  const std::size_t n = colour_of.size(), colours = colouring.count;
  // Blocks long enough that there are fewer counters than vertices.
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
