#include "ductile/meshadapt/transfer.hpp"

#include <numeric>

#include "ductile/meshadapt/metric_field.hpp"
#include "transfer/projection.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The values at the vertices of the new mesh; fills in how many are outside.
template <int Dim>
std::vector<double> interpolated(const Executor& executor, const Locator<Dim>& from,
                                 const Components& field, const FixedMesh<Dim>& to,
                                 TransferReport& report) {
  std::vector<double> result(to.vertex_count() * field.stride);
  std::vector<std::uint8_t> outside(to.vertex_count());
  walk_in_blocks(executor, to.vertex_count(), [&](std::size_t v, ElementId near) {
    const Place<Dim> place = from.find(to.position_of[v], near);
    outside[v] = place.inside ? 0 : 1;
    evaluate(from.mesh(), field, place, &result[v * field.stride]);
    return place.element;
  });
  report.vertices_outside = runtime::parallel_reduce(
      executor, outside.size(), std::size_t{0}, [&](std::size_t v) { return outside[v]; },
      [](std::size_t a, std::size_t b) { return a + b; });
  return result;
}

template <int Dim>
TransferredField transfer(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                          const ProjectionOptions* projection) {
  const auto old_mesh = make_fixed_mesh<Dim>(executor, from.mesh);
  const auto new_mesh = make_fixed_mesh<Dim>(executor, to);
  const Locator<Dim> locator(executor, old_mesh);
  const Components field{from.field.values, stride_of(from.field)};
  TransferredField result;
  result.field = {Dim, to.vertex_count(), from.field.types, {}, from.field.name};
  result.field.values = interpolated(executor, locator, field, new_mesh, result.report);
  if (projection) {
    Projection<Dim> onto(executor, locator, field, new_mesh);
    result.field.values = onto.run(*projection);
    result.report.volume_outside = onto.volume_outside();
    result.report.volume_left_out = onto.volume_left_out();
  }
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

TransferredField project_field(const Executor& executor, const FieldOnMesh& from, const AnyMesh& to,
                               const ProjectionOptions& options) {
  return transfer_any(executor, from, to, &options);
}

}  // namespace ductile::meshadapt
