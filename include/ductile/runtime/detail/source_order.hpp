/// @file
/// SourceOrder: visits entries in the order of their sources. They are added as arrays with long
/// ascending runs, because a thread goes through its part of a loop in order and rarely steals a
/// part of another's. So it notes ascending pieces and merges them, long stretches at a time.
/// Thread safety: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ductile::runtime::detail {

/// Consecutive entries with ascending sources.
struct SourcePiece {
  std::uint64_t first;  // source
  std::size_t number;   // in order of adding
  void *begin, *end;
};

/// Makes a heap of the pieces to merge. Entries with equal sources are ordered by number.
void make_heap_of(std::vector<SourcePiece>& pieces);
/// Removes the piece with the lowest first source from the heap.
SourcePiece take_first(std::vector<SourcePiece>& heap);
/// Puts back the rest of that piece. Does not throw.
void put_back(std::vector<SourcePiece>& heap, const SourcePiece& piece);
/// The greatest source up to which entries of this piece come before all those in the heap.
std::uint64_t ahead_up_to(const std::vector<SourcePiece>& heap, const SourcePiece& piece);

/// An Entry has an integer member `source`.
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

  /// Calls visit(entry) for all entries, those of one source in the order of adding; call clear()
  /// afterwards. Throws std::bad_alloc.
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
