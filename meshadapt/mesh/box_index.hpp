/// @file
/// BoxIndex: finds intersecting boxes by an R-tree. Expensive to compile: include in sources only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include "mesh/box.hpp"

namespace ductile::meshadapt {

template <int Dim>
class BoxIndex {
 public:
  /// Builds the index of n boxes box_of(i). Throws std::bad_alloc.
  template <class BoxOf>
  BoxIndex(std::size_t n, BoxOf&& box_of) {
    std::vector<Value> values;
    values.reserve(n);
    for (std::size_t i = 0; i < n; ++i)
      values.emplace_back(tree_box(box_of(i)), static_cast<std::uint32_t>(i));
    tree_ = Tree(values);
  }

  /// Calls visit(i) for each box that intersects this one, in arbitrary but reproducible order.
  /// Thread safety: any thread.
  template <class Visit>
  void each_meeting(const Box<Dim>& box, Visit&& visit) const {
    tree_.query(
        boost::geometry::index::intersects(tree_box(box)),
        boost::make_function_output_iterator([&](const Value& value) { visit(value.second); }));
  }

 private:
  using Point = boost::geometry::model::point<double, Dim, boost::geometry::cs::cartesian>;
  using TreeBox = boost::geometry::model::box<Point>;
  using Value = std::pair<TreeBox, std::uint32_t>;
  using Tree = boost::geometry::index::rtree<Value, boost::geometry::index::quadratic<16>>;

  static Point tree_point(const Vector<Dim>& v) {
    if constexpr (Dim == 2)
      return {v[0], v[1]};
    else
      return {v[0], v[1], v[2]};
  }
  static TreeBox tree_box(const Box<Dim>& box) {
    return {tree_point(box.low), tree_point(box.high)};
  }

  Tree tree_;
};

}  // namespace ductile::meshadapt
