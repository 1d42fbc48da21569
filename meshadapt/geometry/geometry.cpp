#include "ductile/meshadapt/geometry.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "geometry/curvature.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/reference_surface.hpp"
#include "geometry/surface_mesh.hpp"

namespace ductile::meshadapt {

namespace {

MakeMeshOptions options_of(const GeometryOptions& options) {
  MakeMeshOptions make;
  make.hausdorff_tolerance = options.tolerance;
  make.ridge_angle = options.ridge_angle;
  make.complete_boundary = options.complete_boundary;
  make.functions = options.functions;
  return make;
}

template <int Dim>
std::shared_ptr<const ReferenceSurface<Dim>> reference_of(
    std::shared_ptr<const Surface<Dim>> surface, bool in_parts,
    const std::vector<Patch<Dim>>& patches, const std::vector<Curve>& curves) {
  auto reference = std::make_shared<ReferenceSurface<Dim>>();
  reference->surface = std::move(surface);
  reference->in_parts = in_parts;
  for (const Patch<Dim>& patch : patches) {
    reference->is_smooth.push_back(patch.smooth ? 1 : 0);
    reference->reference_of.push_back(patch.reference);
  }
  for (const Curve& curve : curves) reference->reference_of_curve.push_back(curve.reference);
  return reference;
}

template <int Dim>
std::shared_ptr<const ReferenceSurface<Dim>> reference_surface(const runtime::Executor& executor,
                                                               const AnyMesh& any,
                                                               const GeometryOptions& options) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const Mesh<Dim> mesh =
      (options.in_parts ? make_cut_mesh<Dim> : make_mesh<Dim>)(executor, any, options_of(options),
                                                               neighbours, warnings);
  return reference_of(mesh.surface, options.in_parts, mesh.patches, mesh.curves);
}

/// The same of triangles in space.
std::shared_ptr<const ReferenceSurface<3>> reference_of_triangles(const runtime::Executor& executor,
                                                                  const AnyMesh& any,
                                                                  const GeometryOptions& options) {
  Neighbours<2> neighbours;
  std::vector<std::string> warnings;
  const auto mesh = make_surface_mesh(executor, any, options_of(options), neighbours, warnings);
  return reference_of(mesh.surface, options.in_parts, mesh.regions, mesh.patches);
}

template <int Dim>
std::optional<GeometryPoint> closest_in(const ReferenceSurface<Dim>& reference,
                                        const std::array<double, 3>& point, double reach) {
  if (!reference.surface) return {};
  Vector<Dim> from;
  std::copy_n(point.begin(), Dim, from.x.begin());
  const auto found = reference.surface->facets.nearest(from, reach);
  if (!found) return {};
  GeometryPoint result{{}, {}, reference.reference_of[found->sheet]};
  std::ranges::copy(found->point.x, result.position.begin());
  std::ranges::copy(found->direction.x, result.normal.begin());
  return result;
}

template <int Dim>
AnyField bounded_at_curves(const runtime::Executor& executor, const AnyMesh& any,
                           const AnyField& metric, const AdaptOptions& options) {
  const SizeBounds bounds{options.smallest_size, options.largest_size};
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const Mesh<Dim> mesh = make_mesh<Dim>(executor, any, options.make, neighbours, warnings);
  if (!mesh.surface) return metric;
  std::vector<Metric<Dim>> metric_of = tensors_of<Dim>(executor, metric);
  bound_sizes(executor, metric_of, bounds);
  bound_curved_sizes(executor, mesh, options.make.hausdorff_tolerance, metric_of);
  bound_sizes(executor, metric_of, bounds);
  return symmetric_field(executor, metric_of, metric.name);
}

}  // namespace

AnyField bound_at_curved_boundaries(const runtime::Executor& executor, const AnyMesh& mesh,
                                    const AnyField& metric, const AdaptOptions& options) {
  return mesh.dimension == 2 ? bounded_at_curves<2>(executor, mesh, metric, options)
                             : bounded_at_curves<3>(executor, mesh, metric, options);
}

Geometry::Geometry(const runtime::Executor& executor, const AnyMesh& mesh,
                   const GeometryOptions& options)
    : tolerance_(options.tolerance) {
  if (!(options.tolerance > 0))
    throw InputError("tolerance of a geometry: expected a length above 0, found " +
                     number(options.tolerance));
  if (mesh.dimension == 2)
    plane_ = reference_surface<2>(executor, mesh, options);
  else
    space_ = is_surface(mesh) ? reference_of_triangles(executor, mesh, options)
                              : reference_surface<3>(executor, mesh, options);
}

std::optional<GeometryPoint> Geometry::closest(const std::array<double, 3>& point,
                                               double reach) const {
  return plane_ ? closest_in(*plane_, point, reach) : closest_in(*space_, point, reach);
}

}  // namespace ductile::meshadapt
