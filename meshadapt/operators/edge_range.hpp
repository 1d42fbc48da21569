/// @file
/// EdgeRange: the lengths that a kernel may give to edges where it aims at quality alone. Moves
/// and swaps that lead no edge out of the range, or farther out of it, undo nothing of what
/// collapses and splits have reached, so that the end of a run cannot go in circles.
#pragma once

#include <algorithm>
#include <limits>

#include "ductile/meshadapt/simplex.hpp"
#include "operators/cavity.hpp"

namespace ductile::meshadapt {

struct EdgeRange {
  double shortest = 0, longest = std::numeric_limits<double>::infinity();  ///< metric lengths

  bool is_bounded() const { return longest < std::numeric_limits<double>::infinity(); }
  bool contains(const EndSquares& edge) const {
    return shorter_than(edge, longest) && !shorter_than(edge, shortest);
  }
  /// May an edge become this one? In the range, or no farther from it than it was.
  bool accepts(const EndSquares& after, const EndSquares& before) const {
    if (contains(after)) return true;
    const double length = edge_length(after), was = edge_length(before);
    return length < shortest ? length >= was : length <= was;
  }
};

/// Are all edges that a replacement makes in the range, or at least closer to it than the one that
/// goes? `gone` are the ends of that edge, or twice the same vertex if no edge goes.
template <int Dim, int Space>
bool keeps_lengths(const Mesh<Dim, Space>& mesh, const Replacement<Dim>& plan,
                   const std::array<VertexId, 2>& gone, const EdgeRange& range) {
  if (!range.is_bounded()) return true;
  const auto squares = [&](VertexId a, VertexId b) {
    return end_squares(mesh.site_of[a], mesh.site_of[b]);
  };
  const auto was_there = [&](VertexId a, VertexId b) {
    return std::any_of(plan.old_elements.begin(), plan.old_elements.end(), [&](ElementId e) {
      return contains(mesh.corners_of[e], a) && contains(mesh.corners_of[e], b);
    });
  };
  for (const Corners<Dim>& corners : plan.new_elements)
    for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
      const auto [a, b] = ends_of_edge<Dim>(corners, k);
      const EndSquares edge = squares(a, b);
      if (range.contains(edge) || was_there(a, b)) continue;
      if (gone[0] == gone[1] || !range.accepts(edge, squares(gone[0], gone[1]))) return false;
    }
  return true;
}

}  // namespace ductile::meshadapt
