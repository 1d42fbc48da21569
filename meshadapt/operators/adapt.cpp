#include "ductile/meshadapt/adapt.hpp"

#include "ductile/meshadapt/error.hpp"
#include "operators/processor_level.hpp"

namespace ductile::meshadapt {

AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options) {
  if (metric.types != std::vector{AnyField::Type::symmetric} ||
      metric.dimension != mesh.dimension || metric.vertex_count != mesh.vertex_count())
    throw InputError(metric.name + ": expected one symmetric tensor for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices of " + mesh.name);
  if (mesh.dimension != 2 && mesh.dimension != 3)
    throw InputError(mesh.name + ": expected dimension 2 or 3, found " +
                     std::to_string(mesh.dimension));
  return adapt_at(usable_levels().front(), executor, mesh, metric, options);
}

}  // namespace ductile::meshadapt
