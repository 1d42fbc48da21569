/// @file
/// The module ductile._ductile: the C++ library, unchanged. The Python package around it checks and
/// converts arguments, and has the documentation.

#include "bindings.hpp"

#include "ductile/meshadapt/error.hpp"

namespace ductile::python {

namespace {

/// Registers the exceptions: InputError is an Error and a ValueError.
void bind_errors(py::module_& module) {
  auto& error = py::register_exception<meshadapt::Error>(module, "Error", PyExc_RuntimeError);
  auto& input = py::register_exception<meshadapt::InputError>(
      module, "InputError", py::make_tuple(error, py::handle(PyExc_ValueError)));
  auto& cancelled = py::register_exception<meshadapt::Cancelled>(module, "Cancelled", error);
  error.doc() = "Something outside failed: memory, the disk, a result that is not valid.";
  input.doc() = "An array, a file or an option is wrong; the text names it and the index.";
  cancelled.doc() = "The progress function has returned False; there is no result.";
}

void bind_executor(py::module_& module) {
  using runtime::ExecutorOptions;
  py::class_<ExecutorOptions>(module, "Executor")
      .def(py::init([](int threads) { return ExecutorOptions{.threads = threads}; }),
           py::arg("threads") = 0)
      .def_readonly("threads", &ExecutorOptions::threads);
}

}  // namespace
}  // namespace ductile::python

PYBIND11_MODULE(_ductile, module) {
  using namespace ductile::python;  // NOLINT: the macro defines a function of its own
  module.attr("version") = DUCTILE_VERSION;
  bind_errors(module);
  bind_executor(module);
  bind_mesh(module);
  bind_geometry(module);
  bind_adapt(module);
  bind_level_set(module);
  bind_metric(module);
  bind_move(module);
  bind_transfer(module);
}
