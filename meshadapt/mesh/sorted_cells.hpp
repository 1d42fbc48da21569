/// @file
/// sorted_cells: finds cells that have the same corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::meshadapt {

/// The corners of a cell, ascending, and its index.
template <std::size_t N>
using SortedCell = std::pair<std::array<std::uint32_t, N>, std::uint32_t>;

/// Cells by their corners, those with the same ones by their indices. Thread safety: one caller;
/// runs on the executor.
template <std::size_t N>
runtime::UnsetVector<SortedCell<N>> sorted_cells(
    const runtime::Executor& executor, const std::vector<std::array<std::uint32_t, N>>& cells) {
  auto sorted = runtime::make_unset_vector<SortedCell<N>>(executor, cells.size());
  runtime::parallel_for(executor, cells.size(), [&](std::size_t i) {
    sorted[i] = {cells[i], static_cast<std::uint32_t>(i)};
    std::ranges::sort(sorted[i].first);
  });
  runtime::parallel_sort(executor, std::span(sorted));
  return sorted;
}

/// The index of the first cell with these corners, in any order; ~0 if there is none.
template <std::size_t N>
std::uint32_t find_cell(std::span<const SortedCell<N>> sorted,
                        std::array<std::uint32_t, N> corners) {
  std::ranges::sort(corners);
  const auto at = std::ranges::lower_bound(sorted, corners, {}, &SortedCell<N>::first);
  return at != sorted.end() && at->first == corners ? at->second : ~std::uint32_t{0};
}

}  // namespace ductile::meshadapt
