#include "ductile/meshadapt/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/first_bad.hpp"
#include "mesh/wording.hpp"
#include "transfer/projection.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// Throws unless all coordinates are so small that squares of distances are numbers; `what` has
/// them.
void expect_places(const Executor& executor, std::span<const double> coordinates, int dimension,
                   const char* what) {
  const std::size_t bad = first_bad(executor, coordinates.size(), [&](std::size_t i) {
    return !(std::abs(coordinates[i]) <= 1e150);
  });
  if (bad != no_index)
    refuse("expected coordinates from -1e150 to 1e150, found others at " +
           Wording("coordinates[" + std::to_string(bad) + "], " + what + " " +
                       std::to_string(bad / static_cast<std::size_t>(dimension)),
                   entity(what, bad / static_cast<std::size_t>(dimension))));
}

void expect_points(const Executor& executor, std::span<const double> coordinates, int dimension) {
  if (coordinates.size() % static_cast<std::size_t>(dimension) != 0)
    throw InputError("expected " + std::to_string(dimension) +
                     " coordinates for each point, found " + std::to_string(coordinates.size()) +
                     " in all");
  expect_places(executor, coordinates, dimension, "point");
}

/// The values at points; fills in how many are outside. coordinates[point * Dim + axis].
template <int Dim>
std::vector<double> interpolated(const Executor& executor, const Locator<Dim>& from,
                                 const Components& field, std::span<const double> coordinates,
                                 TransferReport& report) {
  const std::size_t point_count = coordinates.size() / Dim;
  std::vector<double> result(point_count * field.stride);
  std::vector<std::uint8_t> outside(point_count);
  walk_in_blocks(executor, point_count, [&](std::size_t i, ElementId near) {
    Vector<Dim> point;
    std::copy_n(&coordinates[i * Dim], Dim, point.x.begin());
    const Place<Dim> place = from.find(point, near);
    outside[i] = place.inside ? 0 : 1;
    evaluate(from.mesh(), field, place, &result[i * field.stride]);
    return place.element;
  });
  report.vertices_outside = runtime::parallel_reduce(
      executor, outside.size(), std::size_t{0}, [&](std::size_t i) { return outside[i]; },
      [](std::size_t a, std::size_t b) { return a + b; });
  return result;
}

template <int Dim>
TransferredField transfer(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                          const ProjectionOptions* projection) {
  expect_places(executor, from.mesh.coordinates, Dim, "old vertex");
  expect_places(executor, to.coordinates, Dim, "new vertex");
  const auto old_mesh = make_fixed_mesh<Dim>(executor, from.mesh);
  const auto new_mesh = make_fixed_mesh<Dim>(executor, to);
  const Locator<Dim> locator(executor, old_mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Dim, to.vertex_count(), from.field.types, {}, from.field.name};
  result.field.values = interpolated(executor, locator, field, to.coordinates, result.report);
  if (projection) {
    Projection<Dim> onto(executor, locator, field, new_mesh);
    result.field.values = onto.run(*projection);
    result.report.volume_outside = onto.volume_outside();
    result.report.volume_left_out = onto.volume_left_out();
  }
  return result;
}

template <int Dim>
TransferredField sample(const Executor& executor, const FieldOnMesh& from,
                        std::span<const double> coordinates) {
  expect_places(executor, from.mesh.coordinates, Dim, "vertex");
  const auto mesh = make_fixed_mesh<Dim>(executor, from.mesh);
  expect_points(executor, coordinates, Dim);
  const Locator<Dim> locator(executor, mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Dim, coordinates.size() / Dim, from.field.types, {}, from.field.name};
  result.field.values = interpolated(executor, locator, field, coordinates, result.report);
  return result;
}

TransferredField transfer_any(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                              const ProjectionOptions* projection) {
  expect_field_of(from.field, from.mesh);
  return from.mesh.dimension == 2 ? transfer<2>(executor, from, to, projection)
                                  : transfer<3>(executor, from, to, projection);
}

}  // namespace

TransferredField interpolate_field(const Executor& executor, const FieldOnMesh& from,
                                   const AnyMesh& to) {
  return transfer_any(executor, from, to, nullptr);
}

TransferredField interpolate_at(const Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates) {
  expect_field_of(from.field, from.mesh);
  return from.mesh.dimension == 2 ? sample<2>(executor, from, coordinates)
                                  : sample<3>(executor, from, coordinates);
}

TransferredField project_field(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                               const ProjectionOptions& options) {
  expect_finite(executor, from.field);
  return transfer_any(executor, from, to, &options);
}

}  // namespace ductile::meshadapt
