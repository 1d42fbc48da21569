/// @file
/// SourceOrder: visits entries in the order of their sources. They are added as arrays, which
/// mostly ascend for long: a thread goes through its part of a loop in order and takes a part of
/// another's now and then. So it notes ascending pieces and merges them, long stretches of one at a
/// time. Thread safety: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ductile::runtime::detail {

/// Entries with ascending sources, in a row.
struct SourcePiece {
  std::uint64_t first;  // source
  std::size_t number;   // in order of adding
  void *begin, *end;
};

/// Pieces to merge, a heap. Of entries with equal sources those of the lower number come first.
void make_heap_of(std::vector<SourcePiece>& pieces);
/// Takes the piece that begins first out of the heap.
SourcePiece take_first(std::vector<SourcePiece>& heap);
/// Puts what is left of that back. Does not throw.
void put_back(std::vector<SourcePiece>& heap, const SourcePiece& piece);
/// The greatest source up to which entries of this piece come before all those in the heap.
std::uint64_t ahead_up_to(const std::vector<SourcePiece>& heap, const SourcePiece& piece);

/// An Entry has a member `source`, a number.
template <class Entry>
class SourceOrder {
 public:
  void clear() { pieces_.clear(); }

  /// Throws std::bad_alloc.
  void add(Entry* begin, Entry* end) {
    if (begin == end) return;
    Entry* piece = begin;
    for (Entry* entry = begin + 1; entry != end; ++entry)
      if (entry->source < entry[-1].source) [[unlikely]]
        add_piece(piece, entry), piece = entry;
    add_piece(piece, end);
  }

  /// Calls visit(entry) for all, those of one source as they were added; to be cleared then.
  /// Throws std::bad_alloc.
  template <class Visit>
  void for_each(Visit&& visit) {
    make_heap_of(pieces_);
    while (!pieces_.empty()) {
      SourcePiece piece = take_first(pieces_);
      const std::uint64_t last = ahead_up_to(pieces_, piece);
      auto* entry = static_cast<Entry*>(piece.begin);
      do visit(*entry++);
      while (entry != piece.end && entry->source <= last);
      if (entry == piece.end) continue;
      piece.begin = entry;
      piece.first = entry->source;
      put_back(pieces_, piece);
    }
  }

 private:
  void add_piece(Entry* begin, Entry* end) {
    pieces_.push_back({begin->source, pieces_.size(), begin, end});
  }

  std::vector<SourcePiece> pieces_;
};

}  // namespace ductile::runtime::detail
