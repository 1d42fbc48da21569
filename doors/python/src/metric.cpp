/// @file
/// Metrics: of solutions, of meshes and of sizes, and operations on them. In Python a metric is an
/// array with a symmetric tensor in each row, in the order of AnyField.
#include <string>
#include <utility>

#include "bindings.hpp"

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/sizes.hpp"

namespace ductile::python {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Metric;
using meshadapt::SizeBounds;
using meshadapt::Sizes;
using meshadapt::Vector;
using runtime::Executor;
using runtime::ExecutorOptions;

// ---- Metrics of solutions and meshes ----

py::tuple solution_metric(const AnyMesh& mesh, const Given<double>& values,
                          const meshadapt::SolutionMetricOptions& options,
                          const ExecutorOptions& threads) {
  AnyField field = field_of(values, AnyField::Type::scalar, mesh.dimension, "u");
  field.types.assign(static_cast<std::size_t>(values.shape(1)), AnyField::Type::scalar);
  auto found = work(threads, [&](const Executor& executor) {
    return meshadapt::solution_metric(executor, mesh, field, options);
  });
  return py::make_tuple(array_of(std::move(found.metric)), found.fit);
}

void bind_solution_metric(py::module_& module) {
  using meshadapt::MetricFit;
  using meshadapt::SolutionMetricOptions;
  py::class_<MetricFit>(module, "MetricFit")
      .def_readonly("complexity", &MetricFit::complexity)
      .def_readonly("error", &MetricFit::error)
      .def_readonly("reached", &MetricFit::reached);
  py::class_<SizeBounds>(module, "SizeBounds")
      .def(py::init<double, double, double>(), py::arg("smallest") = 0., py::arg("largest") = 0.,
           py::arg("anisotropy") = 0.);
  py::class_<SolutionMetricOptions>(module, "SolutionMetricOptions")
      .def(py::init([](double norm, double complexity, double elements, double error,
                       const SizeBounds& bounds, double gradation, bool projection) {
             return SolutionMetricOptions{.goal = {norm, complexity, elements, error, bounds},
                                          .gradation = gradation,
                                          .recovery = projection
                                                          ? meshadapt::Recovery::double_projection
                                                          : meshadapt::Recovery::least_squares};
           }),
           py::kw_only(), py::arg("norm"), py::arg("complexity"), py::arg("elements"),
           py::arg("error"), py::arg("bounds"), py::arg("gradation"), py::arg("projection"));
  module.def("solution_metric", &solution_metric);
  module.def("implied", [](const AnyMesh& mesh) {
    return array_of(work(
        {}, [&](const Executor& executor) { return meshadapt::implied_tensors(executor, mesh); }));
  });
  module.def("default_metric", [](const AnyMesh& mesh) {
    return array_of(work(
        {}, [&](const Executor& executor) { return meshadapt::default_metric(executor, mesh); }));
  });
}

// ---- Operations on metrics ----

AnyField tensors(const Given<double>& rows, int dimension, const char* name) {
  return field_of(rows, AnyField::Type::symmetric, dimension, name);
}

/// Copies the rows of an array to tensors, calls change(executor, tensors), and returns them as
/// rows.
template <int Dim, class Change>
py::array changed(const AnyField& given, Change&& change) {
  return array_of(work({}, [&](const Executor& executor) {
    auto metric_of = meshadapt::tensors_of<Dim>(executor, given);
    change(executor, metric_of);
    return meshadapt::symmetric_field<Dim>(executor, metric_of, given.name);
  }));
}
template <class Change>
py::array changed(const Given<double>& rows, Change&& change) {
  const int dimension = rows.shape(1) == 3 ? 2 : 3;
  const AnyField given = tensors(rows, dimension, "metric");
  return dimension == 2 ? changed<2>(given, change) : changed<3>(given, change);
}

template <int Dim>
void intersect_with(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                    const AnyField& other) {
  meshadapt::intersect<Dim>(executor, metric_of, meshadapt::tensors_of<Dim>(executor, other));
}

template <int Dim>
void limit_gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                     const AnyMesh& mesh, double factor) {
  const meshadapt::GradationOptions options{.factor = factor};
  if constexpr (Dim == 3)
    if (is_surface(mesh)) {
      meshadapt::limit_gradation(executor, metric_of,
                                 meshadapt::make_fixed_mesh<2, 3>(executor, mesh), options);
      return;
    }
  meshadapt::limit_gradation(executor, metric_of, meshadapt::make_fixed_mesh<Dim>(executor, mesh),
                             options);
}

void bind_operations(py::module_& module) {
  module.def("intersect", [](const Given<double>& a, const Given<double>& b) {
    const AnyField other = tensors(b, b.shape(1) == 3 ? 2 : 3, "B");
    return changed(a, [&]<int Dim>(const Executor& executor, std::vector<Metric<Dim>>& metric_of) {
      intersect_with(executor, metric_of, other);
    });
  });
  module.def("bound", [](const Given<double>& a, const SizeBounds& bounds) {
    return changed(a, [&](const Executor& executor, auto& metric_of) {
      meshadapt::bound_sizes(executor, metric_of, bounds);
    });
  });
  module.def("grade", [](const AnyMesh& mesh, const Given<double>& a, double factor) {
    return changed(a, [&]<int Dim>(const Executor& executor, std::vector<Metric<Dim>>& metric_of) {
      limit_gradation(executor, metric_of, mesh, factor);
    });
  });
  module.def("as_metric", [](const AnyMesh& mesh, const Given<double>& rows, AnyField::Type type,
                             const SizeBounds& bounds) {
    return array_of(
        meshadapt::metric_of(field_of(rows, type, mesh.dimension, "metric"), mesh, bounds));
  });
}

// ---- Sizes ----

/// Dimensions that depend on the mesh: that of its facets, and that of its cells.
constexpr int of_facets = -1, of_cells = -2;

AnyField sizes_at(const AnyMesh& mesh, const Sizes& given, const ExecutorOptions& threads) {
  const Sizes sizes = sizes_for(mesh, given);
  return work(threads, [&](const Executor& executor) {
    return meshadapt::size_field(executor, mesh, sizes);
  });
}

std::vector<Vector<3>> points_of(const Given<double>& points) {
  std::vector<Vector<3>> result;
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    result.push_back({{points.at(i, 0), points.at(i, 1), points.at(i, 2)}});
  return result;
}

meshadapt::TriangleSurface surface_of(const Given<double>& points,
                                      const Given<std::int32_t>& triangles) {
  meshadapt::TriangleSurface surface{points_of(points), {}};
  for (py::ssize_t i = 0; i < triangles.shape(0); ++i)
    surface.triangles.push_back({static_cast<std::uint32_t>(triangles.at(i, 0)),
                                 static_cast<std::uint32_t>(triangles.at(i, 1)),
                                 static_cast<std::uint32_t>(triangles.at(i, 2))});
  return surface;
}

void bind_sizes(py::module_& module) {
  using meshadapt::SizeGrowth;
  using Size = double;
  py::class_<SizeGrowth>(module, "SizeGrowth")
      .def(py::init<double, double, double>(), py::arg("grow"), py::arg("largest"),
           py::arg("distance"));
  py::class_<Sizes>(module, "Sizes")
      .def(py::init([](double elsewhere, const SizeBounds& bounds) {
        return Sizes{.elsewhere = elsewhere, .bounds = bounds};
      }))
      .def_property_readonly("count", [](const Sizes& sizes) { return sizes.sources.size(); })
      .def("ball",
           [](Sizes& sizes, const std::array<double, 3>& centre, double radius, Size size,
              const SizeGrowth& growth) {
             sizes.add(meshadapt::Ball{{centre}, radius}, size, growth);
           })
      .def("box",
           [](Sizes& sizes, const std::array<double, 3>& low, const std::array<double, 3>& high,
              Size size, const SizeGrowth& growth) {
             sizes.add(meshadapt::AxisBox{{low}, {high}}, size, growth);
           })
      .def("curve",
           [](Sizes& sizes, const Given<double>& points, Size size, const SizeGrowth& growth) {
             sizes.add(meshadapt::Polyline{points_of(points)}, size, growth);
           })
      .def("surface",
           [](Sizes& sizes, const Given<double>& points, const Given<std::int32_t>& triangles,
              Size size,
              const SizeGrowth& growth) { sizes.add(surface_of(points, triangles), size, growth); })
      .def("referenced",
           [](Sizes& sizes, int dimension, std::int32_t reference, Size size,
              const SizeGrowth& growth) {
             sizes.add(meshadapt::Referenced{dimension, reference}, size, growth);
           })
      .def("named",
           [](Sizes& sizes, const std::string& name, Size size, const SizeGrowth& growth) {
             sizes.add(meshadapt::Named{name}, size, growth);
           })
      .def("at", [](const Sizes& sizes, const AnyMesh& mesh, const ExecutorOptions& threads) {
        return take(std::move(sizes_at(mesh, sizes, threads).values));
      });
  module.attr("of_facets") = of_facets;
  module.attr("of_cells") = of_cells;
}

}  // namespace

meshadapt::Sizes sizes_for(const meshadapt::AnyMesh& mesh, meshadapt::Sizes sizes) {
  for (meshadapt::SizeSource& source : sizes.sources)
    if (auto* const referenced = std::get_if<meshadapt::Referenced>(&source.place)) {
      if (referenced->dimension == of_facets) referenced->dimension = element_dimension(mesh) - 1;
      if (referenced->dimension == of_cells) referenced->dimension = element_dimension(mesh);
    }
  return sizes;
}

void bind_metric(py::module_& module) {
  bind_solution_metric(module);
  bind_operations(module);
  bind_sizes(module);
}

}  // namespace ductile::python
