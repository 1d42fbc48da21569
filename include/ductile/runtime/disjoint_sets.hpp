/// @file
/// DisjointSets: a union-find structure that many threads change at once, for example to find the
/// connected components of a graph. Each set is a tree whose root is its lowest number, so the
/// result does not depend on the order of unions.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Sets of numbers that many threads unite at once; see the top of this file.
class DisjointSets {
 public:
  /// n sets, of one number each. Throws std::bad_alloc.
  DisjointSets(const Executor& executor, std::size_t n)
      : parent_(make_unset_vector<std::uint32_t>(executor, n)) {
    parallel_for(
        executor, n, [&](std::size_t i) { parent_[i] = static_cast<std::uint32_t>(i); },
        few_nanoseconds);
  }

  std::size_t size() const { return parent_.size(); }

  /// Unites the sets of a and b, in nearly constant time. Thread safety: any thread.
  void unite(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t expected = a;
      if (word(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
    }
  }

  /// Are two numbers in the same set? Concurrent unions may or may not be seen. Follows the higher
  /// parent until both agree or it is a root (Rem; Patwary, Blair & Manne, SEA 2010). Thread
  /// safety: any thread.
  bool are_together(std::uint32_t a, std::uint32_t b) {
    while (true) {
      std::uint32_t above_a = parent_of(a), above_b = parent_of(b);
      if (above_a == above_b) return true;
      if (above_a < above_b) {
        std::swap(a, b);
        std::swap(above_a, above_b);
      }
      if (above_a == a) return false;
      // Path halving, as in root().
      const std::uint32_t next = parent_of(above_a);
      if (next != above_a) word(a).store(next, std::memory_order_relaxed);
      a = next;
    }
  }

  /// Unites the two sets that have these roots. Thread safety: any thread, while no other unites
  /// either.
  void unite_roots(std::uint32_t a, std::uint32_t b) {
    word(std::max(a, b)).store(std::min(a, b), std::memory_order_relaxed);
  }

  /// The lowest number in the set of a. Thread safety: any thread, after the loop that called
  /// unite().
  std::uint32_t lowest(std::uint32_t a) { return root(a); }

 private:
  // Relaxed: a parent is the only datum and is only ever replaced by a lower number of the same
  // set; the barrier at the end of the loop precedes any reader of the result.
  std::atomic_ref<std::uint32_t> word(std::uint32_t i) { return std::atomic_ref(parent_[i]); }

  std::uint32_t parent_of(std::uint32_t i) { return word(i).load(std::memory_order_relaxed); }

  /// The root of i; halves the path for later calls.
  std::uint32_t root(std::uint32_t i) {
    while (true) {
      const std::uint32_t parent = parent_of(i);
      if (parent == i) return i;
      const std::uint32_t next = parent_of(parent);
      // A concurrent store also writes a lower number of the same set.
      if (next != parent) word(i).store(next, std::memory_order_relaxed);
      i = next;
    }
  }

  UnsetVector<std::uint32_t> parent_;  // [number], a lower number of its set, or itself at a root
};

}  // namespace ductile::runtime
