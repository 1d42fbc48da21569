/// @file
/// Adaptation: options, report, and the progress function.
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/level_set_sizes.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/sizes.hpp"

namespace ductile::python {

namespace {

using meshadapt::AdaptedMesh;
using meshadapt::AdaptOptions;
using meshadapt::AdaptProgress;
using meshadapt::AdaptReport;
using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::KernelReport;

/// True if a progress function wants to continue: it returned None or a value that is true in
/// Python.
bool is_true(const py::object& answer) {
  if (answer.is_none()) return true;
  const int truth = PyObject_IsTrue(answer.ptr());
  if (truth < 0) throw py::error_already_set();
  return truth == 1;
}

/// Called without the interpreter's lock after each step. Asks the progress function, if there is
/// one, whether to continue; raises KeyboardInterrupt if the user has pressed Ctrl-C. This takes
/// the lock, without a progress function at most 50 times a second.
class Progress {
 public:
  explicit Progress(py::object function) : function_(std::move(function)) {}

  bool operator()(const AdaptProgress& now) {
    const auto time = std::chrono::steady_clock::now();
    if (function_.is_none() && time - last_ < std::chrono::milliseconds(20)) return true;
    last_ = time;
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (function_.is_none()) return true;
    const py::object answer = function_(now.step, now.iteration, now.changes);
    return is_true(answer);
  }

 private:
  py::object function_;
  std::chrono::steady_clock::time_point last_;
};

/// Returns the result of adapt(executor, options), with Python's function as progress.
template <class Adapt>
py::tuple adapted_by(const AnyMesh& mesh, Adapt&& adapt, AdaptOptions options,
                     const runtime::ExecutorOptions& threads, const py::object& progress) {
  Progress asked(progress);
  options.progress = [&asked](const AdaptProgress& now) { return asked(now); };
  AdaptedMesh adapted = work(threads, [&](const runtime::Executor& executor) {
    AdaptedMesh result = adapt(executor, options);
    for (const std::string& loose : meshadapt::check_conformity(executor, mesh))
      result.report.warnings.push_back(
          loose + "; the mesh is not connected there" +
          (loose.find(" hangs: ") == std::string::npos ? " (joined() joins them)" : ""));
    return result;
  });
  return py::make_tuple(std::make_shared<AnyMesh>(std::move(adapted.mesh)),
                        array_of(std::move(adapted.metric)), std::move(adapted.report));
}

/// Without a metric, the mesh keeps its sizes, or gets those from curvature.
py::tuple remesh(const AnyMesh& mesh, const GivenMetric& metric, const AdaptOptions& given_options,
                 const runtime::ExecutorOptions& threads, const py::object& progress) {
  const auto given = metric_field(metric, mesh.dimension);
  const auto adapt = [&](const runtime::Executor& executor, const AdaptOptions& options) {
    const AnyField wanted =
        given ? meshadapt::metric_of(*given, mesh, {options.smallest_size, options.largest_size})
        : options.curved_sizes ? meshadapt::coarsest_metric(mesh, options.largest_size)
                               : meshadapt::default_metric(executor, mesh);
    return meshadapt::adapt(executor, mesh, wanted, options);
  };
  return adapted_by(mesh, adapt, given_options, threads, progress);
}

py::tuple remesh_to_sizes(const AnyMesh& mesh, const meshadapt::Sizes& given,
                          const AdaptOptions& given_options,
                          const runtime::ExecutorOptions& threads, const py::object& progress) {
  const meshadapt::Sizes sizes = sizes_for(mesh, given);
  const auto adapt = [&](const runtime::Executor& executor, const AdaptOptions& options) {
    return meshadapt::adapt_to_sizes(executor, mesh, sizes, options);
  };
  return adapted_by(mesh, adapt, given_options, threads, progress);
}

/// Values of a Python function at points; takes the interpreter's lock.
std::vector<double> values_at(const py::function& function, std::span<const double> coordinates,
                              int dimension) {
  const py::gil_scoped_acquire locked;
  const auto points = signed_size(coordinates.size()) / dimension;
  const py::object values =
      function(take(std::vector(coordinates.begin(), coordinates.end()), {points, dimension}));
  return copied(values.cast<Given<double>>());
}

py::tuple refine_to_level_set(const AnyMesh& mesh, const GivenMetric& metric,
                              const py::function& function,
                              const meshadapt::LevelSetSizesOptions& sizes,
                              const runtime::ExecutorOptions& threads) {
  const auto given = metric_field(metric, mesh.dimension);
  const auto adapt = [&](const runtime::Executor& executor, const AdaptOptions& options) {
    const AnyField wanted =
        given ? meshadapt::metric_of(*given, mesh) : meshadapt::default_metric(executor, mesh);
    const auto at = [&](std::span<const double> coordinates) {
      return values_at(function, coordinates, mesh.dimension);
    };
    return meshadapt::refine_to_level_set(
        executor, mesh, wanted, at,
        {sizes.tolerance, sizes.smallest_size, sizes.most_passes, options});
  };
  return adapted_by(mesh, adapt, {}, threads, py::none());
}

void bind_options(py::module_& module) {
  py::class_<AdaptOptions>(module, "Options")
      .def(py::init<>())
      .def_readwrite("iterations", &AdaptOptions::iterations)
      .def_readwrite("smallest_size", &AdaptOptions::smallest_size)
      .def_readwrite("largest_size", &AdaptOptions::largest_size)
      .def_readwrite("gradation", &AdaptOptions::gradation)
      .def_readwrite("curved_sizes", &AdaptOptions::curved_sizes)
      .def_readwrite("required_gradation", &AdaptOptions::required_gradation)
      .def_readwrite("memory_limit", &AdaptOptions::memory_limit)
      .def_readwrite("thorough", &AdaptOptions::thorough)
      .def_readwrite("move", &AdaptOptions::move)
      .def_readwrite("swap", &AdaptOptions::swap)
      .def_readwrite("insert", &AdaptOptions::insert)
      .def_property(
          "lock_boundary", [](const AdaptOptions& o) { return o.make.lock_boundary; },
          [](AdaptOptions& o, bool lock) { o.make.lock_boundary = lock; })
      .def_property(
          "hausdorff_tolerance", [](const AdaptOptions& o) { return o.make.hausdorff_tolerance; },
          [](AdaptOptions& o, double tolerance) { o.make.hausdorff_tolerance = tolerance; })
      .def_property(
          "geometry", [](const AdaptOptions& o) { return o.make.geometry; },
          [](AdaptOptions& o, std::shared_ptr<meshadapt::Geometry> geometry) {
            o.make.geometry = std::move(geometry);
          })
      .def_property(
          "ridge_angle", [](const AdaptOptions& o) { return o.make.ridge_angle; },
          [](AdaptOptions& o, double angle) { o.make.ridge_angle = angle; });
}

void bind_report(py::module_& module) {
  py::class_<KernelReport>(module, "KernelReport")
      .def_readonly("seconds", &KernelReport::seconds)
      .def_readonly("considered", &KernelReport::considered)
      .def_readonly("applied", &KernelReport::applied)
      .def_readonly("rounds", &KernelReport::rounds);
  py::class_<AdaptReport> report(
      module, "Report", "How an adaptation went: rounds, seconds, what was done, warnings.");
  py::list names;
  for (const auto& [name, kernel] : meshadapt::kernels) {
    report.def_readonly(name, kernel);
    names.append(name);
  }
  report.attr("kernels") = py::tuple(names);
  report.def_readonly("iterations", &AdaptReport::iterations)
      .def_readonly("converged", &AdaptReport::converged)
      .def_readonly("setup_seconds", &AdaptReport::setup_seconds)
      .def_readonly("renumber_seconds", &AdaptReport::renumber_seconds)
      .def_readonly("total_seconds", &AdaptReport::total_seconds)
      .def_readonly("fixed_vertices", &AdaptReport::fixed_vertices)
      .def_readonly("curved_edges", &AdaptReport::curved_edges)
      .def_readonly("curved_edges_short", &AdaptReport::curved_edges_short)
      .def_readonly("held_long_edges", &AdaptReport::held_long_edges)
      .def_readonly("held_short_edges", &AdaptReport::held_short_edges)
      .def_readonly("attempts", &AdaptReport::attempts)
      .def_readonly("warnings", &AdaptReport::warnings)
      .def_readonly("instructions", &AdaptReport::instructions);
}

}  // namespace

void bind_adapt(py::module_& module) {
  bind_options(module);
  bind_report(module);
  module.def("remesh", &remesh);
  module.def("remesh_to_sizes", &remesh_to_sizes);
  module.def("refine_to_level_set",
             [](const AnyMesh& mesh, const GivenMetric& metric, const py::function& function,
                double tolerance, double smallest, const runtime::ExecutorOptions& threads) {
               return refine_to_level_set(
                   mesh, metric, function,
                   {.tolerance = tolerance, .smallest_size = smallest, .most_passes = 10}, threads);
             });
}

}  // namespace ductile::python
