/// @file
/// BoxHierarchy: a tree of boxes around many things, to find those near a point, or in a box.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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
    if (!order_.empty()) add_nodes(executor);
  }

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
    if (order_.empty()) return;
    Question question{box, {}, {}};
    for (int i = 0; i < Dim; ++i) {
      question.low[i] = Four{} + scaled(box.low[i], i);
      question.high[i] = Four{} + scaled(box.high[i], i);
    }
    visit_below(nodes_of_.size() - 1, 0, question, visit);
  }

  std::size_t bytes() const {
    std::size_t sum = order_.capacity() * sizeof(order_[0]);
    for (const auto& boxes : boxes_of_) sum += boxes.capacity() * sizeof(boxes[0]);
    for (const auto& nodes : nodes_of_) sum += nodes.capacity() * sizeof(nodes[0]);
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

  // ---- Boxes that meet one: eight are compared at once, in numbers of 32 bits ----

  using Four [[gnu::vector_size(16)]] = float;
  using Bits [[gnu::vector_size(16)]] = std::int32_t;
  static constexpr std::size_t node_width = 8;

  /// Eight boxes. Scaling and rounding keep the order of numbers, so that boxes that meet still do.
  struct Node {
    std::array<std::array<Four, 2>, Dim> low, high;
  };
  struct Question {
    const Box<Dim>& box;
    std::array<Four, Dim> low, high;
  };

  float scaled(double x, int axis) const {
    return static_cast<float>((x - origin_[axis]) * scale_);
  }

  /// A bit for each box of a node that seems to meet the one in question.
  static unsigned meeting(const Node& node, const Question& question) {
    Bits all[2] = {~Bits{}, ~Bits{}};
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t half = 0; half < 2; ++half)
        all[half] &=
            (node.low[i][half] <= question.high[i]) & (question.low[i] <= node.high[i][half]);
    const Bits bits = (all[0] & Bits{1, 2, 4, 8}) | (all[1] & Bits{16, 32, 64, 128});
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(bits);
    const std::uint64_t joined = halves[0] | halves[1];
    return static_cast<unsigned>(joined | joined >> 32U) & 255U;
  }

  void visit_below(std::size_t level, std::size_t index, const Question& question,
                   const auto& visit) const {
    for (unsigned bits = meeting(nodes_of_[level][index], question); bits != 0; bits &= bits - 1) {
      const std::size_t below = index * node_width + static_cast<unsigned>(std::countr_zero(bits));
      if (level > 0)
        visit_below(level - 1, below, question, visit);
      else if (meet(boxes_of_[0][below], question.box))
        visit(order_[below]);
    }
  }

  void add_nodes(const runtime::Executor& executor) {
    const Box<Dim>& all = boxes_of_.back()[0];
    double extent = 0;
    for (int i = 0; i < Dim; ++i) {
      if (std::isfinite(all.low[i])) origin_[i] = all.low[i];
      extent = std::max(extent, all.high[i] - all.low[i]);
    }
    if (1 / extent > 0 && std::isfinite(1 / extent)) scale_ = 1 / extent;
    std::vector<Box<Dim>> boxes = boxes_of_[0];
    do {
      std::vector<Node> nodes((boxes.size() + node_width - 1) / node_width);
      std::vector<Box<Dim>> around(nodes.size(), Box<Dim>::empty());
      runtime::parallel_for(executor, nodes.size(), [&](std::size_t n) {
        for (std::size_t k = 0; k < node_width; ++k) {
          const std::size_t at = n * node_width + k;
          const Box<Dim> box = at < boxes.size() ? boxes[at] : Box<Dim>::empty();
          around[n] = join(around[n], box);
          for (int i = 0; i < Dim; ++i) {
            nodes[n].low[i][k / 4][k % 4] = scaled(box.low[i], i);
            nodes[n].high[i][k / 4][k % 4] = scaled(box.high[i], i);
          }
        }
      });
      nodes_of_.push_back(std::move(nodes));
      boxes = std::move(around);
    } while (boxes.size() > 1);
  }

  std::vector<std::uint32_t> order_;
  std::vector<std::vector<Box<Dim>>> boxes_of_;  // [level][index]: box around `width` boxes of the
                                                 // level below
  std::vector<std::vector<Node>> nodes_of_;      // [level][index]: of boxes, or of nodes below
  Vector<Dim> origin_;
  double scale_ = 1;
};

}  // namespace ductile::meshadapt
