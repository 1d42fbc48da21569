#include "ductile/meshadapt/metric_field.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "ductile/runtime/parallel_for.hpp"
#include "mesh/first_bad.hpp"

namespace ductile::meshadapt {
namespace {

using Type = AnyField::Type;

[[noreturn]] void fail(const AnyField& field, const std::string& expected,
                       const std::string& advice) {
  throw InputError(field.name + ": expected " + expected + "; " + advice);
}

[[noreturn]] void fail_at(const AnyField& field, std::size_t vertex, const std::string& expected,
                          const std::string& found) {
  fail(field, expected + " at vertex " + std::to_string(vertex + 1) + ", found " + found,
       "correct the field there");
}

void expect_one_metric(const AnyField& field, const AnyMesh& mesh) {
  if (field.types.size() != 1)
    fail(field, "one field, the metric, found " + std::to_string(field.types.size()),
         "keep the metric alone in its file");
  if (field.types[0] != Type::scalar && field.types[0] != Type::symmetric)
    fail(field,
         "a metric, sizes (type 1) or symmetric tensors (type 3), found type " +
             std::to_string(static_cast<int>(field.types[0])),
         "give another field");
  if (field.vertex_count != mesh.vertex_count())
    fail(field,
         std::to_string(mesh.vertex_count()) + " values, one for each vertex of " + mesh.name +
             ", found " + std::to_string(field.vertex_count),
         "give the field of this mesh");
  if (field.dimension < mesh.dimension)
    fail(field,
         "dimension " + std::to_string(mesh.dimension) + ", that of " + mesh.name + ", found " +
             std::to_string(field.dimension),
         "give the field of this mesh");
}

/// A lower bound of smallest over largest eigenvalue that takes no iteration; 0 or not a number
/// where it says nothing. By det = product of eigenvalues and the arithmetic-geometric mean.
double eigenvalue_ratio_bound(const Metric<2>& m) {
  const double trace = m.m[0] + m.m[2];
  return m.m[0] > 0 ? determinant(m) / (trace * trace) : 0;
}
double eigenvalue_ratio_bound(const Metric<3>& m) {
  const double trace = m.m[0] + m.m[2] + m.m[5];
  const bool minors_positive = m.m[0] > 0 && m.m[0] * m.m[2] - m.m[1] * m.m[1] > 0;
  return minors_positive ? 4 * determinant(m) / (trace * trace * trace) : 0;
}

template <int Dim>
void expect_metric(const AnyField& field, std::size_t vertex, const Metric<Dim>& metric) {
  double trace = 0;
  for (int i = 0; i < Dim; ++i) trace += metric(i, i);
  const bool within = trace > 1e-120 && trace < 1e120;
  if (within && eigenvalue_ratio_bound(metric) > 1e-12) return;
  const auto values = principal_axes(metric).value;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  if (!(*smallest > 0))
    fail_at(field, vertex, "a positive definite tensor",
            "eigenvalues from " + number(*smallest) + " to " + number(*largest));
  const double shortest = 1 / std::sqrt(*largest);
  const double longest = 1 / std::sqrt(*smallest);
  if (shortest < smallest_size || longest > largest_size)
    fail_at(field, vertex, "sizes from 1e-75 to 1e75", number(shortest) + " to " + number(longest));
  if (longest > largest_anisotropy * shortest)
    fail_at(field, vertex, "sizes that differ by at most " + number(largest_anisotropy) + " times",
            number(shortest) + " to " + number(longest));
}

template <int Dim>
void append_isotropic(AnyField& result, const AnyField& field, std::size_t vertex) {
  const double size = field.values[vertex];
  if (!(size >= smallest_size && size <= largest_size))
    fail_at(field, vertex, "a size from 1e-75 to 1e75", number(size));
  const Metric<Dim> metric = isotropic<Dim>(size);
  result.values.insert(result.values.end(), metric.m.begin(), metric.m.end());
}

template <int Dim>
void append_tensor(AnyField& result, const AnyField& field, std::size_t vertex) {
  const std::size_t stride = stride_of(field);
  const std::span<const double> values(field.values.data() + vertex * stride, stride);
  if (stride > Metric<Dim>::size && (values[3] != 0 || values[4] != 0))
    fail_at(field, vertex, "a tensor without components out of the plane, as the mesh is flat",
            number(values[3]) + " and " + number(values[4]));
  Metric<Dim> metric;
  std::copy_n(values.begin(), metric.m.size(), metric.m.begin());
  expect_metric(field, vertex, metric);
  result.values.insert(result.values.end(), metric.m.begin(), metric.m.end());
}

template <int Dim>
void append_metrics(AnyField& result, const AnyField& field) {
  for (std::size_t vertex = 0; vertex < field.vertex_count; ++vertex)
    if (field.types[0] == Type::scalar)
      append_isotropic<Dim>(result, field, vertex);
    else
      append_tensor<Dim>(result, field, vertex);
}

}  // namespace

AnyField metric_of(const AnyField& field, const AnyMesh& mesh) {
  expect_one_metric(field, mesh);
  AnyField result;
  result.name = field.name;
  result.dimension = mesh.dimension;
  result.vertex_count = field.vertex_count;
  result.types = {Type::symmetric};
  result.values.reserve(field.vertex_count * stride_of(result));
  mesh.dimension == 2 ? append_metrics<2>(result, field) : append_metrics<3>(result, field);
  return result;
}

void expect_field_of(const AnyField& field, const AnyMesh& mesh) {
  if (field.dimension != mesh.dimension)
    fail(field,
         "dimension " + std::to_string(mesh.dimension) + ", that of " + mesh.name + ", found " +
             std::to_string(field.dimension),
         "give a field of this mesh");
  if (field.vertex_count != mesh.vertex_count())
    fail(field,
         std::to_string(mesh.vertex_count()) + " values, one for each vertex of " + mesh.name +
             ", found " + std::to_string(field.vertex_count),
         "give a field of this mesh");
  const std::size_t wanted = field.vertex_count * stride_of(field);
  if (field.types.empty() || field.values.size() != wanted)
    fail(field,
         "numbers for all components at all vertices, " + std::to_string(wanted) +
             " of them, found " + std::to_string(field.values.size()),
         "give all of them");
}

template <int Dim>
std::vector<Metric<Dim>> tensors_of(const runtime::Executor& executor, const AnyField& field,
                                    std::size_t component) {
  const std::size_t stride = stride_of(field);
  std::vector<Metric<Dim>> tensor_of(field.vertex_count);
  runtime::parallel_for(executor, tensor_of.size(), [&](std::size_t v) {
    std::copy_n(&field.values[v * stride + component], Metric<Dim>::size, tensor_of[v].m.begin());
  });
  return tensor_of;
}

template <int Dim>
AnyField symmetric_field(const runtime::Executor& executor,
                         const std::vector<Metric<Dim>>& tensor_of, const std::string& name) {
  AnyField field{Dim, tensor_of.size(), {Type::symmetric}, {}, name};
  field.values.resize(tensor_of.size() * Metric<Dim>::size);
  runtime::parallel_for(executor, tensor_of.size(), [&](std::size_t v) {
    std::copy_n(tensor_of[v].m.begin(), Metric<Dim>::size, &field.values[v * Metric<Dim>::size]);
  });
  return field;
}

template std::vector<Metric<2>> tensors_of<2>(const runtime::Executor&, const AnyField&,
                                              std::size_t);
template std::vector<Metric<3>> tensors_of<3>(const runtime::Executor&, const AnyField&,
                                              std::size_t);
template AnyField symmetric_field(const runtime::Executor&, const std::vector<Metric<2>>&,
                                  const std::string&);
template AnyField symmetric_field(const runtime::Executor&, const std::vector<Metric<3>>&,
                                  const std::string&);

}  // namespace ductile::meshadapt
