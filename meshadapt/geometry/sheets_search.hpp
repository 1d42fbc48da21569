/// @file
/// The flat parts of Sheets, for sheets.cpp: where they are, which is the closest to a point, and
/// whether they cover a simplex, that is, whether it may be where it is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include <boost/container/small_vector.hpp>

#include "geometry/sheets.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"
#include "mesh/prism.hpp"

namespace ductile::meshadapt {

/// A tree of the flat parts, in the order of their numbers.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Tree : BoxHierarchy<Dim> {
  using BoxHierarchy<Dim>::BoxHierarchy;
};

/// Calls visit(part) for each part whose box has a point in common with this one.
template <int Dim, std::size_t Corners>
void Sheets<Dim, Corners>::each_meeting(const Box<Dim>& box, auto&& visit) const {
  tree_->each_meeting(box, visit);
}

/// Some parts, among which the closest to a point is looked for: first where it is likely, then
/// wherever it may be.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Near : boost::container::small_vector<std::uint32_t, 192> {
  Closest closest(const Sheets& sheets, const Vector<Dim>& point) const {
    Closest best;
    const auto look = [&](std::uint32_t part) {
      const Vector<Dim> at = closest_point(sheets.parts_[part].corner, point);
      const double distance = norm(at - point);
      if (distance < best.distance) best = {distance, at, part};
    };
    if (this->empty()) return best;
    boost::container::small_vector<double, 192> square_of(this->size(),
                                                          boost::container::default_init);
    std::size_t first = 0;
    for (std::size_t i = 0; i < this->size(); ++i) {
      const Vector<Dim> aside = sheets.shape_of_[(*this)[i]].centre - point;
      square_of[i] = dot(aside, aside);
      const auto number = [&](std::size_t k) {
        return std::pair(sheets.origin_of_[(*this)[k]].facet, (*this)[k]);
      };
      if (square_of[i] < square_of[first] ||
          (square_of[i] == square_of[first] && number(i) < number(first)))
        first = i;
    }
    look((*this)[first]);
    for (std::size_t i = 0; i < this->size(); ++i) {
      const double reach = best.distance + sheets.shape_of_[(*this)[i]].radius;
      if (square_of[i] < reach * reach) look((*this)[i]);
    }
    return best;
  }
};

/// A sphere around all corners, not the smallest one.
template <int Dim>
struct Sphere {
  Vector<Dim> centre;
  double radius;
};
template <int Dim, std::size_t N>
Sphere<Dim> sphere_around(const std::array<Vector<Dim>, N>& points) {
  Sphere<Dim> sphere{{}, 0};
  for (const Vector<Dim>& p : points) sphere.centre += (1.0 / N) * p;
  for (const Vector<Dim>& p : points)
    sphere.radius = std::max(sphere.radius, norm(p - sphere.centre));
  return sphere;
}

/// The halves of an edge, the quarters of a triangle.
template <int Dim>
auto divided(const std::array<Vector<Dim>, 2>& p) {
  const Vector<Dim> m = 0.5 * (p[0] + p[1]);
  return std::array{std::array{p[0], m}, std::array{m, p[1]}};
}
inline auto divided(const std::array<Vector<3>, 3>& p) {
  const Vector<3> a = 0.5 * (p[1] + p[2]), b = 0.5 * (p[2] + p[0]), c = 0.5 * (p[0] + p[1]);
  return std::array{std::array{p[0], c, b}, std::array{p[1], a, c}, std::array{p[2], b, a},
                    std::array{a, b, c}};
}

/// The parts around a simplex that matter.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Around {
  Near covering;  // of its sheet, turned little against it
  Near steep;     // of its sheet, turned too much
  Near facing;    // turned the other way; must not be met, unless joined to the sheet here
};

/// One question about a simplex, answered part by part.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Search {
  const Sheets& sheets;
  Vector<Dim> direction;
  double tolerance;
  static constexpr double steepest = 0.3;                    // the cosine of 72 degrees
  static constexpr double least_turn = 0.70710678118654752;  // of 45 degrees

  double turn(std::uint32_t part) const {
    const double cosine = dot(direction, sheets.shape_of_[part].direction);
    return sheets.shape_of_[part].two_sided ? std::abs(cosine) : cosine;
  }

  /// Is there a gap between the sheet and this part, which faces it, or a part of the domain? Not
  /// where they are joined. Looks where they are closest, near a point.
  bool is_across_gap(std::uint32_t part, const Near& covering, const Vector<Dim>& point) const {
    const Points& corner = sheets.parts_[part].corner;
    Vector<Dim> there = closest_point(corner, point);
    Closest here;
    for (int step = 0; step < 3; ++step) {
      here = covering.closest(sheets, there);
      there = closest_point(corner, here.point);
    }
    const Vector<Dim> gap = there - here.point;
    const double width = norm(gap);
    return width > 1e-6 * tolerance &&
           std::abs(dot(gap, sheets.shape_of_[here.part].direction)) > 0.1 * width;
  }

  /// Does the part's facet share a corner with the facet of one of the others? Parts of one facet
  /// follow each other.
  bool has_corner_of(std::uint32_t part, const Near& others) const {
    const auto has = [&](const Points& corners, const Vector<Dim>& point) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vector<Dim>& corner) { return corner.x == point.x; });
    };
    const Points own = sheets.facet_of(part);
    std::uint32_t last = none;
    return std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
      const std::uint32_t before = std::exchange(last, sheets.origin_of_[other].facet);
      if (last == before) return false;
      const Points corners = sheets.facet_of(other);
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vector<Dim>& corner) { return has(own, corner); });
    });
  }

  /// All around the whole simplex, by which it is known what is joined to the sheet here.
  struct Whole {
    const Near& covering;
    const Near& beside;  // of other sheets, turned about as at a right angle
    Vector<Dim> centre;
    mutable std::unordered_map<std::uint32_t, bool> joined;  // [part], as far as it was asked
  };
  bool is_joined(std::uint32_t part, const Whole& whole) const {
    const auto [known, is_new] = whole.joined.try_emplace(part, false);
    if (is_new)
      known->second = has_corner_of(part, whole.covering) ||
                      is_beyond_ridge(part, whole.beside, whole.covering) ||
                      !is_across_gap(part, whole.covering, whole.centre);
    return known->second;
  }

  /// How far a point is from the closest part that faces the sheet and is not joined to it;
  /// infinity beyond a limit. Few are asked whether they are joined, because that takes long.
  double gap_at(const Vector<Dim>& point, double limit, const Near& facing,
                const Whole& whole) const {
    boost::container::small_vector<std::pair<double, std::uint32_t>, 64> by_distance;
    for (const std::uint32_t part : facing) {
      const Shape& shape = sheets.shape_of_[part];
      if (norm(shape.centre - point) - shape.radius > limit) continue;
      const double distance = norm(closest_point(sheets.parts_[part].corner, point) - point);
      if (distance <= limit) by_distance.emplace_back(distance, part);
    }
    std::sort(by_distance.begin(), by_distance.end());
    for (const auto& [distance, part] : by_distance)
      if (!is_joined(part, whole)) return distance;
    return std::numeric_limits<double>::infinity();
  }

  /// Is the part turned against the simplex about as at a right angle, and of a sheet that others
  /// join at a ridge here? A simplex is not turned quite as its sheet is.
  bool is_beyond_ridge(std::uint32_t part, const Near& beside, const Near& others) const {
    return std::abs(turn(part)) < steepest &&
           std::any_of(beside.begin(), beside.end(), [&](std::uint32_t other) {
             return sheets.parts_[other].sheet == sheets.parts_[part].sheet &&
                    has_corner_of(other, others);
           });
  }

  /// Those of some parts that may be within the tolerance of what is inside the box.
  Near inside(const Box<Dim>& box, const Near& parts) const {
    Near near;
    for (const std::uint32_t part : parts)
      if (meet(box, sheets.tree_->box_at(part))) near.push_back(part);
    return near;
  }
  Around inside(const Box<Dim>& box, const Around& around) const {
    return {inside(box, around.covering), inside(box, around.steep), inside(box, around.facing)};
  }

  /// Those of some parts that may be within a distance of the simplex.
  Near close_to(const Points& simplex, double distance, const Near& parts) const {
    Near near = inside(grown(box_around(simplex), distance), parts);
    const auto is_beyond = [&](std::uint32_t part) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vector<Dim>& corner : sheets.parts_[part].corner) {
        const double height = dot(corner - simplex[0], direction);
        low = std::min(low, height);
        high = std::max(high, height);
      }
      return low > distance || high < -distance;
    };
    if constexpr (Corners == Dim)
      near.erase(std::remove_if(near.begin(), near.end(), is_beyond), near.end());
    return near;
  }

  /// How far a point is from where the simplex goes on to.
  double aside(const Points& simplex, const Vector<Dim>& point) const {
    const Vector<Dim> away = point - simplex[0];
    const double along = dot(away, direction);
    if constexpr (Corners == Dim)
      return std::abs(along);
    else
      return norm(away - along * direction);
  }

  /// An upper bound of the distance of the parts from the simplex, at a right angle to it: from
  /// their corners, or from the distance somewhere inside a sphere and how they are turned.
  double farthest(const Points& simplex, const Near& parts, double somewhere, double radius) const {
    double most_aside = 0, least = 1;
    for (const std::uint32_t part : parts) {
      least = std::min(least, turn(part));
      for (const Vector<Dim>& corner : sheets.parts_[part].corner)
        most_aside = std::max(most_aside, aside(simplex, corner));
    }
    const double slope = std::sqrt(std::max(0.0, 1 - least * least)) / least;
    return std::min(most_aside, somewhere / least + radius * slope);
  }

  /// Does it lie upside down, among noise? Then what lies over it is there twice more.
  bool folds_back(std::uint32_t part) const {
    return sheets.counts_as_turned(part) &&
           dot(direction_of(sheets.parts_[part].corner), sheets.parts_[part].turned) < 0;
  }

  /// The sheet as a graph over the simplex: whether each point has one of the parts above or below,
  /// and if so how far away at most, and where. Or whether the parts are too far away anyway.
  struct Graph {
    bool whole;
    double most_aside;
    Vector<Dim> where;
    bool too_far = false;
  };
  Graph graph_over(const Points& simplex, const Near& parts) const {
    constexpr double far = 1.5;  // more than what is turned by 45 degrees may have
    const Prism<Dim, Corners> prism(simplex);
    typename Prism<Dim, Corners>::Clipping clipping;
    Graph graph{false, 0, simplex[0]};
    double share = 0;
    bool looked = false;
    for (const std::uint32_t part : parts) {
      const Shape& shape = sheets.shape_of_[part];
      if (prism.is_beside(shape.centre, shape.radius)) continue;
      const auto& inside = prism.inside(sheets.parts_[part].corner, clipping);
      share += (folds_back(part) ? -1 : 1) * prism.share(inside);
      for (const auto& place : inside) {
        const double here = place.aside();
        if (here > graph.most_aside) graph = {false, here, prism.below(place)};
      }
      if (looked || !(graph.most_aside > far * tolerance)) continue;
      looked = true;
      graph.too_far = parts.closest(sheets, graph.where).distance > tolerance;
      if (graph.too_far) return graph;
    }
    graph.whole = std::abs(share - 1) < 1e-9;
    return graph;
  }

  /// True if a point at this distance from its sheet, and at this gap from a facing sheet, cannot
  /// meet the future facets of the latter: these stay within the tolerance, and closer to it.
  bool keeps_apart(double distance, double gap) const {
    return gap > tolerance || distance <= 0.5 * gap;
  }

  /// Is the simplex below any of the parts, or above?
  bool is_below(const Points& simplex, const Near& parts) const {
    const Prism<Dim, Corners> prism(simplex);
    typename Prism<Dim, Corners>::Clipping clipping;
    return std::any_of(parts.begin(), parts.end(), [&](std::uint32_t part) {
      return prism.share(prism.inside(sheets.parts_[part].corner, clipping)) > 1e-9;
    });
  }

  /// Is the simplex turned so little against the sheet at its ends that two of them are no corner
  /// where they meet, for those who see them without the sheet? In 3D it is not asked.
  bool stays_smooth(const Points& simplex, const Near& covering) const {
    const auto is_little = [&](const Vector<Dim>& end) {
      const Closest there = covering.closest(sheets, end);
      const double cosine = dot(direction, sheets.direction_at(end, there));
      return (sheets.parts_[there.part].two_sided ? std::abs(cosine) : cosine) >=
             sheets.turn_at_ends_;
    };
    return Dim == 3 || std::all_of(simplex.begin(), simplex.end(), is_little);
  }

  /// How close what is across a gap may be for it to matter.
  double reach(const Graph& graph) const {
    return graph.whole ? std::min(tolerance, 2 * graph.most_aside) : tolerance;
  }

  /// True if the whole simplex, over which there is this graph, surely may be where it is. May be
  /// false although it may.
  bool covered(const Points& simplex, const Graph& graph, const Around& around, const Whole& whole,
               int depth = 0) const {
    constexpr int deepest = 3;
    if (graph.too_far) return false;
    const Near facing = close_to(simplex, reach(graph), around.facing);
    const bool is_low = graph.whole && graph.most_aside <= tolerance;
    if (is_low && facing.empty()) return true;
    const Near& covering = around.covering;
    const Sphere<Dim> sphere = sphere_around(simplex);
    const double distance = covering.closest(sheets, sphere.centre).distance;
    if (!(distance <= tolerance) && !is_low) return false;
    // Parts farther from the centre are too far from all of the simplex to matter.
    const double gap = gap_at(sphere.centre, reach(graph) + sphere.radius, facing, whole);
    if (is_low && gap == std::numeric_limits<double>::infinity()) return true;
    if (!(distance <= tolerance) || !keeps_apart(distance, gap)) return false;
    const double least_gap = gap - sphere.radius;
    if (graph.whole) {
      if (is_low && keeps_apart(graph.most_aside, least_gap)) return true;
      if (covering.closest(sheets, graph.where).distance > tolerance) return false;
    }
    // At the end of a sheet that continues at less than 45 degrees, the closest point is not the
    // one at a right angle.
    constexpr double at_ends = 0.92;  // the cosine of half of that
    if (least_gap > tolerance && !is_below(simplex, around.steep) &&
        farthest(simplex, covering, distance, sphere.radius) <= at_ends * tolerance)
      return std::all_of(simplex.begin(), simplex.end(), [&](const Vector<Dim>& corner) {
        return covering.closest(sheets, corner).distance <= tolerance;
      });
    if (depth == deepest) return false;
    const auto parts = divided(simplex);
    return std::all_of(parts.begin(), parts.end(), [&](const Points& part) {
      const Around within = inside(grown(box_around(part), tolerance), around);
      return covered(part, graph_over(part, within.covering), within, whole, depth + 1);
    });
  }
};

}  // namespace ductile::meshadapt
