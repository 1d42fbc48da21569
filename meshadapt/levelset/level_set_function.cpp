#include "ductile/meshadapt/level_set_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "levelset/quadratic_blend.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

std::vector<double> minus(const Executor& executor, const AnyMesh& mesh,
                          std::span<const double> values, double level) {
  expect_at_each_vertex("level set: expected a value", mesh.vertex_count(), values.size());
  std::vector<double> result(values.begin(), values.end());
  for (double& value : result) value -= level;
  const std::size_t bad =
      first_bad(executor, result.size(), [&](std::size_t v) { return !std::isfinite(result[v]); });
  if (bad != no_index)
    refuse("level set: expected finite numbers, found " + number(result[bad]) + " at " +
           Wording("values[" + std::to_string(bad) + "]", "vertex " + std::to_string(bad + 1)));
  return result;
}

template <int Dim>
std::shared_ptr<const QuadraticBlend<Dim>> blend_of(const Executor& executor, const AnyMesh& mesh,
                                                    std::vector<double> value_of) {
  return std::make_shared<const QuadraticBlend<Dim>>(executor, make_fixed_mesh<Dim>(executor, mesh),
                                                     std::move(value_of));
}

template <int Dim>
std::vector<double> values_at(const Executor& executor, const QuadraticBlend<Dim>& blend,
                              std::span<const double> coordinates) {
  if (coordinates.size() % Dim != 0)
    throw InputError("coordinates: expected " + std::to_string(Dim) + " for each point, found " +
                     std::to_string(coordinates.size()) + " numbers");
  std::vector<double> value_at(coordinates.size() / Dim);
  walk_in_blocks(executor, value_at.size(), [&](std::size_t i, ElementId near) {
    Vector<Dim> point;
    std::copy_n(&coordinates[i * Dim], Dim, point.x.begin());
    const auto sample = blend.at(point, near);
    value_at[i] = sample.value;
    return sample.element;
  });
  return value_at;
}

template <int Dim>
Vector<Dim> point_of(const std::array<double, 3>& from) {
  Vector<Dim> point;
  std::copy_n(from.begin(), Dim, point.x.begin());
  return point;
}

template <int Dim>
SurfaceFunction surface_of(std::shared_ptr<const QuadraticBlend<Dim>> blend, std::int32_t reference,
                           double within) {
  constexpr double share = Dim == 2 ? 0.25 : 0.4;
  const auto closest = [blend, within](const std::array<double, 3>& from) {
    std::array<double, 3> result{};
    const auto found = blend->closest(point_of<Dim>(from), within);
    if (!found) result.fill(std::nan(""));
    if (found) std::copy_n(found->x.begin(), Dim, result.begin());
    return result;
  };
  const auto sizes = [blend, within](const std::array<double, 3>& at) {
    std::array<double, 6> result{};
    const Metric<Dim> chords = blend->chords(point_of<Dim>(at), share * within);
    std::copy_n(chords.m.begin(), chords.m.size(), result.begin());
    return result;
  };
  return {reference, closest, true, sizes};
}

}  // namespace

LevelSetFunction::LevelSetFunction(const Executor& executor, const AnyMesh& mesh,
                                   std::span<const double> values, double level) {
  std::vector<double> value_of = minus(executor, mesh, values, level);
  runtime::with_team(executor, [&] {
    if (mesh.dimension == 2)
      plane_ = blend_of<2>(executor, mesh, std::move(value_of));
    else
      space_ = blend_of<3>(executor, mesh, std::move(value_of));
  });
}

std::vector<double> LevelSetFunction::at(const Executor& executor,
                                         std::span<const double> coordinates) const {
  return plane_ ? values_at(executor, *plane_, coordinates)
                : values_at(executor, *space_, coordinates);
}

SurfaceFunction LevelSetFunction::surface(std::int32_t reference, double within) const {
  return plane_ ? surface_of(plane_, reference, within) : surface_of(space_, reference, within);
}

}  // namespace ductile::meshadapt
