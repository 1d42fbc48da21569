#include "geometry/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/container/small_vector.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include "ductile/meshadapt/simplex.hpp"
#include "geometry/distance.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
using TreePoint = boost::geometry::model::point<double, Dim, boost::geometry::cs::cartesian>;
template <int Dim>
using TreeBox = boost::geometry::model::box<TreePoint<Dim>>;

template <int Dim>
TreePoint<Dim> tree_point(const Vector<Dim>& v) {
  if constexpr (Dim == 2)
    return {v[0], v[1]};
  else
    return {v[0], v[1], v[2]};
}

template <int Dim>
struct Bounds {
  Vector<Dim> low, high;
  bool meets(const Bounds& other) const {
    for (int i = 0; i < Dim; ++i)
      if (low[i] > other.high[i] || other.low[i] > high[i]) return false;
    return true;
  }
  TreeBox<Dim> box() const { return {tree_point(low), tree_point(high)}; }
};

/// Of some points, with a margin around them.
template <int Dim, std::size_t N>
Bounds<Dim> bounds_of(const std::array<Vector<Dim>, N>& points, double margin) {
  Bounds<Dim> bounds{points[0], points[0]};
  for (int i = 0; i < Dim; ++i) {
    for (const Vector<Dim>& p : points) {
      bounds.low[i] = std::min(bounds.low[i], p[i]);
      bounds.high[i] = std::max(bounds.high[i], p[i]);
    }
    bounds.low[i] -= margin;
    bounds.high[i] += margin;
  }
  return bounds;
}

/// Unit normal of a facet, or along an edge in 3D; 0 if it is too small to have one.
template <int Dim, std::size_t Corners>
Vector<Dim> direction_of(const std::array<Vector<Dim>, Corners>& corner) {
  Vector<Dim> direction;
  if constexpr (Corners == Dim)
    direction = facet_normal(corner);
  else
    direction = corner[1] - corner[0];
  const double length = norm(direction);
  return length > 0 ? (1 / length) * direction : Vector<Dim>{};
}

/// The halves of an edge, the quarters of a triangle.
template <int Dim>
auto divided(const std::array<Vector<Dim>, 2>& p) {
  const Vector<Dim> m = 0.5 * (p[0] + p[1]);
  return std::array{std::array{p[0], m}, std::array{m, p[1]}};
}
auto divided(const std::array<Vector<3>, 3>& p) {
  const Vector<3> a = 0.5 * (p[1] + p[2]), b = 0.5 * (p[2] + p[0]), c = 0.5 * (p[0] + p[1]);
  return std::array{std::array{p[0], c, b}, std::array{p[1], a, c}, std::array{p[2], b, a},
                    std::array{a, b, c}};
}

}  // namespace

template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Tree {
  using Value = std::pair<TreeBox<Dim>, std::uint32_t>;
  using Structure = boost::geometry::index::rtree<Value, boost::geometry::index::quadratic<16>>;

  explicit Tree(const std::vector<Part>& parts) {
    std::vector<Value> values;
    values.reserve(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      values.emplace_back(bounds_of(parts[i].corner, 0).box(), static_cast<std::uint32_t>(i));
    structure = Structure(values);
  }

  void visit(const Bounds<Dim>& bounds, auto&& visit) const {
    structure.query(
        boost::geometry::index::intersects(bounds.box()),
        boost::make_function_output_iterator([&](const Value& value) { visit(value.second); }));
  }

  Structure structure;
};

/// One question about a simplex, answered part by part.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Search {
  using Near = boost::container::small_vector<std::uint32_t, 128>;

  const Sheets& sheets;
  std::uint32_t sheet;
  Vector<Dim> direction;

  /// What is there to know around a part of the simplex.
  struct View {
    Near near;
    double distance = std::numeric_limits<double>::infinity();  ///< from its centre
    double turn = 1;                                            ///< cosine of the greatest
    double gap = std::numeric_limits<double>::infinity();       ///< from there to what faces it
  };

  void look_at(std::uint32_t part, const Vector<Dim>& centre, View& view) const {
    const Part& p = sheets.parts_[part];
    double turn = dot(direction, sheets.direction_of_[part]);
    if (p.two_sided) turn = std::abs(turn);
    const bool covers = p.sheet == sheet && turn >= least_turn;
    const bool faces =
        !p.two_sided && turn < -0.1;  // not what is at a right angle but for rounding
    if (!covers && !faces) return;
    const Vector<Dim> aside = centre - closest_point(p.corner, centre);
    double& distance = covers ? view.distance : view.gap;
    distance = std::min(distance, norm(aside));
    if (covers) view.turn = std::min(view.turn, turn);
  }

  bool covered(const Points& simplex, const Near& around, int depth) const {
    constexpr int deepest = 5;
    const double tolerance = sheets.tolerance_;
    Vector<Dim> centre;
    for (const Vector<Dim>& p : simplex) centre += (1.0 / Corners) * p;
    double radius = 0;
    for (const Vector<Dim>& p : simplex) radius = std::max(radius, norm(p - centre));
    const Bounds<Dim> bounds = bounds_of(simplex, tolerance);
    View view;
    for (const std::uint32_t part : around) {
      if (!bounds.meets(bounds_of(sheets.parts_[part].corner, 0))) continue;
      view.near.push_back(part);
      look_at(part, centre, view);
    }
    if (!(view.distance <= tolerance) || !(view.gap > tolerance)) return false;
    const double slope = std::sqrt(std::max(0.0, 1 - view.turn * view.turn)) / view.turn;
    if (view.distance / view.turn + radius * slope <= tolerance && view.gap > tolerance + radius)
      return true;
    if (depth == deepest) return false;
    const auto parts = divided(simplex);
    return std::all_of(parts.begin(), parts.end(),
                       [&](const Points& part) { return covered(part, view.near, depth + 1); });
  }
};

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::Sheets(std::vector<Part> parts, double tolerance)
    : parts_(std::move(parts)), tolerance_(tolerance), tree_(std::make_unique<Tree>(parts_)) {
  direction_of_.reserve(parts_.size());
  for (const Part& part : parts_) direction_of_.push_back(direction_of(part.corner));
}

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::~Sheets() = default;

template <int Dim, std::size_t Corners>
bool Sheets<Dim, Corners>::cover(const Points& simplex, std::uint32_t sheet) const {
  const Search search{*this, sheet, meshadapt::direction_of(simplex)};
  typename Search::Near near;
  tree_->visit(bounds_of(simplex, tolerance_), [&](std::uint32_t part) { near.push_back(part); });
  return search.covered(simplex, near, 0);
}

template <int Dim, std::size_t Corners>
std::optional<Vector<Dim>> Sheets<Dim, Corners>::closest(const Vector<Dim>& point,
                                                         std::uint32_t sheet, double reach) const {
  reach += tolerance_;
  std::optional<Vector<Dim>> best;
  std::pair least{reach, std::uint32_t{0}};  // of two as close, the first
  tree_->visit(bounds_of(std::array{point}, reach), [&](std::uint32_t part) {
    if (parts_[part].sheet != sheet) return;
    const Vector<Dim> at = closest_point(parts_[part].corner, point);
    const std::pair found{norm(point - at), part};
    if (best ? !(found < least) : !(found.first <= reach)) return;
    least = found;
    best = at;
  });
  return best;
}

template <int Dim, std::size_t Corners>
std::size_t Sheets<Dim, Corners>::bytes() const {
  return parts_.capacity() * sizeof(Part) + direction_of_.capacity() * sizeof(Vector<Dim>) +
         parts_.size() * sizeof(typename Tree::Value);
}

template class Sheets<2, 2>;
template class Sheets<3, 2>;
template class Sheets<3, 3>;

}  // namespace ductile::meshadapt
