/// @file
/// MarkedSet: what is marked in an array of flags, numbered in order, in two bits of memory for
/// each flag: for arrays of what few elements of a large mesh need.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

class MarkedSet {
 public:
  MarkedSet() = default;

  /// Thread safety: one caller; runs on the executor.
  MarkedSet(const runtime::Executor& executor, std::span<const std::uint8_t> marks)
      : words_(runtime::make_filled<std::uint64_t>(executor, (marks.size() + word - 1) / word)),
        place_(runtime::make_filled<std::uint32_t>(executor, words_.size())) {
    runtime::parallel_for(
        executor, words_.size(),
        [&](std::size_t w) {
          const auto part = marks.subspan(w * word, std::min(word, marks.size() - w * word));
          std::uint64_t bits = 0;
          for (std::size_t i = 0; i < part.size(); ++i) bits |= std::uint64_t{part[i] != 0} << i;
          words_[w] = bits;
          place_[w] = static_cast<std::uint32_t>(std::popcount(bits));
        },
        by_word);
    runtime::grow_filled(executor, members_,
                         runtime::exclusive_scan<std::uint32_t>(executor, place_), 0);
    runtime::parallel_for(
        executor, words_.size(),
        [&](std::size_t w) {
          std::uint32_t at = place_[w];
          for (std::uint64_t left = words_[w]; left != 0; left &= left - 1)
            members_[at++] = static_cast<std::uint32_t>(w * word) +
                             static_cast<std::uint32_t>(std::countr_zero(left));
        },
        by_word);
  }

  std::size_t size() const { return members_.size(); }
  std::uint32_t operator[](std::size_t place) const { return members_[place]; }

  /// The index of a member: the number of lower ones. Thread safety: any thread.
  std::uint32_t place_of(std::uint32_t member) const {
    const std::uint64_t lower = (std::uint64_t{1} << member % word) - 1;
    return place_[member / word] +
           static_cast<std::uint32_t>(std::popcount(words_[member / word] & lower));
  }

 private:
  static constexpr std::size_t word = 64;
  static constexpr runtime::LoopOptions by_word{.grain = 16, .serial_below = 64};
  runtime::UnsetVector<std::uint64_t> words_;    // a bit for each mark
  runtime::UnsetVector<std::uint32_t> place_;    // [word], of its first member
  runtime::UnsetVector<std::uint32_t> members_;  // in order
};

}  // namespace ductile::meshadapt
