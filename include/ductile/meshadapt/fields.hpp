/// @file
/// Between the arrays of a simulation and AnyField, which keeps all components of a vertex
/// together: fields made from arrays, put side by side, and taken apart again. For tensors see
/// metric_field.hpp. Thread safety of all: any thread.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

/// One scalar at each vertex of a mesh of this dimension. Throws InputError unless that is 2 or 3.
AnyField scalar_field(int dimension, std::vector<double> value_of, const std::string& name = "");

/// One vector at each vertex.
template <int Dim>
AnyField vector_field(const std::vector<Vector<Dim>>& vector_of, const std::string& name = "");

/// All fields of both, those of `first` before those of `second`. Throws InputError unless they
/// have the same dimension and as many vertices.
AnyField joined(const AnyField& first, const AnyField& second);

/// The fields of an AnyField apart: "NAME", or "NAME_1", "NAME_2", ... if there are several.
/// Throws InputError unless there are values for all vertices.
std::vector<NamedField> named_fields(const AnyField& field, const std::string& name);

/// The values [vertex] of one scalar among the fields, of which the first has index 0. Throws
/// InputError unless there is one.
std::vector<double> scalars_of(const AnyField& field, std::size_t index = 0);

/// The same of a field of vectors.
template <int Dim>
std::vector<Vector<Dim>> vectors_of(const AnyField& field, std::size_t index = 0);

extern template AnyField vector_field(const std::vector<Vector<2>>&, const std::string&);
extern template AnyField vector_field(const std::vector<Vector<3>>&, const std::string&);
extern template std::vector<Vector<2>> vectors_of<2>(const AnyField&, std::size_t);
extern template std::vector<Vector<3>> vectors_of<3>(const AnyField&, std::size_t);

}  // namespace ductile::meshadapt
