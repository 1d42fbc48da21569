#include "geometry/projection.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
std::string written(const Vector<Dim>& point) {
  std::string text = "(";
  for (int i = 0; i < Dim; ++i) text += (i == 0 ? "" : ", ") + number(point[i]);
  return text + ")";
}

/// A caller's function, checked.
template <int Dim>
struct Checked {
  SurfaceFunction function;
  double reach;  // the largest distance of a point from its projection

  Vector<Dim> operator()(const Vector<Dim>& point) const {
    std::array<double, 3> from{};
    for (int i = 0; i < Dim; ++i) from[static_cast<std::size_t>(i)] = point[i];
    const std::array<double, 3> to = function.closest(from);
    Vector<Dim> result;
    for (int i = 0; i < Dim; ++i) result[i] = to[static_cast<std::size_t>(i)];
    const double distance = norm(result - point);
    if (distance <= reach) return result;
    if (function.approximate) return unknown_place<Dim>();
    throw InputError("the function of the surface with the reference " +
                     std::to_string(function.reference) + ": expected a point within " +
                     number(reach) + " of " + written(point) + ", found " + written(result));
  }
};

/// Closest point of a plane.
struct OnPlane {
  Vector<3> origin, normal;
  Vector<3> operator()(const Vector<3>& point) const {
    return point - dot(point - origin, normal) * normal;
  }
};

/// Two different patches of a sorted list; 0 if there is no other.
std::array<PatchId, 2> first_two(const std::vector<PatchId>& patches) {
  if (patches.empty()) return {};
  return {patches.front(), patches.back() == patches.front() ? 0 : patches.back()};
}

/// Finds the point where two surfaces meet near a point: steps to the line in which their tangent
/// planes meet, again and again. The normal of each surface is the direction from it to the closest
/// point of the other, which is accurate however close the point is to both. Unknown if one is.
struct OnBoth {
  Projection<3> first, second;

  Vector<3> operator()(Vector<3> point) const {
    constexpr int steps = 12;
    constexpr double rounding = 4e-16, little = 1e-3;
    for (int step = 0; step < steps; ++step) {
      const Vector<3> a = first(point), b = second(point);
      const double off_a = norm(a - point), off_b = norm(b - point);
      if (!is_known(a) || !is_known(b)) return unknown_place<3>();
      if (std::max(off_a, off_b) <= rounding * norm(point)) break;
      const Vector<3> u = b - first(b), v = a - second(a);
      if (norm(v) <= little * off_a) {
        point = a;  // which is on both, nearly
      } else if (norm(u) <= little * off_b) {
        point = b;
      } else {
        const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), area = uu * vv - uv * uv;
        if (!(area > 1e-4 * uu * vv)) return b;  // they touch
        const double p = dot(b - u - point, u), q = dot(a - v - point, v);
        point += ((vv * p - uv * q) / area) * u + ((uu * q - uv * p) / area) * v;
      }
    }
    return point;
  }
};

}  // namespace

void expect_functions(std::span<const SurfaceFunction> functions) {
  std::set<std::int32_t> references;
  for (const SurfaceFunction& function : functions) {
    const std::string which =
        "functions: that of the reference " + std::to_string(function.reference);
    if (!function.closest) throw InputError(which + " is empty");
    if (!references.insert(function.reference).second)
      throw InputError(which + " is there twice; expected one of each surface");
  }
}

template <int Dim>
std::vector<Projection<Dim>> projections_of_patches(const Mesh<Dim>& mesh,
                                                    std::span<const SurfaceFunction> functions,
                                                    const Reach& reach) {
  std::vector<Projection<Dim>> of_patch;
  if (functions.empty()) return of_patch;
  of_patch.resize(mesh.patches.size());
  for (std::size_t p = 1; p < mesh.patches.size(); ++p) {
    const auto found = std::find_if(functions.begin(), functions.end(), [&](const auto& function) {
      return function.reference == mesh.patches[p].reference;
    });
    if (found != functions.end())
      of_patch[p] = Checked<Dim>{*found, found->approximate ? reach.approximate : reach.exact};
  }
  return of_patch;
}

std::vector<Projection<3>> projections_of_curves(const Mesh<3>& mesh,
                                                 const std::vector<Projection<3>>& of_patch,
                                                 std::span<const CurveEdge> edges) {
  std::vector<Projection<3>> of_curve;
  if (of_patch.empty()) return of_curve;
  of_curve.resize(mesh.curves.size());
  for (const CurveEdge& edge : edges) {
    if (of_curve[edge.curve]) continue;
    auto [p, q] = first_two(edge.patches);
    if (!of_patch[p]) std::swap(p, q);
    if (!of_patch[p]) continue;
    Projection<3> other = of_patch[q];
    if (q != 0 && !other && !mesh.patches[q].smooth)
      other = OnPlane{mesh.site_of[edge.a].position, mesh.patches[q].normal};
    of_curve[edge.curve] =
        other ? Projection<3>(OnBoth{of_patch[p], std::move(other)}) : of_patch[p];
  }
  return of_curve;
}

template std::vector<Projection<2>> projections_of_patches(const Mesh<2>&,
                                                           std::span<const SurfaceFunction>,
                                                           const Reach&);
template std::vector<Projection<3>> projections_of_patches(const Mesh<3>&,
                                                           std::span<const SurfaceFunction>,
                                                           const Reach&);

}  // namespace ductile::meshadapt
