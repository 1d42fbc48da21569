/// @file
/// Pieces: an element while it is cut in halves at the middles of some of its edges, one after the
/// other. Knows numbers only: which corners each piece has, and on which of the element's facets
/// the facets of pieces lie.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// A point of a cut element: below Dim + 1 one of its corners, else the middle of an edge.
using PointOfCut = std::uint8_t;
template <int Dim>
inline constexpr std::size_t points_of_cut = Dim + 1 + Simplex<Dim>::edges;
template <int Dim>
constexpr PointOfCut middle_of(std::size_t edge) {
  return static_cast<PointOfCut>(Dim + 1 + edge);
}

template <int Dim>
struct Piece {
  static constexpr std::uint8_t inside = 255;
  std::array<PointOfCut, Dim + 1> corners;  ///< in the order of the element's, so oriented as it
  std::array<std::uint8_t, Dim + 1>
      facet_of;  ///< [facet], the element's facet it lies on, or inside

  bool has(PointOfCut point) const {
    bool any = false;
    for (const PointOfCut corner : corners) any |= corner == point;
    return any;
  }
};

template <int Dim>
class Pieces {
 public:
  static constexpr std::size_t most = Dim == 2 ? 4 : 8;

  Pieces() {
    for (std::size_t i = 0; i <= Dim; ++i)
      pieces_[0].corners[i] = pieces_[0].facet_of[i] = static_cast<std::uint8_t>(i);
  }

  std::size_t size() const { return size_; }
  const Piece<Dim>& operator[](std::size_t i) const { return pieces_[i]; }

  /// Does the piece have this edge of the element as a whole? Until the edge is cut, one has.
  bool has_edge(std::size_t piece, std::size_t edge) const {
    const auto [a, b] = Simplex<Dim>::edge[edge];
    return pieces_[piece].has(static_cast<PointOfCut>(a)) &&
           pieces_[piece].has(static_cast<PointOfCut>(b));
  }

  /// Cuts all pieces that have this edge: the half at its first end keeps the piece's place, the
  /// other comes last.
  void cut(std::size_t edge) {
    for (std::size_t i = 0, before = size_; i < before; ++i)
      if (has_edge(i, edge)) cut_piece(i, edge);
  }

 private:
  void cut_piece(std::size_t i, std::size_t edge) {
    Piece<Dim>& first = pieces_[i];
    Piece<Dim>& second = pieces_[size_++];
    second = first;
    const auto [a, b] = Simplex<Dim>::edge[edge];
    for (std::size_t c = 0; c <= Dim; ++c) {
      const bool at_a = second.corners[c] == a, at_b = second.corners[c] == b;
      if (at_b) first.corners[c] = middle_of<Dim>(edge), second.facet_of[c] = Piece<Dim>::inside;
      if (at_a) second.corners[c] = middle_of<Dim>(edge), first.facet_of[c] = Piece<Dim>::inside;
    }
  }

  std::array<Piece<Dim>, most> pieces_;
  std::size_t size_ = 1;
};

}  // namespace ductile::meshadapt
