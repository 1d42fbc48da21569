#include "ductile/runtime/detail/source_order.hpp"

#include <algorithm>

namespace ductile::runtime::detail {

namespace {

/// Heaps of the standard library have the greatest element first, so the comparison is reversed.
bool comes_later(const SourcePiece& a, const SourcePiece& b) {
  return a.first != b.first ? a.first > b.first : a.number > b.number;
}

}  // namespace

void make_heap_of(std::vector<SourcePiece>& pieces) {
  std::make_heap(pieces.begin(), pieces.end(), comes_later);
}

SourcePiece take_first(std::vector<SourcePiece>& heap) {
  std::pop_heap(heap.begin(), heap.end(), comes_later);
  const SourcePiece piece = heap.back();
  heap.pop_back();
  return piece;
}

void put_back(std::vector<SourcePiece>& heap, const SourcePiece& piece) {
  heap.push_back(piece);  // there is room, because a piece was taken
  std::push_heap(heap.begin(), heap.end(), comes_later);
}

std::uint64_t ahead_up_to(const std::vector<SourcePiece>& heap, const SourcePiece& piece) {
  if (heap.empty()) return ~std::uint64_t{0};
  // The piece was first: if its number is greater, it begins with a lower source.
  const SourcePiece& next = heap.front();
  return piece.number < next.number ? next.first : next.first - 1;
}

}  // namespace ductile::runtime::detail
