/// @file
/// Divider: divides cells (edges, triangles, tetrahedra) at the new vertices of their edges. The
/// edges of a cell are bisected one after another in an order of all edges, so that neighbours that
/// share a facet divide it in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "levelset/crossings.hpp"

namespace ductile::meshadapt {

/// The cells that one is divided into, in an order that depends on it alone.
template <std::size_t Corners>
struct Pieces {
  static constexpr std::size_t most = 8;
  std::array<std::array<VertexId, Corners>, most> corners;
  std::size_t count = 0;

  auto begin() const { return corners.begin(); }
  auto end() const { return corners.begin() + static_cast<std::ptrdiff_t>(count); }
};

class Divider {
 public:
  /// Crossings are sorted by their vertices; crossing i gets the vertex first_new + i.
  Divider(std::span<const Crossing> crossings, const std::vector<std::int8_t>& sign_of)
      : crossings_(crossings),
        sign_of_(sign_of),
        first_new_(static_cast<VertexId>(sign_of.size())) {}

  /// Thread safety: any thread.
  template <std::size_t Corners>
  Pieces<Corners> divide(const std::array<VertexId, Corners>& cell) const {
    Pieces<Corners> pieces;
    pieces.corners[0] = cell;
    pieces.count = 1;
    std::array<const Crossing*, 6> cuts;
    std::size_t cut_count = 0;
    for (std::size_t i = 0; i < Corners; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const Crossing* cut = find(cell[i], cell[j])) {
          std::size_t at = cut_count++;
          for (; at > 0 && cut->comes_before(*cuts[at - 1]); --at) cuts[at] = cuts[at - 1];
          cuts[at] = cut;
        }
    for (std::size_t k = 0; k < cut_count; ++k) bisect(pieces, *cuts[k]);
    return pieces;
  }

  /// The sign of a vertex, also of a new one.
  int sign(VertexId vertex) const { return vertex < first_new_ ? sign_of_[vertex] : 0; }

 private:
  template <std::size_t Corners>
  void bisect(Pieces<Corners>& pieces, const Crossing& cut) const {
    const auto made = first_new_ + static_cast<VertexId>(&cut - crossings_.data());
    for (std::size_t p = 0, before = pieces.count; p < before; ++p) {
      auto& piece = pieces.corners[p];
      const int a = corner_of(piece, cut.a), b = corner_of(piece, cut.b);
      if (a < 0 || b < 0) continue;
      auto& other = pieces.corners[pieces.count++] = piece;
      piece[static_cast<std::size_t>(b)] = made;
      other[static_cast<std::size_t>(a)] = made;
    }
  }

  const Crossing* find(VertexId a, VertexId b) const {
    if (sign_of_[a] * sign_of_[b] >= 0) return nullptr;
    if (a > b) std::swap(a, b);
    const auto at = std::lower_bound(crossings_.begin(), crossings_.end(), b,
                                     [a](const Crossing& edge, VertexId other) {
                                       return edge.a != a ? edge.a < a : edge.b < other;
                                     });
    return at != crossings_.end() && at->a == a && at->b == b ? &*at : nullptr;
  }

  std::span<const Crossing> crossings_;
  const std::vector<std::int8_t>& sign_of_;
  VertexId first_new_;
};

}  // namespace ductile::meshadapt
