#include "metric/distance_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "geometry/distance.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

namespace {

constexpr std::size_t width = 4;

struct Keyed {
  std::uint64_t key;
  std::size_t piece;
  friend auto operator<=>(const Keyed&, const Keyed&) = default;
};

double squared_distance(const Box<3>& box, const Vector<3>& point) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::max({box.low[i] - point[i], point[i] - box.high[i], 0.0});
    sum += beyond * beyond;
  }
  return sum;
}

double squared_distance(const Piece& piece, const Vector<3>& point) {
  Vector<3> closest = piece.corner[0];
  if (piece.corners == 2)
    closest = closest_point(std::array{piece.corner[0], piece.corner[1]}, point);
  if (piece.corners == 3) closest = closest_point(piece.corner, point);
  return dot(point - closest, point - closest);
}

}  // namespace

DistanceTree::DistanceTree(const runtime::Executor& executor, std::vector<Piece> pieces) {
  const auto all = runtime::parallel_reduce(
      executor, pieces.size(), Box<3>::empty(),
      [&](std::size_t i) { return box_around(pieces[i].corner); },
      [](const Box<3>& a, const Box<3>& b) { return join(a, b); });
  std::vector<Keyed> keyed(pieces.size());
  runtime::parallel_for(executor, keyed.size(), [&](std::size_t i) {
    const Box<3> box = box_around(pieces[i].corner);
    keyed[i] = {hilbert_key(0.5 * (box.low + box.high), all), i};
  });
  runtime::parallel_sort(executor, std::span(keyed));
  pieces_.resize(pieces.size());
  boxes_of_.emplace_back(pieces.size());
  runtime::parallel_for(executor, keyed.size(), [&](std::size_t i) {
    pieces_[i] = pieces[keyed[i].piece];
    boxes_of_[0][i] = box_around(pieces_[i].corner);
  });
  while (boxes_of_.back().size() > 1) {
    const std::vector<Box<3>>& below = boxes_of_.back();
    std::vector<Box<3>> boxes((below.size() + width - 1) / width, Box<3>::empty());
    runtime::parallel_for(executor, boxes.size(), [&](std::size_t i) {
      for (std::size_t k = i * width; k < std::min(below.size(), (i + 1) * width); ++k)
        boxes[i] = join(boxes[i], below[k]);
    });
    boxes_of_.push_back(std::move(boxes));
  }
}

/// Looks into the nearer boxes first, and not into those that are too far away.
void DistanceTree::look_into(std::size_t level, std::size_t index, const Vector<3>& point,
                             double& square) const {
  if (level == 0) {
    square = std::min(square, squared_distance(pieces_[index], point));
    return;
  }
  std::array<std::pair<double, std::size_t>, width> below;
  std::size_t count = 0;
  const auto& boxes = boxes_of_[level - 1];
  for (std::size_t k = index * width; k < std::min(boxes.size(), (index + 1) * width); ++k)
    below[count++] = {squared_distance(boxes[k], point), k};
  std::sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count && below[i].first < square; ++i)
    look_into(level - 1, below[i].second, point, square);
}

double DistanceTree::distance(const Vector<3>& point, double most) const {
  if (pieces_.empty()) return most;
  double square = most * most;
  look_into(boxes_of_.size() - 1, 0, point, square);
  return std::min(most, std::sqrt(square));
}

}  // namespace ductile::meshadapt
