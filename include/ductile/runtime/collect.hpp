/// @file
/// parallel_collect: gathers what a loop finds into one array, in the order of the loop's indices,
/// so the result does not depend on threads or timing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Calls find(i, append) for i in [0, n); append(item) adds an item to the result. Items of a lower
/// i come first. Item is default-constructible and movable. Thread safety: one caller; runs on the
/// executor.
template <class Item, class Find>
std::vector<Item> parallel_collect(const Executor& executor, std::size_t n, Find&& find) {
  const std::size_t block_size = std::clamp<std::size_t>(n / 4096, 16, 1024);
  std::vector<std::vector<Item>> found((n + block_size - 1) / block_size);
  parallel_for_blocks(executor, n, block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        std::vector<Item>& mine = found[block];
                        for (std::size_t i = begin; i < end; ++i)
                          find(i, [&](Item item) { mine.push_back(std::move(item)); });
                      });
  std::vector<std::size_t> offset(found.size());
  std::size_t total = 0;
  for (std::size_t b = 0; b < found.size(); ++b) {
    offset[b] = total;
    total += found[b].size();
  }
  std::vector<Item> all(total);
  parallel_for(executor, found.size(),
               [&](std::size_t b) {
                 std::move(found[b].begin(), found[b].end(),
                           all.begin() + static_cast<std::ptrdiff_t>(offset[b]));
               },
               {.grain = 16, .serial_below = 64});
  return all;
}

}  // namespace ductile::runtime
