#include "parts_geometry.hpp"

#include "adapt_part.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "migrate.hpp"

namespace ductile::petsc {

std::shared_ptr<const meshadapt::Geometry> geometry_of_parts(
    const Communicator& comm, const runtime::Executor& executor, const Part& part,
    const meshadapt::MakeMeshOptions& make) {
  Part whole = comm.on_all([&] {
    Part own = part;
    own.wanted = meshadapt::constant_metric(own.mesh, 1);  // which goes with vertices
    return own;
  });
  if (comm.size() > 1)
    whole = part.mesh.dimension == 2 ? gather_everywhere<2>(comm, executor, whole)
                                     : gather_everywhere<3>(comm, executor, whole);
  return comm.on_all([&] {
    list_boundary(executor, whole);
    for (VertexId v = 0; v < whole.mesh.vertex_count(); ++v)
      if (whole.mesh.vertex_reference[v] != unlabelled) whole.mesh.required_vertices.push_back(v);
    return std::make_shared<const meshadapt::Geometry>(
        executor, whole.mesh,
        meshadapt::GeometryOptions{.tolerance = make.hausdorff_tolerance,
                                   .ridge_angle = make.ridge_angle,
                                   .functions = make.functions,
                                   .in_parts = true});
  });
}

bool bounds_curved_sizes(const meshadapt::AdaptOptions& options) {
  return options.make.hausdorff_tolerance > 0 && (options.gradation > 0 || options.curved_sizes);
}

double growth_of(const meshadapt::AdaptOptions& options) {
  constexpr double from_curves = 1.3;
  if (options.curved_sizes && options.gradation == 0) return from_curves;
  return options.gradation > 0 ? options.gradation : 0;
}

}  // namespace ductile::petsc
