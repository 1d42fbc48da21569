/// @file
/// BoxHierarchy: a tree of boxes around many things, to find those near a point, or in a box.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
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

/// The numbers of n things with boxes box_of(i), along a space-filling curve. Thread safety: one
/// caller; runs on the executor.
std::vector<std::uint32_t> hilbert_order(const runtime::Executor& executor, std::size_t n,
                                         const auto& box_of) {
  using ABox = std::decay_t<decltype(box_of(std::size_t{}))>;
  struct Keyed {
    std::uint64_t key;
    std::uint32_t thing;
    auto operator<=>(const Keyed&) const = default;
  };
  const auto all = runtime::parallel_reduce(
      executor, n, ABox::empty(), box_of, [](const ABox& a, const ABox& b) { return join(a, b); });
  std::vector<Keyed> keyed(n);
  runtime::parallel_for(executor, n, [&](std::size_t i) {
    const ABox box = box_of(i);
    keyed[i] = {hilbert_key(0.5 * (box.low + box.high), all), static_cast<std::uint32_t>(i)};
  });
  runtime::parallel_sort(executor, std::span(keyed));
  std::vector<std::uint32_t> order(n);
  runtime::parallel_for(executor, n, [&](std::size_t i) { order[i] = keyed[i].thing; });
  return order;
}

template <int Dim>
class BoxHierarchy {
 public:
  /// Builds the tree over n things with boxes box_of(i). Throws std::bad_alloc. Thread safety: one
  /// caller; runs on the executor.
  BoxHierarchy(const runtime::Executor& executor, std::size_t n, const auto& box_of)
      : BoxHierarchy(executor, hilbert_order(executor, n, box_of), box_of) {}

  /// The same over things in this order, of which neighbours are close to each other.
  BoxHierarchy(const runtime::Executor& executor, std::vector<std::uint32_t> order,
               const auto& box_of)
      : order_(std::move(order)) {
    boxes_of_.emplace_back(order_.size());
    runtime::parallel_for(executor, order_.size(),
                          [&](std::size_t i) { boxes_of_[0][i] = box_of(order_[i]); });
    while (boxes_of_.back().size() > 1) add_level(executor);
  }

  /// The same on one thread.
  BoxHierarchy(std::size_t n, const auto& box_of)
      : BoxHierarchy(runtime::Executor({.threads = 1}), n, box_of) {}

  /// The things along a space-filling curve.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// The box around the thing at a place in order().
  const Box<Dim>& box_at(std::size_t place) const { return boxes_of_[0][place]; }

  /// Calls look_at(place) for things whose boxes are closer than `square`, a squared distance that
  /// look_at may lower; place is an index into order(). Closer ones come first. Thread safety: any
  /// thread.
  void visit_near(const Vector<Dim>& point, const double& square, const auto& look_at) const {
    if (!order_.empty()) look_into(boxes_of_.size() - 1, 0, Search{point, square}, look_at);
  }

  /// Calls visit(i) for each thing whose box has a point in common with this one, in an order that
  /// is the same each time. Thread safety: any thread.
  void each_meeting(const Box<Dim>& box, const auto& visit) const {
    if (!order_.empty() && meet(boxes_of_.back()[0], box))
      visit_below(boxes_of_.size() - 1, 0, box, visit);
  }

  std::size_t bytes() const {
    std::size_t sum = order_.capacity() * sizeof(order_[0]);
    for (const auto& boxes : boxes_of_) sum += boxes.capacity() * sizeof(boxes[0]);
    return sum;
  }

 private:
  static constexpr std::size_t width = 4;

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

  /// Visits what is in a box that meets the one in question. All boxes below are compared before
  /// any is entered, because branches on single comparisons would be unpredictable.
  void visit_below(std::size_t level, std::size_t index, const Box<Dim>& box,
                   const auto& visit) const {
    if (level == 0) return visit(order_[index]);
    const auto& boxes = boxes_of_[level - 1];
    const std::size_t begin = index * width, count = std::min(boxes.size() - begin, width);
    unsigned meeting = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Box<Dim>& other = boxes[begin + k];
      bool meets = true;
      for (int i = 0; i < Dim; ++i)
        meets = meets & (other.low[i] <= box.high[i]) & (box.low[i] <= other.high[i]);
      meeting |= static_cast<unsigned>(meets) << k;
    }
    for (; meeting != 0; meeting &= meeting - 1)
      visit_below(level - 1, begin + static_cast<std::size_t>(std::countr_zero(meeting)), box,
                  visit);
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box<Dim>>> boxes_of_;  // [level][index]: box around `width` boxes of the
                                                 // level below
};

}  // namespace ductile::meshadapt
