/// @file
/// The lists of elements around vertices, made anew, and what else makes lists by counting.
/// Threads fill a list in any order, so it is sorted then; one thread alone fills it in order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/atomic_count.hpp"

namespace ductile::meshadapt {

/// Counts up and returns the value before. Thread safety: any thread, unless the caller is alone.
inline std::uint32_t count_up(std::uint32_t& count, bool alone) {
  return alone ? count++ : runtime::atomic_count(count);
}

/// For lists that are mostly short.
inline void sort_short(std::span<std::uint32_t> list) {
  if (list.size() > 64) return std::sort(list.begin(), list.end());
  for (std::size_t i = 1; i < list.size(); ++i) {
    const std::uint32_t value = list[i];
    std::size_t at = i;
    for (; at != 0 && value < list[at - 1]; --at) list[at] = list[at - 1];
    list[at] = value;
  }
}

/// Adds to each of the counts how many elements a vertex has.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
void count_elements(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                    std::span<std::uint32_t> count_of);

/// Makes elements_of from corners_of, where it is known how many elements each vertex has.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
void list_elements(const runtime::Executor& executor, Mesh<Dim>& mesh,
                   std::span<const std::uint32_t> count_of);

extern template void count_elements(const runtime::Executor&, const Mesh<2>&,
                                    std::span<std::uint32_t>);
extern template void count_elements(const runtime::Executor&, const Mesh<3>&,
                                    std::span<std::uint32_t>);
extern template void list_elements(const runtime::Executor&, Mesh<2>&,
                                   std::span<const std::uint32_t>);
extern template void list_elements(const runtime::Executor&, Mesh<3>&,
                                   std::span<const std::uint32_t>);

}  // namespace ductile::meshadapt
