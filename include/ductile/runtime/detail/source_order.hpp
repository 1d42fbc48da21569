/// @file
/// SourceOrder: visits entries in the order of their sources. They are added as arrays, which
/// mostly ascend for long: a thread goes through its part of a loop in order and takes a part of
/// another's now and then. So it notes ascending pieces and merges them, long stretches of one at a
/// time; only where there is no order to speak of it sorts entries one by one. Thread safety: one
/// thread at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace ductile::runtime::detail {

/// A stable sort of keyed values that costs little when the input is a few sorted runs one after
/// the other, as it is when each thread walked its share of a list in order. It finds the runs and
/// merges neighbours until one is left (natural merge sort). Thread safety: one thread at a time.
template <class Key, class Value>
class RunSort {
 public:
  struct Keyed {
    Key key;
    Value value;
  };

  void clear() {
    items_.clear();
    run_begins_.clear();
  }

  void append(Key key, Value value) {
    if (items_.empty() || key < items_.back().key) run_begins_.push_back(items_.size());
    items_.push_back({key, value});
  }

  /// What was appended, ordered by key, equal keys as appended. Valid until the next append.
  std::span<const Keyed> sorted() {
    scratch_.resize(run_begins_.size() > 1 ? items_.size() : 0);
    while (run_begins_.size() > 1) merge_neighbours();
    return items_;
  }

 private:
  /// Halves the number of runs.
  void merge_neighbours() {
    const auto at = [](std::vector<Keyed>& v, std::size_t i) {
      return v.begin() + static_cast<std::ptrdiff_t>(i);
    };
    const auto less = [](const Keyed& a, const Keyed& b) { return a.key < b.key; };
    const std::size_t runs = run_begins_.size();
    const auto bound = [&](std::size_t r) { return r < runs ? run_begins_[r] : items_.size(); };
    std::size_t kept = 0;
    for (std::size_t r = 0; r < runs; r += 2) {
      const std::size_t begin = bound(r), middle = bound(r + 1), end = bound(r + 2);
      std::merge(at(items_, begin), at(items_, middle), at(items_, middle), at(items_, end),
                 at(scratch_, begin), less);
      run_begins_[kept++] = begin;
    }
    run_begins_.resize(kept);
    items_.swap(scratch_);
  }

  std::vector<Keyed> items_, scratch_;
  std::vector<std::size_t> run_begins_;  // where the sorted runs of items_ start
};

extern template class RunSort<std::uint64_t, void*>;

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
  void clear() {
    pieces_.clear();
    count_ = 0;
  }

  /// Throws std::bad_alloc.
  void add(Entry* begin, Entry* end) {
    if (begin == end) return;
    count_ += static_cast<std::size_t>(end - begin);
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
    if (pieces_.size() > 64 && pieces_.size() > count_ / 8) return sort_and_visit(visit);
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

  template <class Visit>
  void sort_and_visit(Visit& visit) {
    sort_.clear();
    for (const SourcePiece& piece : pieces_)
      for (auto* entry = static_cast<Entry*>(piece.begin); entry != piece.end; ++entry)
        sort_.append(entry->source, entry);
    for (const auto& keyed : sort_.sorted()) visit(*static_cast<Entry*>(keyed.value));
  }

  std::vector<SourcePiece> pieces_;
  std::size_t count_ = 0;  // entries
  RunSort<std::uint64_t, void*> sort_;
};

}  // namespace ductile::runtime::detail
