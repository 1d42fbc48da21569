/// @file
/// CurveBend: how a smooth curve of a mesh bends at a vertex, over a length.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The curve is followed from the vertex to both sides.
class CurveBend {
 public:
  CurveBend(const Mesh<3>& mesh, VertexId vertex, CurveId curve)
      : mesh_(mesh), curve_(curve), start_(vertex) {
    for (const CurveLink& link : mesh.links_of.of(vertex))
      if (link.curve == curve && side_count_ < 2) begin(link.to);
  }

  /// A tensor in which edges of the curve that stay within a tolerance of it have length 1, and
  /// those at right angles to it in the plane in which it bends; 0 across that plane. The curvature
  /// is that of the arc with 1.25 chords to either side, or with as much as there is within
  /// `reach`. Sizes are not smaller than the edges there, at least two to each
  /// side, or twice the tolerance.
  Metric<3> sizes(double tolerance, double reach) {
    constexpr double chords = 1.25;  // as on patches
    constexpr int fewest_steps = 2, most_steps = 100;
    double curvature = 0;
    for (int step = 0; step < most_steps; ++step) {
      curvature = length() > 0 ? turn() / length() : 0;
      const double distance = follows_both() ? length() / 2 : length();
      const bool enough = step >= fewest_steps &&
                          curvature * distance * distance >= 8 * tolerance * chords * chords;
      if (enough || distance > reach || !extend()) break;
    }
    if (!(curvature > 0)) return {};
    const double size =
        std::max({std::sqrt(8 * tolerance / curvature), 2 * tolerance, longest_edge_});
    return in_plane(1 / (size * size));
  }

 private:
  struct Side {
    VertexId before, at;
    Vector<3> direction;  // of the last edge, away from the start; unit length
    double length, last;  // of all edges, and of the last one
  };

  bool follows_both() const { return side_count_ == 2; }
  const Vector<3>& position(VertexId v) const { return mesh_.site_of[v].position; }

  void begin(VertexId to) {
    Side& side = side_of_[side_count_++];
    side = {none, start_, {}, 0, 0};
    go(side, to);
    first_[side_count_ - 1] = side.direction;
    first_length_ = side.last;
  }

  void go(Side& side, VertexId to) {
    const Vector<3> edge = position(to) - position(side.at);
    side.last = norm(edge);
    side.length += side.last;
    longest_edge_ = std::max(longest_edge_, side.last);
    side.direction = (1 / side.last) * edge;
    side.before = side.at;
    side.at = to;
  }

  /// Follows the side that is shorter, or the other one where it ends. Returns whether there was
  /// one more edge.
  bool extend() {
    std::array<std::size_t, 2> order{0, 1};
    if (follows_both() && side_of_[1].length < side_of_[0].length) std::swap(order[0], order[1]);
    for (const std::size_t i : order)
      if (i < side_count_ && extend(side_of_[i])) return true;
    return false;
  }

  bool extend(Side& side) {
    const VertexId other = follows_both() ? side_of_[&side == &side_of_[0] ? 1 : 0].at : start_;
    if (side.at == other) return false;  // all around
    VertexId next = none;
    int count = 0;
    for (const CurveLink& link : mesh_.links_of.of(side.at)) {
      if (link.curve != curve_) continue;
      ++count;
      if (link.to != side.before) next = link.to;
    }
    if (count != 2 || next == none) return false;
    go(side, next);
    return true;
  }

  /// Between the middles of the last edges, where the curve has about their directions.
  double length() const {
    double sum = 0;
    for (std::size_t i = 0; i < side_count_; ++i) sum += side_of_[i].length - side_of_[i].last / 2;
    return follows_both() ? sum : side_of_[0].length - (side_of_[0].last + first_length_) / 2;
  }
  Vector<3> change() const {
    return follows_both() ? side_of_[0].direction + side_of_[1].direction
                          : side_of_[0].direction - first_[0];
  }
  double turn() const { return 2 * std::asin(std::min(1.0, norm(change()) / 2)); }

  Metric<3> in_plane(double value) const {
    Vector<3> along = follows_both() ? first_[0] - first_[1] : first_[0];
    along *= 1 / norm(along);
    Vector<3> across = change() - dot(change(), along) * along;
    across *= 1 / norm(across);
    Metric<3> result;
    std::size_t at = 0;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i <= j; ++i)
        result.m[at++] = value * (along[i] * along[j] + across[i] * across[j]);
    return result;
  }

  const Mesh<3>& mesh_;
  CurveId curve_;
  VertexId start_;
  std::array<Side, 2> side_of_;
  std::array<Vector<3>, 2> first_;  // the directions of the first edges
  std::size_t side_count_ = 0;
  double longest_edge_ = 0;  // of those that were followed
  double first_length_ = 0;  // of the only side, its first edge
};

}  // namespace ductile::meshadapt
