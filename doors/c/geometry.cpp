/// @file
/// Curved boundaries for ductile.h: a geometry, surfaces given by functions, and distances to
/// interfaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/signed_distance.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "handles.hpp"

struct ductile_geometry {
  std::shared_ptr<const ductile::meshadapt::Geometry> geometry;
  ductile::runtime::ExecutorOptions executor;
};

namespace ductile::c {

namespace {

using meshadapt::SurfaceFunction;
using Point = std::array<double, 3>;

SurfaceFunction function_of(int32_t reference, ductile_surface surface, void* context) {
  return {reference, [=](const Point& point) {
            Point closest{};
            if (surface(point.data(), closest.data(), context) != 0) return closest;
            throw meshadapt::Error("the function of the surface with the reference " +
                                   std::to_string(reference) + " has failed");
          }};
}

/// Writes the closest point, its normal and its reference; NaN and 0 if there is none within reach.
struct Closest {
  const ductile_geometry& geometry;
  double reach;
  double* positions;
  double* normals;
  int32_t* references;

  void write(std::size_t i, const double* points) const {
    const auto d = static_cast<std::size_t>(geometry.geometry->dimension());
    Point from{};
    std::copy_n(points + d * i, d, from.begin());
    const auto found = geometry.geometry->closest(from, reach);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < d; ++k) {
      positions[d * i + k] = found ? found->position[k] : nan;
      if (normals != nullptr) normals[d * i + k] = found ? found->normal[k] : nan;
    }
    if (references != nullptr) references[i] = found ? found->reference : 0;
  }
};

}  // namespace
}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

int ductile_options_set_surface(ductile_options* options, int32_t reference,
                                ductile_surface surface, void* context) {
  return c::guarded({{options, "options"}}, [&] {
    auto& functions = options->adapt.make.functions;
    std::erase_if(functions, [&](const auto& f) { return f.reference == reference; });
    if (surface != nullptr) functions.push_back(c::function_of(reference, surface, context));
  });
}

int ductile_geometry_create(const ductile_mesh* mesh, const ductile_options* options,
                            ductile_geometry** geometry) {
  return c::guarded({{mesh, "mesh"}, {options, "options"}, {geometry, "geometry"}}, [&] {
    const auto& make = options->adapt.make;
    const runtime::Executor executor(options->executor);
    auto made = std::make_unique<ductile_geometry>();
    made->executor = options->executor;
    made->geometry = std::make_shared<const meshadapt::Geometry>(
        executor, mesh->mesh,
        meshadapt::GeometryOptions{.tolerance = make.hausdorff_tolerance,
                                   .ridge_angle = make.ridge_angle,
                                   .complete_boundary = make.complete_boundary,
                                   .functions = make.functions});
    *geometry = made.release();
  });
}

void ductile_geometry_destroy(ductile_geometry* geometry) { delete geometry; }

int ductile_options_set_geometry(ductile_options* options, const ductile_geometry* geometry) {
  return c::guarded({{options, "options"}}, [&] {
    auto& make = options->adapt.make;
    make.geometry = geometry == nullptr ? nullptr : geometry->geometry;
    if (geometry == nullptr) return;
    make.hausdorff_tolerance = geometry->geometry->tolerance();
    make.functions.clear();
  });
}

int ductile_geometry_closest(const ductile_geometry* geometry, int64_t count, const double* points,
                             double reach, double* closest, double* normals, int32_t* references) {
  return c::guarded({{geometry, "geometry"}}, [&] {
    c::expect_array(points, count, "points");
    c::expect_array(closest, count, "closest");
    const auto n =
        static_cast<std::size_t>(count) * static_cast<std::size_t>(geometry->geometry->dimension());
    if (!std::all_of(points, points + n, [](double x) { return std::isfinite(x); }))
      throw meshadapt::InputError("points: expected finite coordinates");
    if (!(reach > 0))
      throw meshadapt::InputError("reach: expected a distance above 0, found " + c::number(reach));
    const c::Closest all{*geometry, reach, closest, normals, references};
    const runtime::Executor executor(geometry->executor);
    runtime::parallel_for(executor, static_cast<std::size_t>(count),
                          [&](std::size_t i) { all.write(i, points); });
  });
}

int ductile_signed_distance(const ductile_mesh* mesh, const ductile_options* options,
                            int64_t reference_count, const int32_t* references, int64_t count,
                            const double* points, double* distances) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    c::expect_array(references, reference_count, "references");
    c::expect_array(distances, count, "distances");
    const meshadapt::AnyMesh& any = mesh->mesh;
    if (points == nullptr && count != static_cast<int64_t>(any.vertex_count()))
      throw meshadapt::InputError("count: expected the number of vertices, " +
                                  std::to_string(any.vertex_count()) +
                                  ", because there are no "
                                  "points; found " +
                                  std::to_string(count));
    const ductile_options& given = c::or_defaults(options);
    const auto values = static_cast<std::size_t>(count * any.dimension);
    const std::span<const double> at(points, points != nullptr ? values : 0);
    const auto found =
        meshadapt::signed_distance(runtime::Executor(given.executor), any,
                                   {.inside = {references, references + reference_count},
                                    .tolerance = given.adapt.make.hausdorff_tolerance,
                                    .ridge_angle = given.adapt.make.ridge_angle},
                                   at);
    std::copy(found.begin(), found.end(), distances);
  });
}

}  // extern "C"
