#include "ductile/meshadapt/geometry.hpp"

#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/reference_surface.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
std::shared_ptr<const ReferenceSurface<Dim>> reference_surface(const runtime::Executor& executor,
                                                               const AnyMesh& any,
                                                               const GeometryOptions& options) {
  MakeMeshOptions make;
  make.hausdorff_tolerance = options.tolerance;
  make.ridge_angle = options.ridge_angle;
  make.complete_boundary = options.complete_boundary;
  make.functions = options.functions;
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const Mesh<Dim> mesh = make_mesh<Dim>(executor, any, make, neighbours, warnings);
  auto reference = std::make_shared<ReferenceSurface<Dim>>();
  reference->surface = mesh.surface;
  for (const Patch<Dim>& patch : mesh.patches) {
    reference->is_smooth.push_back(patch.smooth ? 1 : 0);
    reference->reference_of.push_back(patch.reference);
  }
  for (const Curve& curve : mesh.curves) reference->reference_of_curve.push_back(curve.reference);
  return reference;
}

template <int Dim>
std::optional<GeometryPoint> closest_in(const ReferenceSurface<Dim>& reference,
                                        const std::array<double, 3>& point, double reach) {
  if (!reference.surface) return {};
  Vector<Dim> from;
  for (int i = 0; i < Dim; ++i) from[i] = point[static_cast<std::size_t>(i)];
  const auto found = reference.surface->facets.nearest(from, reach);
  if (!found) return {};
  GeometryPoint result{{}, {}, reference.reference_of[found->sheet]};
  for (int i = 0; i < Dim; ++i) {
    result.position[static_cast<std::size_t>(i)] = found->point[i];
    result.normal[static_cast<std::size_t>(i)] = found->direction[i];
  }
  return result;
}

}  // namespace

Geometry::Geometry(const runtime::Executor& executor, const AnyMesh& mesh,
                   const GeometryOptions& options)
    : tolerance_(options.tolerance) {
  if (!(options.tolerance > 0))
    throw InputError("tolerance of a geometry: expected a length above 0, found " +
                     number(options.tolerance));
  if (mesh.dimension == 2)
    plane_ = reference_surface<2>(executor, mesh, options);
  else
    space_ = reference_surface<3>(executor, mesh, options);
}

std::optional<GeometryPoint> Geometry::closest(const std::array<double, 3>& point,
                                               double reach) const {
  return plane_ ? closest_in(*plane_, point, reach) : closest_in(*space_, point, reach);
}

}  // namespace ductile::meshadapt
