/// @file
/// Shared by the parts of the Python module: numpy views of C++ memory, vectors moved into numpy
/// arrays (neither copies), and work without the interpreter's lock.
#pragma once

#include <cstdint>
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
