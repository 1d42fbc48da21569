/// @file
/// BoxHierarchy: a tree of boxes around many things, to find those near a point, or in a box.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/box.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

template <int Dim>
double squared_distance(const Box<Dim>& box, const Vector<Dim>& point) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i) {
    const double beyond = std::max({box.low[i] - point[i], point[i] - box.high[i], 0.0});
    sum += beyond * beyond;
  }
  return sum;
}

template <int Dim>
class BoxHierarchy {
 public:
  /// Builds the tree over n things with boxes box_of(i). Throws std::bad_alloc. Thread safety: one
  /// caller; runs on the executor.
  BoxHierarchy(const runtime::Executor& executor, std::size_t n, const auto& box_of) {
    const auto all =
        runtime::parallel_reduce(executor, n, Box<Dim>::empty(), box_of,
                                 [](const Box<Dim>& a, const Box<Dim>& b) { return join(a, b); });
    std::vector<Keyed> keyed(n);
    runtime::parallel_for(executor, n, [&](std::size_t i) {
      const Box<Dim> box = box_of(i);
      keyed[i] = {hilbert_key(0.5 * (box.low + box.high), all), static_cast<std::uint32_t>(i)};
    });
    runtime::parallel_sort(executor, std::span(keyed));
    order_.resize(n);
    boxes_of_.emplace_back(n);
    runtime::parallel_for(executor, n, [&](std::size_t i) {
      order_[i] = keyed[i].thing;
      boxes_of_[0][i] = box_of(order_[i]);
    });
    while (boxes_of_.back().size() > 1) add_level(executor);
  }

  /// The same on one thread.
  BoxHierarchy(std::size_t n, const auto& box_of)
      : BoxHierarchy(runtime::Executor({.threads = 1}), n, box_of) {}

  /// The things along a space-filling curve.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls look_at(place) for things whose boxes are closer than `square`, a squared distance that
  /// look_at may lower; place is an index into order(). Closer ones come first. Thread safety: any
  /// thread.
  void visit_near(const Vector<Dim>& point, const double& square, const auto& look_at) const {
    if (!order_.empty()) look_into(boxes_of_.size() - 1, 0, Search{point, square}, look_at);
  }

  /// Calls visit(i) for each thing whose box has a point in common with this one, in an order that
  /// is the same each time. Thread safety: any thread.
  void each_meeting(const Box<Dim>& box, const auto& visit) const {
    if (!order_.empty()) visit_meeting(boxes_of_.size() - 1, 0, box, visit);
  }

  std::size_t bytes() const {
    std::size_t sum = order_.capacity() * sizeof(order_[0]);
    for (const auto& boxes : boxes_of_) sum += boxes.capacity() * sizeof(boxes[0]);
    return sum;
  }

 private:
  static constexpr std::size_t width = 4;

  struct Keyed {
    std::uint64_t key;
    std::uint32_t thing;
    friend auto operator<=>(const Keyed&, const Keyed&) = default;
  };

  struct Search {
    const Vector<Dim>& point;
    const double& square;
  };

  void add_level(const runtime::Executor& executor) {
    const std::vector<Box<Dim>>& below = boxes_of_.back();
    std::vector<Box<Dim>> boxes((below.size() + width - 1) / width, Box<Dim>::empty());
    runtime::parallel_for(executor, boxes.size(), [&](std::size_t i) {
      for (std::size_t k = i * width; k < std::min(below.size(), (i + 1) * width); ++k)
        boxes[i] = join(boxes[i], below[k]);
    });
    boxes_of_.push_back(std::move(boxes));
  }

  /// Visits the closer boxes first and skips those that are too far.
  void look_into(std::size_t level, std::size_t index, const Search& search,
                 const auto& look_at) const {
    if (level == 0) return look_at(index);
    std::array<std::pair<double, std::size_t>, width> below;
    std::size_t count = 0;
    const auto& boxes = boxes_of_[level - 1];
    for (std::size_t k = index * width; k < std::min(boxes.size(), (index + 1) * width); ++k)
      below[count++] = {squared_distance(boxes[k], search.point), k};
    std::sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count && below[i].first < search.square; ++i)
      look_into(level - 1, below[i].second, search, look_at);
  }

  void visit_meeting(std::size_t level, std::size_t index, const Box<Dim>& box,
                     const auto& visit) const {
    if (!meet(boxes_of_[level][index], box)) return;
    if (level == 0) return visit(order_[index]);
    const std::size_t end = std::min(boxes_of_[level - 1].size(), (index + 1) * width);
    for (std::size_t k = index * width; k < end; ++k) visit_meeting(level - 1, k, box, visit);
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box<Dim>>> boxes_of_;  // [level][index]: box around `width` boxes of the
                                                 // level below
};

}  // namespace ductile::meshadapt
