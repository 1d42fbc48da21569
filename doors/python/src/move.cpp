/// @file
/// Meshes that move.
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"

#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"

namespace ductile::python {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Carrying;
using meshadapt::MoveOptions;
using meshadapt::MoveReport;
using meshadapt::NamedField;

/// The metric, fields, and whether the integrals of these are kept.
using Carried = std::tuple<GivenMetric, GivenFields, bool>;

py::list taken(std::vector<NamedField>& fields, int dimension) {
  py::list list;
  for (NamedField& field : fields) {
    const auto columns = static_cast<std::size_t>(component_count(field.type, dimension));
    const Shape shape{signed_size(field.values.size() / columns), signed_size(columns)};
    list.append(take(std::move(field.values), shape));
  }
  return list;
}

py::tuple moved(const AnyMesh& mesh, const Given<double>& displacement, const Carried& given,
                const MoveOptions& given_options, const runtime::ExecutorOptions& threads) {
  const auto& [metric, fields, conservatively] = given;
  MoveOptions options = given_options;
  const std::vector<NamedField> carried = named_fields(fields);
  options.fields = carried;
  options.carrying = {conservatively ? Carrying::conservatively : Carrying::by_value};
  const AnyField vectors =
      field_of(displacement, AnyField::Type::vector, mesh.dimension, "displacement");
  auto sizes = metric_field(metric, mesh.dimension);
  if (sizes) {
    sizes = meshadapt::metric_of(*sizes, mesh, {options.smallest_size, options.largest_size});
    options.metric = &*sizes;
  }
  meshadapt::MovedMesh result = work(threads, [&](const runtime::Executor& executor) {
    return meshadapt::move(executor, mesh, vectors, options);
  });
  return py::make_tuple(std::make_shared<AnyMesh>(std::move(result.mesh)),
                        array_of(std::move(result.metric)), taken(result.fields, mesh.dimension),
                        arrays_of(std::move(result.origins), mesh.dimension),
                        std::move(result.report));
}

}  // namespace

void bind_move(py::module_& module) {
  py::class_<MoveOptions>(module, "MoveOptions")
      .def(py::init<>())
      .def_readwrite("bodies", &MoveOptions::bodies)
      .def_readwrite("boundaries", &MoveOptions::boundaries)
      .def_readwrite("remesh_below", &MoveOptions::remesh_below)
      .def_readwrite("turned", &MoveOptions::turned)
      .def_readwrite("keep_partial", &MoveOptions::keep_partial)
      .def_readwrite("smallest_size", &MoveOptions::smallest_size)
      .def_readwrite("largest_size", &MoveOptions::largest_size)
      .def_readwrite("gradation", &MoveOptions::gradation);
  py::class_<MoveReport>(module, "MoveReport", "How a motion went: how far, steps, adaptations.")
      .def_readonly("share", &MoveReport::share)
      .def_readonly("steps", &MoveReport::steps)
      .def_readonly("adaptations", &MoveReport::adaptations)
      .def_readonly("adapted_elements", &MoveReport::adapted_elements)
      .def_readonly("worst_quality", &MoveReport::worst_quality)
      .def_readonly("adapt_seconds", &MoveReport::adapt_seconds)
      .def_readonly("total_seconds", &MoveReport::total_seconds)
      .def_readonly("stopped", &MoveReport::stopped)
      .def_readonly("warnings", &MoveReport::warnings);
  module.def("move", &moved);
}

}  // namespace ductile::python
