/// @file
/// Meshes: made from arrays and files, read through views, checked and measured.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "bindings.hpp"

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/statistics.hpp"

namespace ductile::python {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::NamedField;
using meshadapt::Warnings;
using Handle = std::shared_ptr<AnyMesh>;

// ---- From arrays ----

template <class T>
std::span<const T> span_of(const Given<T>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// Corners and references of cells; references are empty or one per cell.
template <class Index>
using GivenCells = std::tuple<Given<Index>, Given<std::int32_t>>;

template <class Index>
Handle from_arrays(const Given<double>& points, const Given<std::int32_t>& vertex_refs,
                   const GivenCells<Index>& cells, const GivenCells<Index>& facets) {
  const meshadapt::MeshArrays<Index> arrays{.dimension = static_cast<int>(points.shape(1)),
                                            .coordinates = span_of(points),
                                            .elements = span_of(std::get<0>(cells)),
                                            .element_reference = span_of(std::get<1>(cells)),
                                            .facets = span_of(std::get<0>(facets)),
                                            .facet_reference = span_of(std::get<1>(facets)),
                                            .vertex_reference = span_of(vertex_refs),
                                            .is_surface = points.shape(1) == 3 &&
                                                          std::get<0>(cells).ndim() == 2 &&
                                                          std::get<0>(cells).shape(1) == 3};
  return work({}, [&](const runtime::Executor& executor) {
    return std::make_shared<AnyMesh>(meshadapt::mesh_from_arrays(executor, arrays));
  });
}

Handle box(const std::vector<double>& extent, const std::vector<int>& cells) {
  if (extent.size() == 2)
    return std::make_shared<AnyMesh>(
        meshadapt::box_mesh<2>({extent[0], extent[1]}, {cells[0], cells[1]}));
  return std::make_shared<AnyMesh>(
      meshadapt::box_mesh<3>({extent[0], extent[1], extent[2]}, {cells[0], cells[1], cells[2]}));
}

// ---- Arrays of a mesh ----

template <int corners>
py::array corners_of(const py::object& self, const meshadapt::Cells<corners>& cells) {
  return view(self, cells.size() == 0 ? nullptr : cells.vertices[0].data(),
              {signed_size(cells.size()), corners});
}

template <class T>
py::array entries(const py::object& self, const std::vector<T>& values) {
  return view(self, values.data(), {signed_size(values.size())});
}

/// An array property: the view that choose(self, mesh) returns.
template <class Choose>
auto shown(Choose choose) {
  return [choose](const py::object& self) { return choose(self, self.cast<const AnyMesh&>()); };
}

std::vector<std::uint32_t>& required(AnyMesh& mesh, const std::string& kind) {
  const bool flat = element_dimension(mesh) == 2;
  if (kind == "vertices") return mesh.required_vertices;
  if (kind == "facets") return flat ? mesh.required_edges : mesh.required_triangles;
  if (kind == "cells") return flat ? mesh.required_triangles : mesh.required_tetrahedra;
  if (kind == "edges") return mesh.required_edges;
  if (kind == "ridges") return mesh.ridges;
  if (kind == "corners") return mesh.corners;
  throw meshadapt::InputError("kind: expected vertices, facets, cells, edges, ridges or corners");
}

void bind_arrays(py::class_<AnyMesh, Handle>& type) {
  const auto at = [&](const char* name, auto choose) {
    type.def_property_readonly(name, shown(choose));
  };
  at("points", [](const py::object& self, const AnyMesh& mesh) {
    return view(self, mesh.coordinates.data(), {signed_size(mesh.vertex_count()), mesh.dimension});
  });
  at("cells", [](const py::object& self, const AnyMesh& mesh) {
    return element_dimension(mesh) == 2 ? corners_of(self, mesh.triangles)
                                        : corners_of(self, mesh.tetrahedra);
  });
  at("facets", [](const py::object& self, const AnyMesh& mesh) {
    return element_dimension(mesh) == 2 ? corners_of(self, mesh.edges)
                                        : corners_of(self, mesh.triangles);
  });
  at("edges",
     [](const py::object& self, const AnyMesh& mesh) { return corners_of(self, mesh.edges); });
  at("refs", [](const py::object& self, const AnyMesh& mesh) {
    return entries(
        self, element_dimension(mesh) == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference);
  });
  at("facet_refs", [](const py::object& self, const AnyMesh& mesh) {
    return entries(self,
                   element_dimension(mesh) == 2 ? mesh.edges.reference : mesh.triangles.reference);
  });
  at("edge_refs", [](const py::object& self, const AnyMesh& mesh) {
    return entries(self, mesh.edges.reference);
  });
  at("vertex_refs", [](const py::object& self, const AnyMesh& mesh) {
    return entries(self, mesh.vertex_reference);
  });
}

void set_edges(AnyMesh& mesh, const Given<std::int32_t>& edges, const Given<std::int32_t>& refs) {
  mesh.edges = {};
  for (py::ssize_t i = 0; i < edges.shape(0); ++i)
    mesh.edges.add(
        {static_cast<std::uint32_t>(edges.at(i, 0)), static_cast<std::uint32_t>(edges.at(i, 1))},
        refs.at(i));
}

using Names = std::vector<std::tuple<std::string, int, std::int32_t>>;

Names names_of(const AnyMesh& mesh) {
  Names names;
  for (const auto& [dimension, reference, name] : mesh.names)
    names.emplace_back(name, dimension, reference);
  return names;
}

void set_names(AnyMesh& mesh, const Names& names) {
  mesh.names.clear();
  for (const auto& [name, dimension, reference] : names)
    mesh.names.push_back({dimension, reference, name});
}

// ---- Files ----

/// (name, on elements?, values); values with several components have a row per entity.
using Fields = std::vector<std::tuple<std::string, bool, py::array>>;

py::array rows(std::vector<double>&& values, std::size_t components) {
  const std::size_t count = components == 0 ? 0 : values.size() / components;
  if (components == 1) return take(std::move(values));
  return take(std::move(values), {signed_size(count), signed_size(components)});
}

std::tuple<Handle, Fields, Warnings> read(const std::string& path) {
  Warnings warnings;
  auto read = work({}, [&](const runtime::Executor& executor) {
    auto found = meshadapt::read_mesh_with_fields(path, &warnings);
    meshadapt::list_boundary(executor, found.mesh);
    return found;
  });
  Fields fields;
  for (NamedField& field : read.fields) {
    const int components = component_count(field.type, read.mesh.dimension);
    fields.emplace_back(field.name, field.place == NamedField::Place::elements,
                        rows(std::move(field.values), static_cast<std::size_t>(components)));
  }
  return {std::make_shared<AnyMesh>(std::move(read.mesh)), std::move(fields), std::move(warnings)};
}

std::tuple<std::vector<py::array>, Warnings> read_field(const std::string& path) {
  Warnings warnings;
  const AnyField field = meshadapt::read_field(path, &warnings);
  std::vector<py::array> arrays;
  for (NamedField& part : meshadapt::named_fields(field, "field"))
    arrays.push_back(rows(std::move(part.values),
                          static_cast<std::size_t>(component_count(part.type, field.dimension))));
  return {std::move(arrays), std::move(warnings)};
}

Warnings save(const AnyMesh& mesh, const std::string& path, const GivenFields& given) {
  const std::vector<NamedField> fields = named_fields(given);
  Warnings warnings;
  const py::gil_scoped_release unlocked;
  meshadapt::write_mesh(path, mesh, {.fields = fields, .warnings = &warnings});
  return warnings;
}

void save_field(const std::string& path, const Given<double>& values, AnyField::Type type,
                int dimension) {
  meshadapt::write_field(path, field_of(values, type, dimension, "field"));
}

void bind_files(py::module_& module) {
  module.def("from_arrays", &from_arrays<std::int32_t>);
  module.def("from_arrays", &from_arrays<std::int64_t>);
  module.def("box", &box);
  module.def("read", &read);
  module.def("read_field", &read_field);
  module.def("save", &save);
  module.def("save_field", &save_field);
  module.def("holds_fields", [](const std::string& path) {
    const auto* const format = meshadapt::format_of(path);
    return format != nullptr && format->holds_fields;
  });
  module.def("formats", [] {
    std::vector<std::tuple<std::string, std::string, bool, bool>> formats;
    for (const auto& format : meshadapt::mesh_formats())
      formats.emplace_back(format.ending, format.what, format.is_read, format.is_written);
    return formats;
  });
}

// ---- Checks and statistics ----

void bind_statistics(py::module_& module) {
  using meshadapt::Distribution;
  using meshadapt::MeshStatistics;
  py::class_<Distribution>(module, "Distribution")
      .def_readonly("count", &Distribution::count)
      .def_readonly("min", &Distribution::min)
      .def_readonly("low", &Distribution::low)
      .def_readonly("median", &Distribution::median)
      .def_readonly("mean", &Distribution::mean)
      .def_readonly("max", &Distribution::max)
      .def_readonly("histogram_from", &Distribution::histogram_from)
      .def_readonly("histogram_to", &Distribution::histogram_to)
      .def_readonly("histogram", &Distribution::histogram)
      .def_readonly("below", &Distribution::below)
      .def_readonly("above", &Distribution::above);
  py::class_<MeshStatistics>(module, "Statistics")
      .def_readonly("in_metric", &MeshStatistics::in_metric)
      .def_readonly("edge_length", &MeshStatistics::edge_length)
      .def_readonly("quality", &MeshStatistics::quality)
      .def_readonly("edges_in_range", &MeshStatistics::edges_in_range)
      .def_readonly("edges_short", &MeshStatistics::edges_short)
      .def_readonly("edges_long", &MeshStatistics::edges_long)
      .def_readonly("complexity", &MeshStatistics::complexity)
      .def_property_readonly("share_in_range", &MeshStatistics::share_in_range);
}

/// Calls work(executor, metric) with a pointer to the field of tensors, or null if none are given.
template <class Work>
auto work_in_metric(const AnyMesh& mesh, const std::optional<Given<double>>& tensors,
                    Work&& measure) {
  std::optional<AnyField> metric;
  if (tensors) metric = field_of(*tensors, AnyField::Type::symmetric, mesh.dimension, "metric");
  return work({}, [&](const runtime::Executor& executor) {
    return measure(executor, metric ? &*metric : nullptr);
  });
}

void bind_checks(py::module_& module) {
  module.def("check", [](const AnyMesh& mesh) {
    return work({}, [&](const runtime::Executor& executor) {
      return meshadapt::check_mesh(executor, mesh);
    });
  });
  module.def("join_vertices", [](const AnyMesh& mesh, double tolerance) {
    auto joined = meshadapt::join_vertices(mesh, tolerance);
    return py::make_tuple(std::make_shared<AnyMesh>(std::move(joined.mesh)),
                          take(std::move(joined.kept)));
  });
  module.def("check_adapted", [](const AnyMesh& before, const AnyMesh& after, double tolerance) {
    return work({}, [&](const runtime::Executor& executor) {
      return meshadapt::check_adapted(executor, before, after, tolerance);
    });
  });
  module.def("measure", [](const AnyMesh& mesh, const std::optional<Given<double>>& given) {
    return work_in_metric(mesh, given, [&](const runtime::Executor& executor, const auto* metric) {
      return meshadapt::measure(executor, mesh, metric);
    });
  });
  module.def("quality", [](const AnyMesh& mesh, const std::optional<Given<double>>& given) {
    return take(
        work_in_metric(mesh, given, [&](const runtime::Executor& executor, const auto* metric) {
          return meshadapt::element_qualities(executor, mesh, metric);
        }));
  });
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::enum_<AnyField::Type>(module, "FieldType")
      .value("scalar", AnyField::Type::scalar)
      .value("vector", AnyField::Type::vector)
      .value("symmetric", AnyField::Type::symmetric)
      .value("matrix", AnyField::Type::matrix);
  py::class_<AnyMesh, Handle> type(module, "MeshData");
  bind_arrays(type);
  type.def_readonly("dimension", &AnyMesh::dimension)
      .def_property_readonly("cell_dimension",
                             [](const AnyMesh& mesh) { return element_dimension(mesh); })
      .def_readwrite("dropped_axis", &AnyMesh::dropped_axis)
      .def_property("names", &names_of, &set_names)
      .def("copy", [](const AnyMesh& mesh) { return std::make_shared<AnyMesh>(mesh); })
      .def("set_edges", &set_edges)
      .def("required",
           [](AnyMesh& mesh, const std::string& kind) {
             return take(std::vector<std::uint32_t>(required(mesh, kind)));
           })
      .def("require",
           [](AnyMesh& mesh, const std::string& kind, const Given<std::int32_t>& indices) {
             required(mesh, kind).assign(indices.data(), indices.data() + indices.size());
           })
      .def_property_readonly("address", [](const AnyMesh& mesh) {  // for the tests
        return reinterpret_cast<std::uintptr_t>(mesh.coordinates.data());
      });
  bind_files(module);
  bind_statistics(module);
  bind_checks(module);
}

}  // namespace ductile::python
