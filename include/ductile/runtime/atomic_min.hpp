/// @file
/// atomic_min: many threads lower one word of an ordinary array. With a priority in the word this
/// is how operations reserve what they need: the lowest priority is what remains, whatever the
/// timing. In one phase of a loop a word is accessed through these functions only.
/// Thread safety: any thread.
#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace ductile::runtime {

// The orders are relaxed: between two barriers only the words themselves carry information. What
// a thread wrote before is ordered by the barrier at the end of the loop, which every reader of
// the outcome has passed.

/// Lowers the word to `value` if that is less; true if it did. Once true, a later call by another
/// thread may lower it further.
template <std::unsigned_integral Word>
bool atomic_min(Word& where, std::type_identity_t<Word> value) {
  const std::atomic_ref word(where);
  Word seen = word.load(std::memory_order_relaxed);
  while (value < seen) {
    if (word.compare_exchange_weak(seen, value, std::memory_order_relaxed)) return true;
  }
  return false;
}

}  // namespace ductile::runtime
