/// @file
/// Which point of a sheet is the closest to another.
#include <algorithm>
#include <cmath>

#include "geometry/sheets_parts.hpp"

namespace ductile::meshadapt {

namespace {

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

/// The weights of the model's point near the closest point of its flat parts; none if the model is
/// flat there.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::weights_at(const Vector<Dim>& point, const Closest& closest) const
    -> std::optional<typename Curved::Weights> {
  if (origin_of_[closest.part].curved == none) return {};
  constexpr int steps = 3;
  const Origin& origin = origin_of_[closest.part];
  const Curved& curved = curved_[origin.curved];
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

template <int Dim, std::size_t Corners>
Vector<Dim> Sheets<Dim, Corners>::on_model(const Vector<Dim>& point, const Closest& closest) const {
  const auto weights = weights_at(point, closest);
  return weights ? curved_[origin_of_[closest.part].curved].at(*weights) : closest.point;
}

/// The unit normal of a facet there, or the direction that counts as it; for an edge, its tangent.
template <int Dim, std::size_t Corners>
Vector<Dim> Sheets<Dim, Corners>::direction_at(const Vector<Dim>& point,
                                               const Closest& closest) const {
  const auto weights = counts_as_turned(closest.part) ? std::nullopt : weights_at(point, closest);
  if (!weights) return shape_of_[closest.part].direction;
  const Curved& curved = curved_[origin_of_[closest.part].curved];
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

/// Looks nearby first, because it is likely there; reach and tolerance may be large.
template <int Dim, std::size_t Corners>
std::optional<Vector<Dim>> Sheets<Dim, Corners>::closest(const Vector<Dim>& point,
                                                         std::uint32_t sheet, double reach) const {
  const double most = reach + tolerance_;
  double within = std::min(reach, tolerance_);
  for (bool last = false; !last; within *= 4) {
    last = !(within > 0 && within < most);
    if (last) within = most;
    Near near;
    each_meeting(box_around(std::array{point}, within), [&](std::uint32_t part) {
      if (parts_[part].sheet == sheet) near.push_back(part);
    });
    const Closest best = near.closest(*this, point);
    if (best.distance <= within) return on_sheet(point, on_model(point, best), sheet);
  }
  return {};
}

/// The point of the sheet near the closest point of its flat parts.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_at(const Vector<Dim>& point, const Closest& closest) const
    -> Nearest {
  Nearest nearest{parts_[closest.part].sheet, 0, closest.point, shape_of_[closest.part].direction};
  if (const auto weights = weights_at(point, closest)) {
    const Curved& curved = curved_[origin_of_[closest.part].curved];
    nearest.point = curved.at(*weights);
    nearest.direction = direction_along<Dim, Corners>(curved.tangents(*weights));
  }
  nearest.point = on_sheet(point, nearest.point, nearest.sheet);
  nearest.distance = norm(nearest.point - point);
  return nearest;
}

/// The nearest of the parts for which is_wanted(part) holds. Looks nearby first.
template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_of(const Vector<Dim>& point, double reach,
                                      auto&& is_wanted) const -> std::optional<Nearest> {
  double within = std::min(reach, tolerance_);
  for (bool last = false; !last; within *= 4) {
    last = !(within < reach);
    within = std::min(within, reach);
    Near near;
    each_meeting(box_around(std::array{point}, within), [&](std::uint32_t part) {
      if (is_wanted(part)) near.push_back(part);
    });
    const Closest best = near.closest(*this, point);
    if (best.distance <= within) return nearest_at(point, best);
  }
  return {};
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest(const Vector<Dim>& point,
                                   std::span<const std::uint8_t> is_wanted) const
    -> std::optional<Nearest> {
  Closest best;
  double square = best.distance;
  tree_->visit_near(point, square, [&](std::size_t place) {
    const std::uint32_t facet = tree_->order()[place];
    for (std::uint32_t part = first_part_[facet]; part < first_part_[facet + 1]; ++part) {
      if (is_wanted[parts_[part].sheet] == 0) continue;
      const Vector<Dim> there = closest_point(parts_[part].corner, point);
      const double distance = norm(there - point);
      if (distance < best.distance) best = {distance, there, part};
    }
    square = best.distance * best.distance;
  });
  if (!std::isfinite(best.distance)) return {};
  // Steps to the closest point of a curved facet converge for points that are closer to it than its
  // radius of curvature, which is longer than its edges: they start from a point on the way.
  constexpr int times = 2;
  const Points corner = facet_of(best.part);
  const double length = norm(corner[1] - corner[0]);
  Nearest nearest{parts_[best.part].sheet, best.distance, best.point, {}};
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
  return nearest_of(point, reach, [](std::uint32_t) { return true; });
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest_on(const Vector<Dim>& point, std::uint32_t sheet,
                                      double reach) const -> std::optional<Nearest> {
  return nearest_of(point, reach, [&](std::uint32_t part) { return parts_[part].sheet == sheet; });
}

template <int Dim, std::size_t Corners>
auto Sheets<Dim, Corners>::nearest(const Vector<Dim>& point, const Vector<Dim>& direction,
                                   std::span<const std::int32_t> reference_of,
                                   std::int32_t reference, double reach) const
    -> std::optional<Nearest> {
  return nearest_of(point, reach, [&](std::uint32_t part) {
    const double cosine = dot(direction, shape_of_[part].direction);
    return reference_of[parts_[part].sheet] == reference &&
           (parts_[part].two_sided ? std::abs(cosine) : cosine) > 0.5;
  });
}

template std::optional<Sheets<2, 2>::Curved::Weights> Sheets<2, 2>::weights_at(
    const Vector<2>&, const Closest&) const;
template Vector<2> Sheets<2, 2>::on_model(const Vector<2>&, const Closest&) const;
template Vector<2> Sheets<2, 2>::direction_at(const Vector<2>&, const Closest&) const;
template Vector<2> Sheets<2, 2>::on_sheet(const Vector<2>&, const Vector<2>&, std::uint32_t) const;
template std::optional<Vector<2>> Sheets<2, 2>::closest(const Vector<2>&, std::uint32_t,
                                                        double) const;
template std::optional<Sheets<2, 2>::Nearest> Sheets<2, 2>::nearest(
    const Vector<2>&, std::span<const std::uint8_t>) const;
template std::optional<Sheets<2, 2>::Nearest> Sheets<2, 2>::nearest(const Vector<2>&, double) const;
template std::optional<Sheets<2, 2>::Nearest> Sheets<2, 2>::nearest(const Vector<2>&,
                                                                    const Vector<2>&,
                                                                    std::span<const std::int32_t>,
                                                                    std::int32_t, double) const;
template std::optional<Sheets<3, 2>::Curved::Weights> Sheets<3, 2>::weights_at(
    const Vector<3>&, const Closest&) const;
template Vector<3> Sheets<3, 2>::on_model(const Vector<3>&, const Closest&) const;
template Vector<3> Sheets<3, 2>::direction_at(const Vector<3>&, const Closest&) const;
template Vector<3> Sheets<3, 2>::on_sheet(const Vector<3>&, const Vector<3>&, std::uint32_t) const;
template std::optional<Vector<3>> Sheets<3, 2>::closest(const Vector<3>&, std::uint32_t,
                                                        double) const;
template std::optional<Sheets<3, 2>::Nearest> Sheets<3, 2>::nearest(const Vector<3>&, double) const;
template std::optional<Sheets<3, 2>::Nearest> Sheets<3, 2>::nearest(const Vector<3>&,
                                                                    const Vector<3>&,
                                                                    std::span<const std::int32_t>,
                                                                    std::int32_t, double) const;
template Vector<3> Sheets<3, 3>::direction_at(const Vector<3>&, const Closest&) const;
template std::optional<Sheets<3, 3>::Curved::Weights> Sheets<3, 3>::weights_at(
    const Vector<3>&, const Closest&) const;
template Vector<3> Sheets<3, 3>::on_model(const Vector<3>&, const Closest&) const;
template Vector<3> Sheets<3, 3>::on_sheet(const Vector<3>&, const Vector<3>&, std::uint32_t) const;
template std::optional<Vector<3>> Sheets<3, 3>::closest(const Vector<3>&, std::uint32_t,
                                                        double) const;
template std::optional<Sheets<3, 3>::Nearest> Sheets<3, 3>::nearest(
    const Vector<3>&, std::span<const std::uint8_t>) const;
template std::optional<Sheets<3, 3>::Nearest> Sheets<3, 3>::nearest(const Vector<3>&, double) const;
template std::optional<Sheets<3, 3>::Nearest> Sheets<3, 3>::nearest(const Vector<3>&,
                                                                    const Vector<3>&,
                                                                    std::span<const std::int32_t>,
                                                                    std::int32_t, double) const;

template std::optional<Sheets<2, 2>::Nearest> Sheets<2, 2>::nearest_on(const Vector<2>&,
                                                                       std::uint32_t, double) const;
template std::optional<Sheets<3, 2>::Nearest> Sheets<3, 2>::nearest_on(const Vector<3>&,
                                                                       std::uint32_t, double) const;
template std::optional<Sheets<3, 3>::Nearest> Sheets<3, 3>::nearest_on(const Vector<3>&,
                                                                       std::uint32_t, double) const;

}  // namespace ductile::meshadapt
