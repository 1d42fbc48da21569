#include "ductile/meshadapt/mesh_arrays.hpp"

#include <algorithm>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

namespace {

/// The components [first, first + count) of each vertex.
std::vector<double> components_of(const AnyField& field, std::size_t first, std::size_t count) {
  const std::size_t stride = stride_of(field);
  std::vector<double> values(field.vertex_count * count);
  for (std::size_t v = 0; v < field.vertex_count; ++v)
    std::copy_n(&field.values[v * stride + first], count, &values[v * count]);
  return values;
}

/// The first component of a field within a vertex. Throws unless the field is of this type.
std::size_t first_component(const AnyField& field, std::size_t index, AnyField::Type type) {
  if (index >= field.types.size() || field.types[index] != type)
    throw InputError(name_of(field) + ": expected a field of " +
                     (type == AnyField::Type::scalar ? "scalars" : "vectors") + " with index " +
                     std::to_string(index) + ", found " +
                     (index < field.types.size() ? "one of another type"
                                                 : std::to_string(field.types.size()) + " fields"));
  std::size_t first = 0;
  for (std::size_t i = 0; i < index; ++i)
    first += static_cast<std::size_t>(component_count(field.types[i], field.dimension));
  return first;
}

}  // namespace

AnyField scalar_field(int dimension, std::vector<double> value_of, const std::string& name) {
  if (dimension != 2 && dimension != 3)
    throw InputError("dimension: expected 2 or 3, found " + std::to_string(dimension));
  const std::size_t count = value_of.size();
  return {dimension, count, {AnyField::Type::scalar}, std::move(value_of), name};
}

template <int Dim>
AnyField vector_field(const std::vector<Vector<Dim>>& vector_of, const std::string& name) {
  AnyField field{Dim, vector_of.size(), {AnyField::Type::vector}, {}, name};
  field.values.reserve(vector_of.size() * Dim);
  for (const Vector<Dim>& vector : vector_of)
    field.values.insert(field.values.end(), vector.x.begin(), vector.x.end());
  return field;
}

AnyField joined(const AnyField& first, const AnyField& second) {
  expect_values(first);
  expect_values(second);
  if (first.dimension != second.dimension || first.vertex_count != second.vertex_count)
    throw InputError(name_of(second) + ": expected a field of dimension " +
                     std::to_string(first.dimension) + " with " +
                     std::to_string(first.vertex_count) + " vertices, as " + name_of(first) +
                     " is, found one of dimension " + std::to_string(second.dimension) + " with " +
                     std::to_string(second.vertex_count));
  AnyField both{first.dimension, first.vertex_count, first.types, {}, first.name};
  both.types.insert(both.types.end(), second.types.begin(), second.types.end());
  both.values.resize(first.values.size() + second.values.size());
  const std::size_t a = stride_of(first), b = stride_of(second);
  for (std::size_t v = 0; v < both.vertex_count; ++v) {
    double* const here = both.values.data() + v * (a + b);
    std::copy_n(first.values.data() + v * a, a, here);
    std::copy_n(second.values.data() + v * b, b, here + a);
  }
  return both;
}

std::vector<NamedField> named_fields(const AnyField& field, const std::string& name) {
  std::vector<NamedField> fields;
  expect_values(field);
  std::size_t first = 0;
  for (const AnyField::Type type : field.types) {
    const auto count = static_cast<std::size_t>(component_count(type, field.dimension));
    std::string its_name = name;
    if (field.types.size() > 1) its_name.append("_").append(std::to_string(fields.size() + 1));
    fields.push_back(
        {.name = std::move(its_name), .type = type, .values = components_of(field, first, count)});
    first += count;
  }
  return fields;
}

std::vector<double> scalars_of(const AnyField& field, std::size_t index) {
  expect_values(field);
  return components_of(field, first_component(field, index, AnyField::Type::scalar), 1);
}

template <int Dim>
std::vector<Vector<Dim>> vectors_of(const AnyField& field, std::size_t index) {
  if (field.dimension != Dim)
    throw InputError(name_of(field) + ": expected dimension " + std::to_string(Dim) + ", found " +
                     std::to_string(field.dimension));
  expect_values(field);
  const auto values =
      components_of(field, first_component(field, index, AnyField::Type::vector), Dim);
  std::vector<Vector<Dim>> vector_of(field.vertex_count);
  for (std::size_t v = 0; v < vector_of.size(); ++v)
    std::copy_n(&values[v * Dim], Dim, vector_of[v].x.begin());
  return vector_of;
}

template AnyField vector_field(const std::vector<Vector<2>>&, const std::string&);
template AnyField vector_field(const std::vector<Vector<3>>&, const std::string&);
template std::vector<Vector<2>> vectors_of<2>(const AnyField&, std::size_t);
template std::vector<Vector<3>> vectors_of<3>(const AnyField&, std::size_t);

}  // namespace ductile::meshadapt
