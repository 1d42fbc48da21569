/// @file
/// Scenes of a metric: unit ellipses over faint elements.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ductile/meshadapt/metric.hpp"
#include "ellipses.hpp"
#include "report.hpp"
#include "scene.hpp"

namespace ductile::cli {

namespace {

template <int Dim>
Metric<Dim> metric_at(const AnyField& field, std::size_t vertex) {
  Metric<Dim> metric;
  std::copy_n(&field.values[vertex * Metric<Dim>::size], metric.m.size(), metric.m.begin());
  return metric;
}

double largest_extent(const AnyMesh& mesh) {
  const Box<3> box = box_of(mesh);
  const Position width = box.high - box.low;
  return std::max({width[0], width[1], width[2]});
}

std::string title_of(const UnitEllipses& ellipses, const char* where) {
  std::string title = std::string("size that the metric asks for") + where + ", mean of both axes";
  if (ellipses.magnification == 1 && ellipses.all_magnified) return title + "; unit ellipses";
  return title + "; unit ellipses, " + (ellipses.all_magnified ? "" : "most ") +
         format("%.6g times as large", ellipses.magnification);
}

/// Adds ellipses to the last panel. to_panel(p, 1) maps a point of the plane in which they were
/// chosen, to_panel(p, 0) a direction.
void add_chosen(Scene& scene, const UnitEllipses& chosen, const char* where, auto&& to_panel) {
  Legend legend{.title = title_of(chosen, where),
                .tint = Tint::metric,
                .from = std::numeric_limits<double>::infinity(),
                .to = 0};
  for (const UnitEllipse& ellipse : chosen.drawn) {
    legend.from = std::min(legend.from, ellipse.size);
    legend.to = std::max(legend.to, ellipse.size);
  }
  if (chosen.drawn.empty()) legend.from = legend.to = 1;
  widen(legend);
  const double range = std::log(legend.to / legend.from);
  for (const UnitEllipse& ellipse : chosen.drawn)
    scene.panels.back().ellipses.push_back(
        {to_panel(ellipse.centre, 1), to_panel(ellipse.u, 0), to_panel(ellipse.v, 0),
         size_colour(std::log(ellipse.size / legend.from) / range)});
  scene.legends.push_back(legend);
}

/// Twice the area between two vectors, and the angle.
struct Corner {
  double area, angle;
};
Corner corner_between(const Point& a, const Point& b) {
  const double area = a.x * b.y - a.y * b.x;
  return {std::abs(area), std::atan2(std::abs(area), a.x * b.x + a.y * b.y)};
}

/// The metric inside of a tetrahedron, of which the logarithm is linear.
Metric<3> metric_in(const AnyMesh& mesh, const AnyField& field, std::size_t element,
                    const Position& point) {
  const Tetrahedron corner = tetrahedron(mesh, element);
  const auto volume = [&](int replaced) {
    Tetrahedron p = corner;
    if (replaced >= 0) p[static_cast<std::size_t>(replaced)] = point;
    return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
  };
  const double whole = volume(-1);
  Metric<3> sum;
  for (int i = 0; i < 4; ++i) {
    const std::size_t v = mesh.tetrahedra.vertices[element][static_cast<std::size_t>(i)];
    sum += (whole == 0 ? 0.25 : volume(i) / whole) * logarithm(metric_at<3>(field, v));
  }
  return exponential(sum);
}

/// Centroid and area of a triangle or quadrangle.
struct Centre {
  Position position;
  double area = 0;
};
Centre centre_of(const std::vector<Position>& polygon) {
  Centre centre;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double area = norm(cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0])) / 2;
    centre.position += (area / 3) * (polygon[0] + polygon[i - 1] + polygon[i]);
    centre.area += area;
  }
  if (centre.area > 0) centre.position *= 1 / centre.area;
  return centre;
}

}  // namespace

void add_ellipses_2d(Scene& scene, const AnyMesh& mesh, const AnyField& metric) {
  std::vector<EllipsePlace> place_of(mesh.vertex_count());
  std::vector<double> angle_of(mesh.vertex_count());
  const auto point = [&](std::uint32_t v) {
    return Point{mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]};
  };
  for (const auto& corners : mesh.triangles.vertices)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point here = point(corners[i]), a = point(corners[(i + 1) % 3]),
                  b = point(corners[(i + 2) % 3]);
      const Corner corner =
          corner_between({a.x - here.x, a.y - here.y}, {b.x - here.x, b.y - here.y});
      place_of[corners[i]].area += corner.area / 6;
      angle_of[corners[i]] += corner.angle;
    }
  std::vector<EllipsePlace> places;
  constexpr double nearly_all_around = 6.28;
  for (std::size_t v = 0; v < place_of.size(); ++v)
    if (place_of[v].area > 0)
      places.push_back({point(static_cast<std::uint32_t>(v)), metric_at<2>(metric, v),
                        place_of[v].area, angle_of[v] > nearly_all_around});
  add_chosen(scene, choose_ellipses(places, largest_extent(mesh)), "",
             [](const Point& p, double) { return p; });
}

void add_ellipses_3d(Scene& scene, const AnyMesh& mesh, const AnyField& metric,
                     const Camera& camera, int axis) {
  const CutPlane plane = middle_plane(mesh, camera, axis);
  const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  std::vector<EllipsePlace> places;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const std::vector<Position> polygon = section(tetrahedron(mesh, e), plane);
    const Centre centre = centre_of(polygon);
    if (!(centre.area > 0)) continue;
    const Metric<3> all = metric_in(mesh, metric, e, centre.position);
    places.push_back({{centre.position[first], centre.position[second]},
                      {{all(first, first), all(first, second), all(second, second)}},
                      centre.area});
  }
  add_chosen(scene, choose_ellipses(places, largest_extent(mesh)), " in the cut",
             [&](const Point& p, double is_point) {
               Position q;
               q[first] = p.x;
               q[second] = p.y;
               q[axis] = is_point * plane.at;
               return camera.project(q);
             });
}

}  // namespace ductile::cli
