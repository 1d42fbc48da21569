/// @file
/// Skew heaps: heaps that share one array of entries, and of which two are melted into one in
/// logarithmic time, taken over many (Sleator & Tarjan, SIAM J. Comput. 15, 1986). A heap is known
/// by the number of its least entry, or `none`. Different heaps may be changed by different
/// threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace example {

/// Entry has operator<.
template <class Entry>
class SkewHeaps {
 public:
  using Heap = std::uint32_t;
  static constexpr Heap none = 0xffffffffU;

  /// Heaps of one entry each.
  explicit SkewHeaps(std::size_t entries) : nodes_(entries) {}

  /// The heap's least entry. Who changes it keeps it in order.
  Entry& least(Heap heap) { return nodes_[heap].entry; }
  const Entry& least(Heap heap) const { return nodes_[heap].entry; }

  /// One heap of two: merges their right spines, and swaps the children on the way.
  Heap melt(Heap a, Heap b) {
    Heap top = none;
    Heap* place = &top;
    while (a != none && b != none) {
      if (nodes_[b].entry < nodes_[a].entry) std::swap(a, b);
      *place = a;
      place = &nodes_[a].left;
      a = std::exchange(nodes_[a].right, nodes_[a].left);
    }
    *place = a == none ? b : a;
    return top;
  }

  /// The heap without its least entry.
  Heap without_least(Heap heap) { return melt(nodes_[heap].left, nodes_[heap].right); }

 private:
  struct Node {
    Entry entry;
    Heap left = none, right = none;
  };
  std::vector<Node> nodes_;
};

}  // namespace example
