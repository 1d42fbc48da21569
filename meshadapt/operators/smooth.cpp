#include "operators/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/determinant.hpp"
#include "core/unit.hpp"

namespace ductile::meshadapt {

namespace {

/// The shortest vector in the convex hull of the gradients: along it none of their functions falls
/// to first order (Gilbert's algorithm, SIAM J. Control 4, 1966).
template <int Dim, class Vectors>
Vector<Dim> shortest_in_hull(const Vectors& gradients) {
  Vector<Dim> x = gradients[0];
  for (int step = 0; step < 12; ++step) {
    const Vector<Dim>* low = &gradients[0];
    for (const Vector<Dim>& g : gradients)
      if (dot(g, x) < dot(*low, x)) low = &g;
    const Vector<Dim> towards = *low - x;
    const double length2 = dot(towards, towards);
    const double t = length2 > 0 ? std::clamp(-dot(x, towards) / length2, 0.0, 1.0) : 0.0;
    if (t < 1e-3) break;
    x += t * towards;
  }
  return x;
}

}  // namespace

template <int Dim, int Space>
bool Smooth<Dim, Space>::decide(VertexId vertex, Plan& plan) const {
  const auto elements = mesh_.elements_of.of(vertex);
  if (elements.empty() || elements.size() > mesh_.largest_ball) return false;
  if (options_.to_surface) {
    Place best;
    return settle(vertex, best) && follow(vertex, best, plan);
  }
  constexpr double sound = 1e-6;  // the inverse of a quality tells something
  const double good_enough = quality_of_mean_ratio<Dim>(options_.optimise_below);
  const auto is_good = [&](ElementId e) { return mesh_.quality_of[e] >= good_enough; };
  if (!options_.laplacian && std::all_of(elements.begin(), elements.end(), is_good)) return false;
  background_.prefetch_corners(mesh_.host_of[vertex]);
  const VertexBall<Dim, Space> ball(mesh_, vertex);
  std::array<Place, 2> places{Place{mesh_.site_of[vertex], mesh_.host_of[vertex], ball.present()}};
  bool moved = options_.laplacian && relax(vertex, ball, places[0], places[1]);
  Place& best = places[moved ? 1 : 0];
  if (best.score.worst < good_enough) {
    const double poor = quality_of_mean_ratio<Dim>(options_.mean_below);
    const bool all_poor =
        best.score.worst > sound && best.score.sum < poor * static_cast<double>(ball.size());
    moved = optimise(vertex, ball, all_poor ? Aim::mean : Aim::worst, best) || moved;
  }
  return moved && follow(vertex, best, plan);
}

/// Plans to go there.
template <int Dim, int Space>
bool Smooth<Dim, Space>::follow(VertexId vertex, const Place& best, Plan& plan) const {
  const Vector<Space> step = best.site.position - mesh_.site_of[vertex].position;
  const bool far = squared_length(best.site.metric, step) > options_.far * options_.far;
  plan = {best.host, best.site, best.qualities, far};
  return true;
}

/// visit(sheets, number) of the smooth curve or patch that the vertex may move along.
template <int Dim, int Space>
auto Smooth<Dim, Space>::visit_sheet(VertexId vertex, auto&& visit) const {
  const std::uint32_t entity = mesh_.entity_of[vertex];
  if constexpr (Dim < Space) {
    if (in_smooth_patch(mesh_, vertex))
      return visit(mesh_.surface->facets, mesh_.regions[region_of(vertex)].sheet);
    return visit(mesh_.surface->edges, mesh_.patches[entity].sheet);
  } else {
    if (on_smooth_curve(mesh_, vertex))
      return visit(mesh_.surface->edges, mesh_.curves[entity].sheet);
    return visit(mesh_.surface->facets, mesh_.patches[entity].sheet);
  }
}

/// Is what the vertex may move along known by a function?
template <int Dim, int Space>
bool Smooth<Dim, Space>::follows_function(VertexId vertex) const {
  return visit_sheet(
      vertex, [](const auto& sheets, std::uint32_t sheet) { return sheets.is_exact(sheet); });
}

/// Goes to the closest point of the surface's model, or towards it, unless it is there.
template <int Dim, int Space>
bool Smooth<Dim, Space>::settle(VertexId vertex, Place& best) const {
  const double close = follows_function(vertex) ? 1e-10 : 0.01;  // of the tolerance
  constexpr double kept = 0.7;                                   // of the worst quality
  const Vector<Space> from = mesh_.site_of[vertex].position;
  const auto target = stepped(vertex, from, {});
  if (!target) return false;
  const Vector<Space> step = *target - from;
  if (norm(step) <= close * mesh_.surface->facets.tolerance()) return false;
  background_.prefetch_corners(mesh_.host_of[vertex]);
  const VertexBall<Dim, Space> ball(mesh_, vertex);
  const Place here{mesh_.site_of[vertex], mesh_.host_of[vertex], ball.present()};
  for (const double fraction : {1.0, 0.5, 0.25})
    if (place(ball, from + fraction * step, here, {kept * here.score.worst, 0}, best)) return true;
  return false;
}

/// Is it certain that every element around the vertex has a positive volume if it moves there, and
/// that its facets on patches keep their turn?
template <int Dim, int Space>
bool Smooth<Dim, Space>::keeps_volumes(VertexId vertex, const Vector<Space>& position) const {
  const bool on_boundary = mesh_.kind_of[vertex].class_dimension < Space;
  for (const ElementId e : mesh_.elements_of.of(vertex)) {
    const auto p = corners_with(mesh_, e, vertex, position);
    if constexpr (Dim < Space) {
      if (!(certain_area(p[0], p[1], p[2]) > 0)) return false;
    } else {
      if (!(certain_determinant<Dim>(p) > 0)) return false;
    }
    if (on_boundary && !keeps_facets_turned(mesh_, e, vertex, position)) return false;
  }
  return true;
}

/// Do smooth patches and curves stay close to what they were if the vertex moves there? On its way
/// to the model of the surface it may leave facets that are not close as they are.
template <int Dim, int Space>
bool Smooth<Dim, Space>::keeps_surface(VertexId vertex, const Vector<Space>& position) const {
  if (!mesh_.surface) return true;
  if constexpr (Dim == 3)
    if (on_smooth_curve(mesh_, vertex))
      for (const CurveLink& link : mesh_.links_of.of(vertex))
        if (!mesh_.surface->edges.cover({mesh_.site_of[link.to].position, position},
                                        mesh_.curves[link.curve].sheet))
          return false;
  const auto elements = mesh_.elements_of.of(vertex);
  return std::all_of(elements.begin(), elements.end(), [&](ElementId e) {
    const auto keeps = [&](const Vector<Space>& at) {
      return meshadapt::keeps_surface(mesh_, e, vertex, at);
    };
    return keeps(position) || (options_.to_surface && !keeps(mesh_.site_of[vertex].position));
  });
}

/// Do all edges of the vertex stay in the range, or as close to it as they are, if it is here?
template <int Dim, int Space>
bool Smooth<Dim, Space>::keeps_lengths(VertexId vertex, const Site<Space>& site) const {
  if (!options_.range.is_bounded()) return true;
  bool keeps = true;
  visit_neighbours(mesh_, vertex, [&](VertexId v) {
    const Site<Space>& other = mesh_.site_of[v];
    const EndSquares edge = end_squares(site, other);
    keeps = keeps && (options_.range.contains(edge) ||
                      options_.range.accepts(edge, end_squares(mesh_.site_of[vertex], other)));
  });
  return keeps;
}

/// True if a place scores better than a bar; sets `result` to it. The place is first scored with
/// the metric nearby, which needs no search; a place with positive volumes lies inside the domain.
template <int Dim, int Space>
bool Smooth<Dim, Space>::place(const VertexBall<Dim, Space>& ball, const Vector<Space>& position,
                               const Place& near, const Score& bar, Place& result) const {
  const auto beats_bar = [&](const Score& score) { return score.worst > 0 && score.sum > bar.sum; };
  if (!beats_bar(ball.score({position, near.site.metric, near.site.scale}, bar.worst)))
    return false;
  const auto sample = background_.sample(position, near.host);
  result.site = make_site(position, sample.metric);
  result.host = sample.host;
  result.score = ball.score(result.site, bar.worst, result.qualities);
  const auto is_certain = [&] {
    if constexpr (Dim < Space)
      return false;
    else
      return mesh_.kind_of[ball.vertex()].class_dimension == Dim &&
             ball.is_certain(result.score.volume, position);
  };
  return beats_bar(result.score) && keeps_lengths(ball.vertex(), result.site) &&
         (is_certain() ||
          (keeps_volumes(ball.vertex(), position) && keeps_surface(ball.vertex(), position)));
}

/// Along a curve, where it is smooth between the next vertices on both sides.
template <int Dim, int Space>
Vector<Space> Smooth<Dim, Space>::tangent(VertexId vertex) const {
  if constexpr (Space == 3) {
    const std::uint32_t entity = mesh_.entity_of[vertex];
    const Curve& curve = [&]() -> const Curve& {
      if constexpr (Dim == 3)
        return mesh_.curves[entity];
      else
        return mesh_.patches[entity];
    }();
    if (!curve.smooth) return curve.direction;
    const auto [before, after] = next_on_curve(vertex);
    return unit(mesh_.site_of[after].position - mesh_.site_of[before].position);
  }
  return {};
}

/// The next vertices on both sides along the curve of a vertex.
template <int Dim, int Space>
std::array<VertexId, 2> Smooth<Dim, Space>::next_on_curve(VertexId vertex) const {
  if constexpr (Dim == 3) {
    const auto links = mesh_.links_of.of(vertex);
    return {links[0].to, links[1].to};
  }
  std::array<VertexId, 2> next{none, none};
  for (const ElementId e : mesh_.elements_of.of(vertex))
    for (std::size_t i = 0; i <= Dim; ++i) {
      const auto& corners = mesh_.corners_of[e];
      if (corners[i] == vertex || mesh_.patches_of[e][i] == 0) continue;
      const VertexId other =
          corners[(i + 1) % 3] == vertex ? corners[(i + 2) % 3] : corners[(i + 1) % 3];
      if (next[0] == none || next[0] == other)
        next[0] = other;
      else
        next[1] = other;
    }
  return next;
}

/// The normal of the vertex's patch; if that is smooth, the mean of the facets around the vertex.
template <int Dim, int Space>
Vector<Space> Smooth<Dim, Space>::normal(VertexId vertex) const {
  if constexpr (Dim < Space) {
    const Patch<Space>& patch = mesh_.regions[region_of(vertex)];
    if (!patch.smooth) return patch.normal;
    Vector<Space> sum;
    for (const ElementId e : mesh_.elements_of.of(vertex))
      sum += facet_normal(corners_with(mesh_, e, none, {}));
    return unit(sum);
  } else {
    const PatchId patch = mesh_.entity_of[vertex];
    if (!mesh_.patches[patch].smooth) return mesh_.patches[patch].normal;
    const std::uint32_t side = mesh_.region_of[mesh_.elements_of.of(vertex)[0]];
    Vector<Space> sum;
    for (const ElementId e : mesh_.elements_of.of(vertex))
      for (std::size_t i = 0; i <= Dim; ++i) {
        if (mesh_.patches_of[e][i] != patch || mesh_.corners_of[e][i] == vertex) continue;
        const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], static_cast<int>(i));
        std::array<Vector<Space>, Dim> p;
        for (std::size_t k = 0; k < Dim; ++k) p[k] = mesh_.site_of[facet[k]].position;
        sum += (mesh_.region_of[e] == side ? 1.0 : -1.0) * facet_normal(p);
      }
    const double length = norm(sum);
    return length > 0 ? (1 / length) * sum : Vector<Space>{};
  }
}

/// The part of a displacement that keeps the vertex on its patch or curve, or along it.
template <int Dim, int Space>
Vector<Space> Smooth<Dim, Space>::allowed(VertexId vertex, Vector<Space> displacement) const {
  const int class_dimension = mesh_.kind_of[vertex].class_dimension;
  if (class_dimension == Space) return displacement;
  if (Space == 3 && class_dimension == 1) {
    const Vector<Space> along = tangent(vertex);
    return dot(displacement, along) * along;
  }
  // Twice: what rounding leaves of a displacement that is long across is not little.
  const Vector<Space> across = normal(vertex);
  displacement -= dot(displacement, across) * across;
  return displacement - dot(displacement, across) * across;
}

/// The end of a step: if it follows a smooth patch or curve, the closest point of the model of that
/// patch or curve in the input.
template <int Dim, int Space>
std::optional<Vector<Space>> Smooth<Dim, Space>::stepped(VertexId vertex, const Vector<Space>& from,
                                                         const Vector<Space>& step) const {
  const Vector<Space> to = from + step;
  if (!on_smooth_curve(mesh_, vertex) && !on_smooth_patch(mesh_, vertex) &&
      !in_smooth_patch(mesh_, vertex))
    return to;
  return visit_sheet(vertex, [&](const auto& sheets, std::uint32_t sheet) {
    return sheets.closest(to, sheet, norm(step));
  });
}

/// Goes towards where the elements want it as far as their qualities get better.
template <int Dim, int Space>
bool Smooth<Dim, Space>::relax(VertexId vertex, const VertexBall<Dim, Space>& ball,
                               const Place& from, Place& to) const {
  const Vector<Space> step = allowed(vertex, ball.mean_pull(from.site));
  if (squared_length(from.site.metric, step) < 1e-4) return false;
  const Score bar{std::min(from.score.worst, quality_of_mean_ratio<Dim>(0.7)),
                  from.score.sum * (1 + 1e-4)};
  for (const double fraction : {1.0, 0.5, 0.25}) {
    const auto position = stepped(vertex, from.site.position, fraction * step);
    if (position && place(ball, *position, from, bar, to)) return true;
  }
  return false;
}

/// A direction in which all of the worst elements get better, or nearly 0 if there is none; or that
/// in which the harmonic mean of all qualities rises most. It is sought in the space where the
/// metric is the identity, lest the thin direction hide the others.
template <int Dim, int Space>
Vector<Space> Smooth<Dim, Space>::ascent(VertexId vertex, const VertexBall<Dim, Space>& ball,
                                         Aim aim, const Place& at) const {
  const PrincipalAxes<Space> axes = principal_axes(at.site.metric);
  Buffer<Vector<Space>, 16> gradients;
  ball.visit_qualities(at.site, [&](std::size_t element, double quality) {
    if (aim == Aim::worst && quality > at.score.worst * 1.15 + 0.01) return;
    const double weight = aim == Aim::worst ? 1 : 1 / (quality * quality);
    const Vector<Space> free = allowed(vertex, ball.gradient(element, at.site, quality));
    Vector<Space> unit;
    for (int i = 0; i < Space; ++i) {
      const auto k = static_cast<std::size_t>(i);
      unit[i] = weight * dot(free, axes.vector[k]) / std::sqrt(axes.value[k]);
    }
    gradients.push_back(unit);
  });
  if (gradients.empty()) return {};
  Vector<Space> unit;
  if (aim == Aim::worst)
    unit = shortest_in_hull<Space>(gradients);
  else
    for (const Vector<Space>& gradient : gradients) unit += gradient;
  Vector<Space> direction;
  for (int i = 0; i < Space; ++i) {
    const auto k = static_cast<std::size_t>(i);
    direction += (unit[i] / std::sqrt(axes.value[k])) * axes.vector[k];
  }
  return allowed(vertex, direction);
}

/// The sum of the inverse qualities around the vertex if it were at this site.
template <int Dim, int Space>
double Smooth<Dim, Space>::inverse_qualities(const VertexBall<Dim, Space>& ball,
                                             const Site<Space>& site) {
  double sum = 0;
  ball.visit_qualities(site, [&](std::size_t, double quality) { sum += 1 / quality; });
  return sum;
}

/// Climbs the worst quality around the vertex, or the harmonic mean of all, by line searches.
template <int Dim, int Space>
bool Smooth<Dim, Space>::optimise(VertexId vertex, const VertexBall<Dim, Space>& ball, Aim aim,
                                  Place& best) const {
  constexpr int climbs = 4, halvings = 5;
  bool moved = false;
  Place trial;
  double reach = 0.3;  // metric length of the first trial step
  for (int climb = 0; climb < climbs; ++climb) {
    const Vector<Space> direction = ascent(vertex, ball, aim, best);
    const double length = std::sqrt(squared_length(best.site.metric, direction));
    if (!(length > 0) || !std::isfinite(length)) break;
    bool better = false;
    const double bar = aim == Aim::worst ? best.score.worst * 1.001 : 0;
    const double most = aim == Aim::worst ? 0 : inverse_qualities(ball, best.site) * 0.999;
    for (int halving = 0; halving < halvings && !better; ++halving, reach *= 0.5) {
      // The rest of a direction that was nearly normal to its patch is rounding, still normal.
      const Vector<Space> step = allowed(vertex, (reach / length) * direction);
      const auto position = stepped(vertex, best.site.position, step);
      if (!position || !place(ball, *position, best, {bar, 0}, trial)) continue;
      if (aim == Aim::mean && inverse_qualities(ball, trial.site) > most) continue;
      best = trial;
      better = moved = true;
    }
    if (!better) break;
    reach *= 2;
  }
  return moved;
}

template <int Dim, int Space>
void Smooth<Dim, Space>::move(VertexId vertex, const Plan& plan) {
  mesh_.site_of[vertex] = plan.site;
  mesh_.host_of[vertex] = plan.host;
  const auto elements = mesh_.elements_of.of(vertex);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementId e = elements[i];
    mesh_.quality_of[e] = i < BallQualities<Dim>::most
                              ? plan.qualities[i]
                              : static_cast<float>(mesh_.quality_at(mesh_.corners_of[e]));
    if (plan.far) mesh_.changed_at[elements[i]] = mesh_.epoch;  // else it is too little to matter
  }
}

template class Smooth<2>;
template class Smooth<2, 3>;
template class Smooth<3>;

}  // namespace ductile::meshadapt
