#include "metric/distance_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesh/distance.hpp"

namespace ductile::meshadapt {

namespace {

double squared_distance(const Piece& piece, const Vector<3>& point) {
  Vector<3> closest = piece.corner[0];
  if (piece.corners == 2)
    closest = closest_point(std::array{piece.corner[0], piece.corner[1]}, point);
  if (piece.corners == 3) closest = closest_point(piece.corner, point);
  return dot(point - closest, point - closest);
}

}  // namespace

DistanceTree::DistanceTree(const runtime::Executor& executor, const std::vector<Piece>& pieces)
    : boxes_(executor, pieces.size(), [&](std::size_t i) { return box_around(pieces[i].corner); }) {
  pieces_.reserve(pieces.size());
  for (const std::uint32_t i : boxes_.order()) pieces_.push_back(pieces[i]);
}

double DistanceTree::distance(const Vector<3>& point, double most) const {
  double square = most * most;
  boxes_.visit_near(point, square, [&](std::size_t place) {
    square = std::min(square, squared_distance(pieces_[place], point));
  });
  return std::min(most, std::sqrt(square));
}

}  // namespace ductile::meshadapt
