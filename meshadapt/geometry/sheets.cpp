#include "geometry/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/sheets_search.hpp"

namespace ductile::meshadapt {

namespace {

/// Largest angle between an edge's end and the model, as a share of the ridge angle. Half would do
/// if the next call had the same model; edges that stay may be turned by more against that one.
constexpr double share_of_ridge = 0.46;

/// The least height of a triangle, the length of an edge.
template <int Dim>
double height_of(const std::array<Vector<Dim>, 2>& p) {
  return norm(p[1] - p[0]);
}
double height_of(const std::array<Vector<3>, 3>& p) {
  const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
  return longest > 0 ? norm(facet_normal(p)) / longest : 0;
}

/// Unit normal of what tangents span; of one in 3D, along it.
template <int Dim, std::size_t Corners>
Vector<Dim> direction_along(const std::array<Vector<Dim>, Corners - 1>& tangents) {
  std::array<Vector<Dim>, Corners> corner{};
  for (std::size_t i = 1; i < Corners; ++i) corner[i] = tangents[i - 1];
  return direction_of(corner);
}

/// The weights of the corners in a point of the simplex.
template <int Dim>
std::array<double, 2> weights_of(const std::array<Vector<Dim>, 2>& p, const Vector<Dim>& point) {
  const Vector<Dim> along = p[1] - p[0];
  const double length2 = dot(along, along);
  const double t = length2 > 0 ? std::clamp(dot(point - p[0], along) / length2, 0.0, 1.0) : 0;
  return {1 - t, t};
}
std::array<double, 3> weights_of(const std::array<Vector<3>, 3>& p, const Vector<3>& point) {
  const Vector<3> normal = facet_normal(p);
  const double area2 = dot(normal, normal);
  if (!(area2 > 0)) return {1, 0, 0};
  std::array<double, 3> weight{};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<3> part = facet_normal({point, p[(i + 1) % 3], p[(i + 2) % 3]});
    sum += weight[i] = std::max(0.0, dot(part, normal) / area2);
  }
  for (double& w : weight) w /= sum;
  return weight;
}

}  // namespace

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::Sheets(const runtime::Executor& executor, Shapes shapes)
    : tolerance_(shapes.tolerance),
      turn_at_ends_(std::cos(share_of_ridge * std::acos(shapes.ridge_turn))),
      projection_of_(std::move(shapes.projection_of)) {
  divide(executor, shapes);
  shape_of_.resize(parts_.size());
  runtime::parallel_for(executor, parts_.size(), [&](std::size_t p) {
    const Part& part = parts_[p];
    const auto [centre, radius] = sphere_around(part.corner);
    const bool is_noise = dot(part.turned, part.turned) > 0;
    shape_of_[p] = {centre, is_noise ? part.turned : direction_of(part.corner), radius * (1 + 1e-9),
                    part.sheet, part.two_sided};
  });
  std::vector<std::uint32_t> order(parts_.size());
  std::iota(order.begin(), order.end(), 0U);
  tree_ = std::make_unique<Tree>(executor, std::move(order),
                                 [&](std::size_t p) { return box_around(parts_[p].corner); });
}

template <int Dim, std::size_t Corners>
Sheets<Dim, Corners>::~Sheets() = default;

/// Makes flat parts that are within a share of the tolerance, along a space-filling curve through
/// the facets.
template <int Dim, std::size_t Corners>
void Sheets<Dim, Corners>::divide(const runtime::Executor& executor, const Shapes& shapes) {
  constexpr double share = 1.0 / 8;
  const auto& facets = shapes.facets;
  const auto& curved = shapes.curved;
  const auto is_curved = [&](std::size_t f) { return !curved.empty() && curved[f]; };
  const auto divider = [&](std::size_t f) {
    return Divider<Dim, Corners>(*curved[f], share * tolerance_);
  };
  const auto box_of = [&](std::size_t f) {
    auto box = box_around(facets[f].corner);
    if (is_curved(f))
      divider(f).each([&](const auto& part) { box = join(box, box_around(part.corner)); });
    return box;
  };
  const std::vector<std::uint32_t> order = hilbert_order(executor, facets.size(), box_of);
  std::vector<std::size_t> first(facets.size() + 1);  // [place in the order], its first part
  runtime::parallel_for(executor, facets.size(), [&](std::size_t i) {
    first[i] = is_curved(order[i]) ? divider(order[i]).count() : 1;
  });
  runtime::exclusive_scan(executor, std::span(first));
  curved_.resize(curved.size());
  parts_.resize(first.back());
  origin_of_.resize(first.back());
  runtime::parallel_for(executor, facets.size(), [&](std::size_t i) {
    const std::uint32_t f = order[i];
    std::size_t p = first[i];
    parts_[p] = facets[f];
    origin_of_[p] = {f, is_curved(f), {}};
    if (!is_curved(f)) return;
    curved_[f] = *curved[f];
    divider(f).each([&](const auto& part) {
      parts_[p] = facets[f];
      parts_[p].corner = part.corner;
      origin_of_[p++] = {f, true, part.weight};
    });
  });
}

/// The corners of the facet that a flat part comes from.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::facet_of(std::uint32_t part) const -> Points {
  if (!origin_of_[part].is_curved) return parts_[part].corner;
  Points corners;
  for (std::size_t i = 0; i < Corners; ++i) corners[i] = curved_[origin_of_[part].facet].corner(i);
  return corners;
}

template <int Dim, std::size_t Corners>
bool Sheets<Dim, Corners>::cover(const Points& simplex, std::uint32_t sheet) const {
  // Parts farther away than that are turned by more somewhere.
  const double reach = std::min(tolerance_, 0.5 * sphere_around(simplex).radius);
  const Search search{*this, direction_of(simplex), reach};
  if (cover_closely(simplex, sheet, search) || cover(simplex, sheet, search)) return true;
  const auto direction = direction_around(simplex, sheet);
  return direction && cover(simplex, sheet, {*this, *direction, tolerance_});
}

/// Is the sheet a graph over the simplex, so close to it that nothing else is near enough to
/// matter? Mostly it is, and that takes few parts to tell.
template <int Dim, std::size_t Corners>
bool Sheets<Dim, Corners>::cover_closely(const Points& simplex, std::uint32_t sheet,
                                         const Search& search) const {
  if constexpr (Dim < 3 || Corners < 3) return false;
  constexpr double share = 0.4;  // flat parts alone may be off by 1/8
  const double margin = share * search.tolerance;
  Near covering;
  bool is_alone = true;
  each_meeting(grown(box_around(simplex), margin), [&](std::uint32_t part) {
    const double turn = search.turn(part);
    const bool covers = turn >= Search::least_turn && shape_of_[part].sheet == sheet;
    if (covers) covering.push_back(part);
    is_alone = is_alone && (covers || (turn > -0.01 && shape_of_[part].sheet != sheet));
  });
  if (!is_alone || covering.empty()) return false;
  const auto graph = search.graph_over(simplex, covering);
  return graph.whole && 2 * graph.most_aside <= margin;
}

/// How the sheet is turned closest to a simplex that is low, if there is noise around.
template <int Dim, std::size_t Corners>
std::optional<Vector<Dim>> Sheets<Dim, Corners>::direction_around(const Points& simplex,
                                                                  std::uint32_t sheet) const {
  if (!(height_of(simplex) < tolerance_)) return {};
  Near near;
  bool is_noisy = false;
  each_meeting(grown(box_around(simplex), tolerance_), [&](std::uint32_t part) {
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
  Around around;
  Near beside;  // of other sheets, turned about as at a right angle
  each_meeting(grown(box_around(simplex), search.tolerance), [&](std::uint32_t part) {
    const double turn = search.turn(part);
    const bool is_beside = shape_of_[part].sheet != sheet;
    if (is_beside && std::abs(turn) < Search::steepest) beside.push_back(part);
    if (!is_beside && turn > 0)
      (turn >= Search::least_turn ? around.covering : around.steep).push_back(part);
    if (turn < -0.01) around.facing.push_back(part);  // not what is at a right angle, nearly
  });
  if (around.covering.empty()) return false;
  const auto graph = search.graph_over(simplex, around.covering);
  if (graph.too_far) return false;
  // An inner sheet has elements on both sides, which keep it apart.
  if (parts_[around.covering.front()].two_sided) around.facing.clear();
  around.facing = search.close_to(simplex, search.reach(graph), around.facing);
  return search.stays_smooth(simplex, around.covering) &&
         search.covered(simplex, graph, around,
                        {around.covering, beside, sphere_around(simplex).centre, {}});
}

/// The weights of the model's point near the closest point of its flat parts; none if the model is
/// flat there.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::weights_at(const Vector<Dim>& point, const Closest& closest) const
    -> std::optional<typename Curved::Weights> {
  if (!origin_of_[closest.part].is_curved) return {};
  constexpr int steps = 3;
  const Origin& origin = origin_of_[closest.part];
  const Curved& curved = curved_[origin.facet];
  const auto share = weights_of(parts_[closest.part].corner, closest.point);
  typename Curved::Weights weights{};
  for (std::size_t i = 0; i < Corners; ++i)
    for (std::size_t k = 0; k < Corners; ++k)
      weights[k] += share[i] * origin.weight[i][k] / most_divisions;
  for (int step = 0; step < steps; ++step) {
    const auto closer = curved.closer(weights, point);
    if (!closer) break;
    weights = *closer;
  }
  return weights;
}

/// The unit normal of a facet there, or the direction that counts as it; for an edge, its tangent.
template <int Dim, std::size_t Corners>
Vector<Dim> Sheets<Dim, Corners>::direction_at(const Vector<Dim>& point,
                                               const Closest& closest) const {
  const auto weights = counts_as_turned(closest.part) ? std::nullopt : weights_at(point, closest);
  if (!weights) return shape_of_[closest.part].direction;
  const Curved& curved = curved_[origin_of_[closest.part].facet];
  return direction_along<Dim, Corners>(curved.tangents(*weights));
}

/// The closest point of the sheet's function to the point itself, if that is near the closest point
/// of the model; otherwise, for instance beyond the end of the sheet, its closest point to the
/// model's point. The model's point if there is no function, or it is unknown there.
template <int Dim, std::size_t Corners>
Vector<Dim> Sheets<Dim, Corners>::on_sheet(const Vector<Dim>& point, const Vector<Dim>& model,
                                           std::uint32_t sheet) const {
  if (!is_exact(sheet)) return model;
  constexpr double near = 1.0 / 4;  // of the tolerance
  if (norm(point - model) <= near * tolerance_) {
    const Vector<Dim> there = projection_of_[sheet](point);
    if (norm(there - model) <= near * tolerance_) return there;
  }
  const Vector<Dim> there = projection_of_[sheet](model);
  return is_known(there) ? there : model;
}

/// The point of the sheet near the closest point of its flat parts.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_at(const Vector<Dim>& point, const Closest& closest) const
    -> Nearest {
  const std::uint32_t facet = origin_of_[closest.part].facet;
  Nearest nearest{parts_[closest.part].sheet, facet, 0, closest.point,
                  shape_of_[closest.part].direction};
  if (const auto weights = weights_at(point, closest)) {
    const Curved& curved = curved_[facet];
    nearest.point = curved.at(*weights);
    nearest.direction = direction_along<Dim, Corners>(curved.tangents(*weights));
  }
  nearest.point = on_sheet(point, nearest.point, nearest.sheet);
  nearest.distance = norm(nearest.point - point);
  return nearest;
}

/// The nearest of the parts for which is_wanted(part) holds. Looks first where it is likely.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_of(const Vector<Dim>& point, double likely, double reach,
                                      auto&& is_wanted) const -> std::optional<Nearest> {
  double within = likely;
  for (bool last = false; !last; within *= 4) {
    last = !(within < reach);
    within = std::min(within, reach);
    Near near;
    each_meeting(grown(box_around(std::array{point}), within), [&](std::uint32_t part) {
      if (is_wanted(part)) near.push_back(part);
    });
    const Closest best = near.closest(*this, point);
    if (best.distance <= within) return nearest_at(point, best);
  }
  return {};
}

template <int Dim, std::size_t Corners>
std::optional<Vector<Dim>> Sheets<Dim, Corners>::closest(const Vector<Dim>& point,
                                                         std::uint32_t sheet, double reach) const {
  const double likely = std::clamp(reach, 1e-3 * tolerance_, tolerance_);
  const auto nearest = nearest_of(point, likely, reach + tolerance_,
                                  [&](std::uint32_t part) { return parts_[part].sheet == sheet; });
  if (!nearest) return {};
  return nearest->point;
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest(const Vector<Dim>& point,
                                   std::span<const std::uint8_t> is_wanted) const
    -> std::optional<Nearest> {
  Closest best;
  double square = best.distance;
  tree_->visit_near(point, square, [&](std::size_t part) {
    if (is_wanted[parts_[part].sheet] == 0) return;
    const Vector<Dim> there = closest_point(parts_[part].corner, point);
    const double distance = norm(there - point);
    if (distance >= best.distance) return;
    best = {distance, there, static_cast<std::uint32_t>(part)};
    square = distance * distance;
  });
  if (!std::isfinite(best.distance)) return {};
  // Steps to the closest point of a curved facet converge for points that are closer to it than its
  // radius of curvature, which is longer than its edges: they start from a point on the way.
  constexpr int times = 2;
  const Points corner = facet_of(best.part);
  const double length = norm(corner[1] - corner[0]);
  Nearest nearest{parts_[best.part].sheet, 0, best.distance, best.point, {}};
  for (int time = 0; time < times; ++time) {
    const Vector<Dim> from = nearest.point, away = point - from;
    const double share = norm(away) > length ? length / norm(away) : 1;
    nearest = nearest_at(from + share * away, best);
  }
  nearest.distance = norm(nearest.point - point);
  return nearest;
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest(const Vector<Dim>& point, double reach) const
    -> std::optional<Nearest> {
  return nearest_of(point, tolerance_, reach, [](std::uint32_t) { return true; });
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_on(const Vector<Dim>& point, std::uint32_t sheet,
                                      double reach) const -> std::optional<Nearest> {
  return nearest_of(point, tolerance_, reach,
                    [&](std::uint32_t part) { return parts_[part].sheet == sheet; });
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest(const Vector<Dim>& point, const Vector<Dim>& direction,
                                   std::span<const std::int32_t> reference_of,
                                   std::int32_t reference, double reach) const
    -> std::optional<Nearest> {
  return nearest_of(point, tolerance_, reach, [&](std::uint32_t part) {
    const double cosine = dot(direction, shape_of_[part].direction);
    return reference_of[parts_[part].sheet] == reference &&
           (parts_[part].two_sided ? std::abs(cosine) : cosine) > 0.5;
  });
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_facet(const Vector<Dim>& point, const Vector<Dim>& direction,
                                         std::span<const std::int32_t> reference_of,
                                         std::int32_t reference, double reach) const
    -> std::optional<Nearest> {
  std::optional<Nearest> best;
  each_meeting(grown(box_around(std::array{point}), reach), [&](std::uint32_t part) {
    const std::uint32_t sheet = parts_[part].sheet;
    const bool two_sided = parts_[part].two_sided;
    const Points facet = facet_of(part);
    const Vector<Dim> normal = direction_of(facet), there = closest_point(facet, point);
    const double cosine = dot(direction, normal), distance = norm(there - point);
    if (reference_of[sheet] != reference || !((two_sided ? std::abs(cosine) : cosine) > 0.5) ||
        (best && distance >= best->distance))
      return;
    best = {sheet, origin_of_[part].facet, distance, there, normal};
  });
  return best;
}

template class Sheets<2, 2>;
template class Sheets<3, 2>;
template class Sheets<3, 3>;

}  // namespace ductile::meshadapt
