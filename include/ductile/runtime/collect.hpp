/// @file
/// parallel_collect: gathers what a loop finds into one array, in the order of the loop's indices,
/// so the result does not depend on threads or timing. Threads keep what they find, block after
/// block, in arrays of their own, and copy it to its place when all is found.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

namespace detail {

/// Where the finds of a block are: in which thread's array, and then in the result.
struct Finds {
  std::size_t begin, count, place;
  std::uint32_t thread;
};

}  // namespace detail

/// Calls find(i, append) for i in [0, n); append(item) adds an item to the result. Items of a lower
/// i come first. Item is default-constructible and movable. Fewer than `serial_below` indices are
/// looked at by the caller alone. Thread safety: one caller; runs on the executor.
template <class Item, class Find>
UnsetVector<Item> parallel_collect(const Executor& executor, std::size_t n, Find&& find,
                                   std::size_t serial_below = 0) {
  if (executor.threads() == 1 || n < serial_below) {  // which finds them in order
    UnsetVector<Item> all;
    const auto append = [&](Item item) { all.push_back(std::move(item)); };
    parallel_for(executor, n, [&](std::size_t i) { find(i, append); }, {.serial_below = n + 1});
    return all;
  }
  const std::size_t block_size = std::clamp<std::size_t>(n / 2048, 4, 1024);
  const std::size_t blocks = (n + block_size - 1) / block_size;
  const auto finds_of = std::make_unique_for_overwrite<detail::Finds[]>(blocks);
  PerThread<std::vector<Item>> found(executor);
  parallel_for_blocks(executor, n, block_size,
                      [&](std::size_t block, std::size_t begin, std::size_t end) {
                        std::vector<Item>& mine = found.mine();
                        const std::size_t before = mine.size();
                        for (std::size_t i = begin; i < end; ++i)
                          find(i, [&](Item item) { mine.push_back(std::move(item)); });
                        finds_of[block] = {before, mine.size() - before, 0,
                                           static_cast<std::uint32_t>(this_thread())};
                      });
  std::size_t total = 0;
  for (std::size_t b = 0; b < blocks; ++b)
    finds_of[b].place = std::exchange(total, total + finds_of[b].count);
  auto all = make_unset_vector<Item>(executor, total);
  const auto put = [&](std::size_t b) {
    const detail::Finds& finds = finds_of[b];
    Item* const first = found[finds.thread].data() + finds.begin;
    std::move(first, first + finds.count, all.data() + finds.place);
  };
  // Few finds are moved before other threads would have begun.
  parallel_for(executor, blocks, put,
               {.grain = 16, .serial_below = total < 2048 ? blocks + 1 : 64});
  return all;
}

}  // namespace ductile::runtime
