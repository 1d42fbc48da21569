/// @file
/// Geometry: a smooth model of curved boundaries, made once and passed to every adaptation; and
/// distances to interfaces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bindings.hpp"

#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/signed_distance.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::python {

namespace {

using meshadapt::Geometry;
using meshadapt::GeometryPoint;

/// Wraps a Python function so that C++ can call it on any thread: each call takes the interpreter's
/// lock. The function is released, also under the lock, with the last geometry that uses it.
meshadapt::SurfaceFunction surface_function(std::int32_t reference, py::function given) {
  const std::shared_ptr<py::function> function(new py::function(std::move(given)),
                                               [](py::function* old) {
                                                 const py::gil_scoped_acquire locked;
                                                 delete old;
                                               });
  return {reference, [function](const std::array<double, 3>& point) {
            const py::gil_scoped_acquire locked;
            return (*function)(point).cast<std::array<double, 3>>();
          }};
}

std::shared_ptr<Geometry> make_geometry(
    const meshadapt::AnyMesh& mesh, double tolerance, double ridge_angle,
    const std::vector<std::pair<std::int32_t, py::function>>& surfaces,
    const runtime::ExecutorOptions& threads) {
  std::vector<meshadapt::SurfaceFunction> functions;
  for (const auto& [reference, function] : surfaces)
    functions.push_back(surface_function(reference, function));
  return work(threads, [&](const runtime::Executor& executor) {
    return std::make_shared<Geometry>(
        executor, mesh,
        meshadapt::GeometryOptions{
            .tolerance = tolerance, .ridge_angle = ridge_angle, .functions = functions});
  });
}

/// Positions, normals and references of the closest points; NaN and 0 if none is within reach.
py::tuple closest(const Geometry& geometry, const Given<double>& points, double reach,
                  const runtime::ExecutorOptions& threads) {
  const auto d = static_cast<std::size_t>(geometry.dimension());
  const auto n = static_cast<std::size_t>(points.shape(0));
  std::vector<double> positions(n * d, std::nan("")), normals(n * d, std::nan(""));
  std::vector<std::int32_t> references(n);
  const double* const given = points.data();
  work(threads, [&](const runtime::Executor& executor) {
    runtime::parallel_for(executor, n, [&](std::size_t i) {
      std::array<double, 3> point{};
      std::copy_n(given + d * i, d, point.begin());
      const std::optional<GeometryPoint> found = geometry.closest(point, reach);
      if (!found) return;
      std::copy_n(found->position.begin(), d, &positions[d * i]);
      std::copy_n(found->normal.begin(), d, &normals[d * i]);
      references[i] = found->reference;
    });
    return 0;
  });
  const Shape shape{signed_size(n), signed_size(d)};
  return py::make_tuple(take(std::move(positions), shape), take(std::move(normals), shape),
                        take(std::move(references)));
}

/// At points, or at the vertices if there are none.
py::array signed_distance(const meshadapt::AnyMesh& mesh,
                          const meshadapt::SignedDistanceOptions& options,
                          const std::optional<Given<double>>& points,
                          const runtime::ExecutorOptions& threads) {
  std::span<const double> at;
  if (points) at = {points->data(), static_cast<std::size_t>(points->size())};
  return take(work(threads, [&](const runtime::Executor& executor) {
    return meshadapt::signed_distance(executor, mesh, options, at);
  }));
}

}  // namespace

void bind_geometry(py::module_& module) {
  py::class_<Geometry, std::shared_ptr<Geometry>>(module, "GeometryData")
      .def(py::init(&make_geometry))
      .def_property_readonly("dimension", &Geometry::dimension)
      .def_property_readonly("tolerance", &Geometry::tolerance)
      .def("closest", &closest);
  module.def("signed_distance", [](const meshadapt::AnyMesh& mesh, std::vector<std::int32_t> inside,
                                   double tolerance, double ridge_angle,
                                   const std::optional<Given<double>>& points,
                                   const runtime::ExecutorOptions& threads) {
    return signed_distance(mesh, {std::move(inside), tolerance, ridge_angle}, points, threads);
  });
}

}  // namespace ductile::python
