/// @file
/// Transfer between meshes: origins of vertices, facets and elements, and fields.
#include <tuple>
#include <utility>

#include "bindings.hpp"

#include "ductile/meshadapt/transfer.hpp"

namespace ductile::python {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Carrying;
using meshadapt::NamedField;
using runtime::Executor;
using runtime::ExecutorOptions;

py::tuple origins(const AnyMesh& before, const AnyMesh& after) {
  auto found = work(
      {}, [&](const Executor& executor) { return meshadapt::origins(executor, before, after); });
  return arrays_of(std::move(found), element_dimension(before));
}

/// The type of the rows of an array, whether they belong to cells (else to vertices), and whether
/// integrals are kept.
using How = std::tuple<AnyField::Type, bool, bool>;

py::tuple transfer(const AnyMesh& before, const AnyMesh& after, const Given<double>& values,
                   const How& how, const ExecutorOptions& threads) {
  const auto [type, on_cells, conservative] = how;
  const std::vector<NamedField> fields = named_fields({{"u", type, on_cells, values}});
  const auto carrying = conservative ? Carrying::conservatively : Carrying::by_value;
  auto carried = work(threads, [&](const Executor& executor) {
    return meshadapt::transfer_fields(executor, {before, fields}, after, {carrying});
  });
  return py::make_tuple(take(std::move(carried.fields[0].values)), carried.report);
}

}  // namespace

py::tuple arrays_of(meshadapt::Origins&& origins, int dimension) {
  const Shape shape{signed_size(origins.vertex.size()), dimension + 1};
  return py::make_tuple(take(std::move(origins.vertex)), take(std::move(origins.facet)),
                        take(std::move(origins.element)), take(std::move(origins.host)),
                        take(std::move(origins.weight), shape));
}

void bind_transfer(py::module_& module) {
  using meshadapt::TransferReport;
  py::class_<TransferReport>(module, "TransferReport")
      .def_readonly("vertices_outside", &TransferReport::vertices_outside)
      .def_readonly("volume_outside", &TransferReport::volume_outside)
      .def_readonly("volume_left_out", &TransferReport::volume_left_out);
  module.def("origins", &origins);
  module.def("transfer", &transfer);
  module.def("interpolate_at", [](const AnyMesh& mesh, const Given<double>& values,
                                  const Given<double>& points) {
    AnyField field = field_of(values, AnyField::Type::scalar, mesh.dimension, "u");
    field.types.assign(static_cast<std::size_t>(values.shape(1)), AnyField::Type::scalar);
    const Shape shape{points.shape(0), values.shape(1)};
    auto found = work({}, [&](const Executor& executor) {
      return meshadapt::interpolate_at(executor, {mesh, field},
                                       {points.data(), static_cast<std::size_t>(points.size())});
    });
    return take(std::move(found.field.values), shape);
  });
}

}  // namespace ductile::python
