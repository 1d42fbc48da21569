/// @file
/// Level sets: meshes cut along them, and what an adaptation of such a mesh needs.
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "ductile/meshadapt/level_set_function.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace ductile::python {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::CutMaterial;
using meshadapt::CutOptions;
using meshadapt::CutReport;
using runtime::Executor;
using runtime::ExecutorOptions;

/// A mesh that was cut, with the mesh and the values that it was cut from.
struct Cut {
  std::shared_ptr<AnyMesh> before;
  std::vector<double> values;
  std::int32_t interface = 0;
  meshadapt::CutMesh made;
};
using CutHandle = std::shared_ptr<Cut>;

CutHandle cut(const std::shared_ptr<AnyMesh>& mesh, const Given<double>& values,
              const CutOptions& options, const ExecutorOptions& threads) {
  auto result = std::make_shared<Cut>(Cut{mesh, copied(values), options.interface, {}});
  result->made = work(threads, [&](const Executor& executor) {
    return meshadapt::cut(executor, *mesh, result->values, options);
  });
  return result;
}

/// A metric of the mesh before, by default the sizes that it has, at the vertices of the cut mesh.
py::array metric_of_cut(const Cut& cut, const std::optional<Given<double>>& given,
                        const ExecutorOptions& threads) {
  std::optional<AnyField> wanted;
  if (given) wanted = field_of(*given, AnyField::Type::symmetric, cut.before->dimension, "metric");
  AnyField found = work(threads, [&](const Executor& executor) {
    if (!wanted) wanted = meshadapt::default_metric(executor, *cut.before);
    return meshadapt::metric_at_cut(executor, *wanted, cut.made);
  });
  return array_of(std::move(found));
}

/// Lets adapt() put the interface, if there is one, on the surface of the level set.
void add_surface_of(const Cut& cut, meshadapt::AdaptOptions& options,
                    const ExecutorOptions& threads) {
  if (cut.made.report.interface_facets == 0 || cut.made.report.on_surface) return;
  options.make.functions.push_back(work(threads, [&](const Executor& executor) {
    return meshadapt::LevelSetFunction(executor, *cut.before, cut.values, cut.made.report.level)
        .surface(cut.interface, options.make.hausdorff_tolerance);
  }));
}

/// For each vertex the two of the mesh before between which it lies, and the weight of the second.
py::tuple vertex_origins(const Cut& cut) {
  const auto& origins = cut.made.vertex_origin;
  std::vector<std::uint32_t> ends;
  std::vector<double> weights;
  ends.reserve(2 * origins.size());
  weights.reserve(origins.size());
  for (const meshadapt::VertexOrigin& origin : origins) {
    ends.push_back(origin.a);
    ends.push_back(origin.b);
    weights.push_back(origin.t);
  }
  return py::make_tuple(take(std::move(ends), {signed_size(origins.size()), 2}),
                        take(std::move(weights)));
}

CutOptions cut_options(double level, const std::tuple<int, int, int>& references,
                       const std::vector<std::tuple<int, bool, int, int>>& materials,
                       const std::tuple<double, std::optional<double>, bool>& others) {
  CutOptions options;
  options.level = level;
  std::tie(options.minus, options.plus, options.interface) = references;
  for (const auto& [reference, split, minus, plus] : materials)
    options.materials.push_back(CutMaterial{reference, split, minus, plus});
  std::tie(options.least_component, options.keep_volume, options.boundary_only) = others;
  return options;
}

void bind_cut_report(py::module_& module) {
  py::class_<CutReport>(module, "CutReport", "How a mesh was cut.")
      .def_readonly("level", &CutReport::level)
      .def_readonly("minus_volume", &CutReport::minus_volume)
      .def_readonly("interface_facets", &CutReport::interface_facets)
      .def_readonly("cut_elements", &CutReport::cut_elements)
      .def_readonly("moved_vertices", &CutReport::moved_vertices)
      .def_readonly("removed_components", &CutReport::removed_components)
      .def_readonly("removed_volume", &CutReport::removed_volume)
      .def_readonly("warnings", &CutReport::warnings);
}

}  // namespace

void bind_level_set(py::module_& module) {
  bind_cut_report(module);
  py::class_<CutOptions>(module, "CutOptions").def(py::init(&cut_options));
  py::class_<Cut, CutHandle>(module, "CutData")
      .def_property_readonly(
          "mesh",
          [](const CutHandle& cut) { return std::shared_ptr<AnyMesh>(cut, &cut->made.mesh); })
      .def_property_readonly("value",
                             [](const Cut& cut) { return take(std::vector(cut.made.value)); })
      .def_property_readonly("vertex_origins", &vertex_origins)
      .def_property_readonly(
          "cell_origins", [](const Cut& cut) { return take(std::vector(cut.made.element_origin)); })
      .def_property_readonly(
          "facet_origins", [](const Cut& cut) { return take(std::vector(cut.made.facet_origin)); })
      .def_property_readonly("report", [](const Cut& cut) { return cut.made.report; })
      .def("metric", &metric_of_cut)
      .def("add_surface", &add_surface_of);
  module.def("cut", &cut);
}

}  // namespace ductile::python
