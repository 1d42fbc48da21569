#include "geometry/rounding.hpp"

#include <algorithm>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/surface_mesh.hpp"

namespace ductile::meshadapt {

namespace {

/// The centre of points and the axes of their spread, from the narrowest on.
template <int Dim>
struct Spread {
  Vector<Dim> centre;
  std::array<Vector<Dim>, Dim> axis;
};
template <int Dim>
Spread<Dim> spread_of_points(std::span<const Vector<Dim>> points) {
  Spread<Dim> spread;
  for (const Vector<Dim>& p : points) spread.centre += (1.0 / points.size()) * p;
  Metric<Dim> moments;
  for (const Vector<Dim>& p : points) {
    const Vector<Dim> d = p - spread.centre;
    std::size_t at = 0;
    for (int j = 0; j < Dim; ++j)
      for (int i = 0; i <= j; ++i) moments.m[at++] += d[i] * d[j];
  }
  const PrincipalAxes<Dim> axes = principal_axes(moments);
  std::array<std::size_t, Dim> order;
  for (std::size_t i = 0; i < Dim; ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return axes.value[a] < axes.value[b]; });
  for (std::size_t i = 0; i < Dim; ++i) spread.axis[i] = axes.vector[order[i]];
  return spread;
}

/// From a line to a point.
template <int Dim>
Vector<Dim> aside(const Flat<Dim>& line, const Vector<Dim>& point) {
  const Vector<Dim> d = point - line.origin;
  return d - dot(d, line.direction) * line.direction;
}

}  // namespace

template <int Dim>
double rounding_tolerance(const Precision& precision) {
  return std::sqrt(double{Dim}) * precision.unit;
}

template <int Dim>
Flat<Dim> best_plane(std::span<const Vector<Dim>> points) {
  const Spread<Dim> spread = spread_of_points(points);
  return {spread.centre, spread.axis[0]};
}

template <int Dim>
std::optional<Flat<Dim>> plane_near(std::span<const Vector<Dim>> points, double distance) {
  const Flat<Dim> plane = best_plane(points);
  for (const Vector<Dim>& p : points)
    if (!(std::abs(dot(p - plane.origin, plane.direction)) <= distance)) return {};
  return plane;
}

std::optional<Flat<3>> line_near(std::span<const Vector<3>> points, double distance) {
  const Spread<3> spread = spread_of_points(points);
  const Flat<3> line{spread.centre, spread.axis[2]};
  for (const Vector<3>& p : points)
    if (!(norm(aside(line, p)) <= distance)) return {};
  return line;
}

bool explains_line(const Vector<3>& a, const Vector<3>& b, const Vector<3>& point,
                   double tolerance) {
  const Vector<3> along = b - a, d = point - a;
  const double square = dot(along, along);
  if (!(square > 0)) return false;
  const double share = dot(d, along) / square;
  return norm(d - share * along) <= tolerance * (1 + std::abs(share) + std::abs(1 - share));
}

template <int Dim>
bool explains(const std::array<Vector<Dim>, Dim>& facet, const Vector<Dim>& point,
              double tolerance) {
  const Vector<Dim> normal = facet_normal(facet), d = point - facet[0];
  const double square = dot(normal, normal);
  if (!(square > 0)) return false;
  double lever = 0;  // the sum of the weights with which the corners make up the point's foot
  if constexpr (Dim == 2) {
    const Vector<2> along = facet[1] - facet[0];
    const double share = dot(d, along) / dot(along, along);
    lever = std::abs(share) + std::abs(1 - share);
  } else {
    const double v = dot(cross(d, facet[2] - facet[0]), normal) / square;
    const double w = dot(cross(facet[1] - facet[0], d), normal) / square;
    lever = std::abs(v) + std::abs(w) + std::abs(1 - v - w);
  }
  return std::abs(dot(d, normal)) <= tolerance * (1 + lever) * std::sqrt(square);
}

template <int Dim>
Vector<Dim> Rounding<Dim>::rounded(Vector<Dim> position, int class_dimension,
                                   std::uint32_t entity) const {
  const auto flat_of = [&](const auto& flats) {
    return entity < flats.size() ? flats[entity] : std::nullopt;
  };
  if (class_dimension == Dim - 1) {
    if (const auto plane = flat_of(plane_of))
      position -= dot(position - plane->origin, plane->direction) * plane->direction;
  } else if (class_dimension == 1) {
    if (const auto line = flat_of(line_of)) position -= aside(*line, position);
  }
  for (double& x : position.x) x = precision.rounded(x);
  return position;
}

template <int Dim>
double roughness(const AnyMesh& mesh) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const runtime::Executor executor({.threads = 1});
  const auto roughness_of = [](const auto& made) {
    return made.rounding ? made.rounding->tolerance : 0;
  };
  try {
    if (is_surface(mesh)) {
      Neighbours<2> of_triangles;
      return roughness_of(make_surface_mesh(executor, mesh, {}, of_triangles, warnings));
    }
    return roughness_of(
        make_mesh<Dim>(executor, mesh, {.complete_boundary = true}, neighbours, warnings));
  } catch (const InputError&) {
    return 0;
  }
}

template double roughness<2>(const AnyMesh&);
template double roughness<3>(const AnyMesh&);
template double rounding_tolerance<2>(const Precision&);
template double rounding_tolerance<3>(const Precision&);
template Flat<2> best_plane(std::span<const Vector<2>>);
template Flat<3> best_plane(std::span<const Vector<3>>);
template std::optional<Flat<2>> plane_near(std::span<const Vector<2>>, double);
template std::optional<Flat<3>> plane_near(std::span<const Vector<3>>, double);
template bool explains<2>(const std::array<Vector<2>, 2>&, const Vector<2>&, double);
template bool explains<3>(const std::array<Vector<3>, 3>&, const Vector<3>&, double);
template struct Rounding<2>;
template struct Rounding<3>;

}  // namespace ductile::meshadapt
