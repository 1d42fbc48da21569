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
#include <utility>
#include <vector>

#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// An edge that the surface crosses at (1 - t) a + t b; a < b.
struct Crossing {
  VertexId a, b;
  double t;
  double squared_length;

  /// The longest edges are bisected first.
  bool comes_before(const Crossing& other) const {
    if (squared_length != other.squared_length) return squared_length > other.squared_length;
    return std::pair(a, b) < std::pair(other.a, other.b);
  }
};

/// The cells that one is divided into.
template <std::size_t Corners>
struct Pieces {
  std::array<std::array<VertexId, Corners>, 8> corners;
  std::size_t count = 0;

  auto begin() const { return corners.begin(); }
  auto end() const { return corners.begin() + static_cast<std::ptrdiff_t>(count); }
};

/// Thread safety: any thread.
class Divider {
 public:
  /// Crossings are sorted by their vertices; crossing i gets the vertex sign_of.size() + i.
  Divider(std::span<const Crossing> crossings, const std::vector<std::int8_t>& sign_of)
      : crossings_(crossings), sign_of_(sign_of) {}

  template <std::size_t Corners>
  Pieces<Corners> divide(const std::array<VertexId, Corners>& cell) const {
    std::array<const Crossing*, 6> cuts;
    std::size_t cut_count = 0;
    for (std::size_t i = 0; i < Corners; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const Crossing* cut = find(cell[i], cell[j])) {
          std::size_t at = cut_count++;
          for (; at > 0 && cut->comes_before(*cuts[at - 1]); --at) cuts[at] = cuts[at - 1];
          cuts[at] = cut;
        }
    Pieces<Corners> pieces;
    pieces.corners[pieces.count++] = cell;
    for (std::size_t k = 0; k < cut_count; ++k) bisect(pieces, *cuts[k]);
    return pieces;
  }

  /// The crossing of an edge; null if it is not cut.
  const Crossing* find(VertexId a, VertexId b) const {
    if (sign_of_[a] * sign_of_[b] >= 0) return nullptr;
    const std::pair<VertexId, VertexId> ends = std::minmax(a, b);
    const auto at = std::ranges::lower_bound(
        crossings_, ends, {}, [](const Crossing& edge) { return std::pair(edge.a, edge.b); });
    return at != crossings_.end() && std::pair(at->a, at->b) == ends ? &*at : nullptr;
  }

  /// The sign of a vertex, also of a new one.
  int sign(VertexId vertex) const { return vertex < sign_of_.size() ? sign_of_[vertex] : 0; }

  /// The sign of a cell without crossings; 0 if all its vertices are on the surface.
  template <std::size_t Corners>
  int side(const std::array<VertexId, Corners>& cell) const {
    for (const VertexId v : cell)
      if (sign(v) != 0) return sign(v);
    return 0;
  }

  /// Where a vertex is, also a new one; place_of[vertex] has the others.
  template <int Space>
  Vector<Space> place(const std::vector<Vector<Space>>& place_of, VertexId vertex) const {
    if (vertex < sign_of_.size()) return place_of[vertex];
    const Crossing& edge = crossings_[vertex - sign_of_.size()];
    return place_of[edge.a] + edge.t * (place_of[edge.b] - place_of[edge.a]);
  }

  template <int Space, std::size_t Corners>
  std::array<Vector<Space>, Corners> places(const std::vector<Vector<Space>>& place_of,
                                            const std::array<VertexId, Corners>& cell) const {
    std::array<Vector<Space>, Corners> result;
    for (std::size_t i = 0; i < Corners; ++i) result[i] = place(place_of, cell[i]);
    return result;
  }

 private:
  template <std::size_t Corners>
  void bisect(Pieces<Corners>& pieces, const Crossing& cut) const {
    const auto made =
        static_cast<VertexId>(sign_of_.size() + static_cast<std::size_t>(&cut - crossings_.data()));
    for (std::size_t p = 0, before = pieces.count; p < before; ++p) {
      auto& piece = pieces.corners[p];
      const int a = corner_of(piece, cut.a), b = corner_of(piece, cut.b);
      if (a < 0 || b < 0) continue;
      auto& other = pieces.corners[pieces.count++] = piece;
      piece[static_cast<std::size_t>(b)] = made;
      other[static_cast<std::size_t>(a)] = made;
    }
  }

  std::span<const Crossing> crossings_;
  const std::vector<std::int8_t>& sign_of_;
};

}  // namespace ductile::meshadapt
