#include "ductile/meshadapt/transfer.hpp"

#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/finite_values.hpp"
#include "transfer/conservative_transfer.hpp"
#include "transfer/places.hpp"
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

template <int Dim, int Space = Dim>
TransferredField transfer(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                          const ProjectionOptions* projection) {
  expect_places(executor, from.mesh.coordinates, Space, "old vertex");
  expect_places(executor, to.coordinates, Space, "new vertex");
  const auto old_mesh = make_fixed_mesh<Dim, Space>(executor, from.mesh);
  const auto new_mesh = make_fixed_mesh<Dim, Space>(executor, to);
  const Locator<Dim, Space> locator(executor, old_mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Space, to.vertex_count(), from.field.types, {}, from.field.name};
  auto at_vertices = evaluate_at_vertices(executor, locator, field, to);
  result.field.values = std::move(at_vertices.values);
  result.report.vertices_outside = at_vertices.outside;
  if (!projection) return result;
  if constexpr (Dim < Space) {
    refuse_projection();
  } else {
    const JoinParts whole;
    ConservativeTransfer<Dim> onto(executor, locator, field, new_mesh, whole);
    result.field.values = onto.run(*projection);
    result.report.volume_outside = onto.coverage().volume_outside;
    result.report.volume_left_out = onto.coverage().volume_left_out;
  }
  return result;
}

template <int Dim, int Space = Dim>
TransferredField sample(const Executor& executor, const FieldOnMesh& from,
                        std::span<const double> coordinates) {
  expect_places(executor, from.mesh.coordinates, Space, "vertex");
  const auto mesh = make_fixed_mesh<Dim, Space>(executor, from.mesh);
  expect_points(executor, coordinates, Space);
  const Locator<Dim, Space> locator(executor, mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Space, coordinates.size() / Space, from.field.types, {}, from.field.name};
  auto at_points = evaluate_at(executor, locator, field, coordinates);
  result.field.values = std::move(at_points.values);
  result.report.vertices_outside = at_points.outside;
  return result;
}

TransferredField transfer_any(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                              const ProjectionOptions* projection) {
  expect_field_of(from.field, from.mesh);
  if (is_surface(from.mesh)) return transfer<2, 3>(executor, from, to, projection);
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
  if (is_surface(from.mesh)) return sample<2, 3>(executor, from, coordinates);
  return from.mesh.dimension == 2 ? sample<2>(executor, from, coordinates)
                                  : sample<3>(executor, from, coordinates);
}

TransferredField project_field(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                               const ProjectionOptions& options) {
  expect_finite(executor, from.field);
  return transfer_any(executor, from, to, &options);
}

}  // namespace ductile::meshadapt
