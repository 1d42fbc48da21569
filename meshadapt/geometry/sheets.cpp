#include "geometry/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/sheets_parts.hpp"
#include "mesh/prism.hpp"

namespace ductile::meshadapt {

namespace {

/// Of the angle of a ridge: so much may an edge be turned against the model where it ends. Half
/// would do if the next call's model were the same, of which an edge that stays may be turned more.
constexpr double share_of_ridge = 0.46;

/// Around all corners, not the least one.
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
auto divided(const std::array<Vector<3>, 3>& p) {
  const Vector<3> a = 0.5 * (p[1] + p[2]), b = 0.5 * (p[2] + p[0]), c = 0.5 * (p[0] + p[1]);
  return std::array{std::array{p[0], c, b}, std::array{p[1], a, c}, std::array{p[2], b, a},
                    std::array{a, b, c}};
}

/// The least of a triangle, the length of an edge.
template <int Dim>
double height_of(const std::array<Vector<Dim>, 2>& p) {
  return norm(p[1] - p[0]);
}
double height_of(const std::array<Vector<3>, 3>& p) {
  const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
  return longest > 0 ? norm(facet_normal(p)) / longest : 0;
}

}  // namespace

/// The parts around a simplex that matter.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Around {
  Near covering;  // of its sheet, turned little against it
  Near steep;     // of its sheet, turned too much
  Near facing;    // what it must not meet, across a gap or a thin part of the domain
};

/// One question about a simplex, answered part by part.
template <int Dim, std::size_t Corners>
struct Sheets<Dim, Corners>::Search {
  const Sheets& sheets;
  Vector<Dim> direction;
  double tolerance;
  static constexpr double steepest = 0.3;  // the cosine of 72 degrees

  double turn(std::uint32_t part) const {
    const double cosine = dot(direction, sheets.shape_of_[part].direction);
    return sheets.parts_[part].two_sided ? std::abs(cosine) : cosine;
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

  /// Does the facet that the part is of share a corner with that of one of the others?
  bool has_corner_of(std::uint32_t part, const Near& others) const {
    const auto has = [&](const Points& corners, const Vector<Dim>& point) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vector<Dim>& corner) { return corner.x == point.x; });
    };
    const Points own = sheets.facet_of(part);
    return std::any_of(others.begin(), others.end(), [&](std::uint32_t other) {
      const Points corners = sheets.facet_of(other);
      return std::any_of(corners.begin(), corners.end(),
                         [&](const Vector<Dim>& corner) { return has(own, corner); });
    });
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

  /// Of these parts, those that may be within the tolerance of what is inside the box.
  Near inside(const Box<Dim>& box, const Near& parts) const {
    Near near;
    for (const std::uint32_t part : parts)
      if (meet(box, sheets.box_of_[part])) near.push_back(part);
    return near;
  }
  Around inside(const Box<Dim>& box, const Around& around) const {
    return {inside(box, around.covering), inside(box, around.steep), inside(box, around.facing)};
  }

  /// Of these parts, those that may be within a distance of the simplex.
  Near close_to(const Points& simplex, double distance, const Near& parts) const {
    Near near = inside(box_around(simplex, distance), parts);
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

  /// Bounds of how far the parts are from the simplex, measured at a right angle to it: their
  /// corners, or, from what it is somewhere inside a sphere, as they are turned against it.
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

  /// Whether each point of the simplex has one of the parts above or below; if so how far away at
  /// most, and where that is so. Or whether the parts are too far from there anyway.
  struct Graph {
    bool whole;
    double most_aside;
    Vector<Dim> where;
    bool too_far = false;
  };
  Graph graph_over(const Points& simplex, const Near& parts) const {
    constexpr double far = 1.5;  // more than what is turned by 45 degrees may have
    const Prism<Dim, Corners> prism(simplex);
    Graph graph{false, 0, simplex[0]};
    double share = 0;
    bool looked = false;
    for (const std::uint32_t part : parts) {
      const Shape& shape = sheets.shape_of_[part];
      if (prism.is_beside(shape.centre, shape.radius)) continue;
      const auto inside = prism.inside(sheets.parts_[part].corner);
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

  /// Whether what is this far from its sheet, and from what faces it across a gap, cannot meet what
  /// becomes of that: this would have to be within the tolerance of it, and closer to it than here.
  bool keeps_apart(double distance, double gap) const {
    return gap > tolerance || distance <= 0.5 * gap;
  }

  /// Is the simplex below any of the parts, or above?
  bool is_below(const Points& simplex, const Near& parts) const {
    const Prism<Dim, Corners> prism(simplex);
    return std::any_of(parts.begin(), parts.end(), [&](std::uint32_t part) {
      return prism.share(prism.inside(sheets.parts_[part].corner)) > 1e-9;
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

  /// Whether all of the simplex, over which there is this graph, may be where it is: certainly if
  /// so, but not always if not.
  bool covered(const Points& simplex, const Graph& graph, const Around& around, int depth) const {
    constexpr int deepest = 3;
    if (graph.too_far) return false;
    const Near facing = close_to(simplex, reach(graph), around.facing);
    if (graph.whole && graph.most_aside <= tolerance && facing.empty()) return true;
    const Near& covering = around.covering;
    const Sphere<Dim> sphere = sphere_around(simplex);
    const double distance = covering.closest(sheets, sphere.centre).distance;
    const double gap = facing.closest(sheets, sphere.centre).distance;
    if (!(distance <= tolerance) || !keeps_apart(distance, gap)) return false;
    const double least_gap = gap - sphere.radius;
    if (graph.whole) {
      if (graph.most_aside <= tolerance && keeps_apart(graph.most_aside, least_gap)) return true;
      if (covering.closest(sheets, graph.where).distance > tolerance) return false;
    }
    // Where a sheet ends, at less than 45 degrees to what is next, the closest point is not the one
    // at a right angle.
    constexpr double at_ends = 0.92;  // the cosine of half of that
    if (least_gap > tolerance && !is_below(simplex, around.steep) &&
        farthest(simplex, covering, distance, sphere.radius) <= at_ends * tolerance)
      return std::all_of(simplex.begin(), simplex.end(), [&](const Vector<Dim>& corner) {
        return covering.closest(sheets, corner).distance <= tolerance;
      });
    if (depth == deepest) return false;
    const auto parts = divided(simplex);
    return std::all_of(parts.begin(), parts.end(), [&](const Points& part) {
      const Around within = inside(box_around(part, tolerance), around);
      return covered(part, graph_over(part, within.covering), within, depth + 1);
    });
  }
};

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::Sheets(const std::vector<Part>& parts, double tolerance,
                             const std::vector<std::optional<Curved>>& curved,
                             std::vector<Projection<Dim>> projection_of, double ridge_turn)
    : tolerance_(tolerance),
      turn_at_ends_(std::cos(share_of_ridge * std::acos(ridge_turn))),
      projection_of_(std::move(projection_of)) {
  divide(parts, curved);
  shape_of_.reserve(parts_.size());
  box_of_.reserve(parts_.size());
  for (const Part& part : parts_) {
    const auto [centre, radius] = sphere_around(part.corner);
    box_of_.push_back(box_around(part.corner));
    const bool is_noise = dot(part.turned, part.turned) > 0;
    shape_of_.push_back(
        {centre, is_noise ? part.turned : direction_of(part.corner), radius * (1 + 1e-9)});
  }
  tree_ = std::make_unique<Tree>(first_part_.size() - 1, [&](std::size_t facet) {
    auto box = Box<Dim>::empty();
    for (std::uint32_t part = first_part_[facet]; part < first_part_[facet + 1]; ++part)
      box = join(box, box_of_[part]);
    return box;
  });
}

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::~Sheets() = default;

/// Makes flat parts that are within a share of the tolerance.
template <int Dim, std::size_t Corners>
void Sheets<Dim, Corners>::divide(const std::vector<Part>& parts,
                                  const std::vector<std::optional<Curved>>& curved) {
  constexpr double share = 1.0 / 8;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    first_part_.push_back(static_cast<std::uint32_t>(parts_.size()));
    if (curved.empty() || !curved[p]) {
      parts_.push_back(parts[p]);
      origin_of_.push_back({none, {}});
      continue;
    }
    const auto number = static_cast<std::uint32_t>(curved_.size());
    curved_.push_back(*curved[p]);
    Divider<Dim, Corners>(*curved[p], share * tolerance_).each([&](const auto& part) {
      parts_.push_back({part.corner, parts[p].sheet, parts[p].two_sided, parts[p].turned});
      origin_of_.push_back({number, part.weight});
    });
  }
  first_part_.push_back(static_cast<std::uint32_t>(parts_.size()));
}

/// The corners of what a flat part is of.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::facet_of(std::uint32_t part) const -> Points {
  if (origin_of_[part].curved == none) return parts_[part].corner;
  Points corners;
  for (std::size_t i = 0; i < Corners; ++i) corners[i] = curved_[origin_of_[part].curved].corner(i);
  return corners;
}

template <int Dim, std::size_t Corners>
bool Sheets<Dim, Corners>::cover(const Points& simplex, std::uint32_t sheet) const {
  // What is farther away than that is turned by more somewhere.
  const double reach = std::min(tolerance_, 0.5 * sphere_around(simplex).radius);
  if (cover(simplex, sheet, {*this, direction_of(simplex), reach})) return true;
  const auto direction = direction_around(simplex, sheet);
  return direction && cover(simplex, sheet, {*this, *direction, tolerance_});
}

/// How the sheet is turned closest to a simplex that is low, if there is noise around.
template <int Dim, std::size_t Corners>
std::optional<Vector<Dim>> Sheets<Dim, Corners>::direction_around(const Points& simplex,
                                                                  std::uint32_t sheet) const {
  if (!(height_of(simplex) < tolerance_)) return {};
  Near near;
  bool is_noisy = false;
  each_meeting(box_around(simplex, tolerance_), [&](std::uint32_t part) {
    if (parts_[part].sheet != sheet || parts_[part].two_sided) return;
    near.push_back(part);
    is_noisy = is_noisy || counts_as_turned(part);
  });
  if (!is_noisy) return {};
  return shape_of_[near.closest(*this, sphere_around(simplex).centre).part].direction;
}

template <int Dim, std::size_t Corners>
bool Sheets<Dim, Corners>::cover(const Points& simplex, std::uint32_t sheet,
                                 const Search& search) const {
  const Sphere<Dim> sphere = sphere_around(simplex);
  constexpr double least_turn = 0.70710678118654752;  // the cosine of 45 degrees
  Around around;
  Near beside;  // of other sheets, turned about as at a right angle
  each_meeting(box_around(simplex, search.tolerance), [&](std::uint32_t part) {
    const double turn = search.turn(part);
    if (parts_[part].sheet != sheet && std::abs(turn) < Search::steepest) beside.push_back(part);
    if (parts_[part].sheet == sheet && turn > 0)
      (turn >= least_turn ? around.covering : around.steep).push_back(part);
    if (turn < -0.01) around.facing.push_back(part);  // not what is at a right angle, nearly
  });
  if (around.covering.empty()) return false;
  const auto graph = search.graph_over(simplex, around.covering);
  if (graph.too_far) return false;
  // What is inside has elements on both sides, which keep it apart.
  if (parts_[around.covering.front()].two_sided) around.facing.clear();
  Near& facing = around.facing = search.close_to(simplex, search.reach(graph), around.facing);
  const auto is_joined = [&](std::uint32_t part) {
    return search.has_corner_of(part, around.covering) ||
           search.is_beyond_ridge(part, beside, around.covering) ||
           !search.is_across_gap(part, around.covering, sphere.centre);
  };
  facing.erase(std::remove_if(facing.begin(), facing.end(), is_joined), facing.end());
  return search.stays_smooth(simplex, around.covering) && search.covered(simplex, graph, around, 0);
}

template class Sheets<2, 2>;
template class Sheets<3, 2>;
template class Sheets<3, 3>;

}  // namespace ductile::meshadapt
