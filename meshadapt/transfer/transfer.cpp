#include "ductile/meshadapt/transfer.hpp"

#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/finite_values.hpp"
#include "transfer/conservative_transfer.hpp"
#include "transfer/places.hpp"
#include "transfer/surface_places.hpp"
#include "transfer/vertex_places.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

void expect_points(const Executor& executor, std::span<const double> coordinates, int dimension) {
  if (coordinates.size() % static_cast<std::size_t>(dimension) != 0)
    throw InputError("expected " + std::to_string(dimension) +
                     " coordinates for each point, found " + std::to_string(coordinates.size()) +
                     " in all");
  expect_places(executor, coordinates, dimension, "point");
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
  auto at_vertices = evaluate_at_vertices(executor, locator, field, to);
  result.field.values = std::move(at_vertices.values);
  result.report.vertices_outside = at_vertices.outside;
  if (projection) {
    const JoinParts whole;
    ConservativeTransfer<Dim> onto(executor, locator, field, new_mesh, whole);
    result.field.values = onto.run(*projection);
    result.report.volume_outside = onto.coverage().volume_outside;
    result.report.volume_left_out = onto.coverage().volume_left_out;
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
  auto at_points = evaluate_at(executor, locator, field, coordinates);
  result.field.values = std::move(at_points.values);
  result.report.vertices_outside = at_points.outside;
  return result;
}

TransferredField sample_surface(const Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates) {
  expect_places(executor, from.mesh.coordinates, 3, "vertex");
  expect_points(executor, coordinates, 3);
  const std::size_t count = coordinates.size() / 3;
  const SurfacePlaces places(executor, from.mesh);
  return {
      {3, count, from.field.types,
       places.interpolated(
           {from.field.values, stride_of(from.field)}, count,
           [&](std::size_t i) {
             return Vector<3>{{coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}};
           }),
       from.field.name},
      {}};
}

TransferredField transfer_any(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                              const ProjectionOptions* projection) {
  expect_field_of(from.field, from.mesh);
  if (is_surface(from.mesh)) {
    if (projection) refuse_projection();
    return sample_surface(executor, from, to.coordinates);
  }
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
  if (is_surface(from.mesh)) return sample_surface(executor, from, coordinates);
  return from.mesh.dimension == 2 ? sample<2>(executor, from, coordinates)
                                  : sample<3>(executor, from, coordinates);
}

TransferredField project_field(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                               const ProjectionOptions& options) {
  expect_finite(executor, from.field);
  return transfer_any(executor, from, to, &options);
}

}  // namespace ductile::meshadapt
