/// @file
/// Shared by the parts of the Python module: numpy views of C++ memory, vectors moved into numpy
/// arrays (neither copies), and work without the interpreter's lock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::python {

namespace py = pybind11;

using Shape = std::vector<py::ssize_t>;
/// An array that C++ reads in place. Arrays of another type or layout are refused; the package
/// converts them first.
template <class T>
using Given = py::array_t<T, py::array::c_style>;

void bind_mesh(py::module_& module);
void bind_adapt(py::module_& module);
void bind_geometry(py::module_& module);   // before bind_adapt(), whose options refer to it
void bind_level_set(py::module_& module);  // after bind_adapt()
void bind_metric(py::module_& module);
void bind_move(py::module_& module);
void bind_transfer(py::module_& module);

inline py::ssize_t signed_size(std::size_t size) { return static_cast<py::ssize_t>(size); }

/// The type of elements in numpy. Indices are unsigned in C++ and signed here, so that `none` is
/// -1.
template <class T>
struct Shown {
  using Type = T;
};
template <>
struct Shown<std::uint32_t> {
  using Type = std::int32_t;
};

/// A read-only array over memory of `owner`, which it keeps alive.
template <class T>
py::array view(const py::object& owner, const T* data, const Shape& shape) {
  using Type = typename Shown<T>::Type;
  py::array_t<Type> shown(shape, reinterpret_cast<const Type*>(data), owner);
  shown.attr("setflags")(py::arg("write") = false);
  return shown;
}

/// Moves a vector into an array. An empty shape means one dimension.
template <class T>
py::array take(std::vector<T>&& values, Shape shape = {}) {
  if (shape.empty()) shape = {signed_size(values.size())};
  using Type = typename Shown<T>::Type;
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* old) { delete static_cast<std::vector<T>*>(old); });
  return py::array_t<Type>(shape, reinterpret_cast<const Type*>(kept->data()), owner);
}

template <class T>
std::vector<T> copied(const Given<T>& array) {
  return {array.data(), array.data() + array.size()};
}

/// A field with one value of this type per row of the array.
inline meshadapt::AnyField field_of(const Given<double>& array, meshadapt::AnyField::Type type,
                                    int dimension, const char* name) {
  return {dimension, static_cast<std::size_t>(array.shape(0)), {type}, copied(array), name};
}

/// Rows of an array and their type.
using GivenMetric = std::optional<std::tuple<Given<double>, meshadapt::AnyField::Type>>;

/// The metric at the vertices of a mesh, if one is given.
inline std::optional<meshadapt::AnyField> metric_field(const GivenMetric& given, int dimension) {
  if (!given) return std::nullopt;
  return field_of(std::get<0>(*given), std::get<1>(*given), dimension, "metric");
}

/// The values of a field, a row for each vertex.
inline py::array array_of(meshadapt::AnyField&& field) {
  const Shape shape{signed_size(field.vertex_count), signed_size(stride_of(field))};
  return take(std::move(field.values), shape);
}

/// Fields: name, type, on elements?, rows.
using GivenFields =
    std::vector<std::tuple<std::string, meshadapt::AnyField::Type, bool, Given<double>>>;

inline meshadapt::NamedField::Place place_of(bool on_elements) {
  using Place = meshadapt::NamedField::Place;
  return on_elements ? Place::elements : Place::vertices;
}
inline std::vector<meshadapt::NamedField> named_fields(const GivenFields& given) {
  std::vector<meshadapt::NamedField> fields;
  for (const auto& [name, type, on_elements, rows] : given)
    fields.push_back({name, type, copied(rows), place_of(on_elements)});
  return fields;
}

/// The arrays of a Python Origin.
py::tuple arrays_of(meshadapt::Origins&& origins, int dimension);

/// The sizes for this mesh: sets the dimensions of places given as "facets" or "cells".
meshadapt::Sizes sizes_for(const meshadapt::AnyMesh& mesh, meshadapt::Sizes sizes);

/// Calls body(executor) without the interpreter's lock, so that other Python threads can run. The
/// executor's threads stay together meanwhile.
template <class Body>
auto work(const runtime::ExecutorOptions& options, Body&& body) {
  const py::gil_scoped_release unlocked;
  const runtime::Executor executor(options);
  return runtime::with_team(executor, [&] { return body(executor); });
}

}  // namespace ductile::python
