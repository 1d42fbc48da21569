#include "ductile/meshadapt/metric_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/wording.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/metric_range.hpp"

namespace ductile::meshadapt {
namespace {

using Type = AnyField::Type;

[[noreturn]] void fail(const AnyField& field, const Wording& expected, const Wording& advice) {
  refuse(name_of(field) + ": expected " + expected + "; " + advice);
}

[[noreturn]] void fail_at(const AnyField& field, std::size_t vertex, const std::string& expected,
                          const std::string& found) {
  fail(field, expected + " at " + value_at(field, vertex) + ", found " + found,
       "correct the field there");
}

/// Throws unless the field has values for the mesh; `fits`: its dimension does.
void expect_values_of(const AnyField& field, const AnyMesh& mesh, bool fits) {
  if (field.vertex_count != mesh.vertex_count())
    fail(field,
         std::to_string(mesh.vertex_count()) + " values, one for each vertex of " + name_of(mesh) +
             ", found " + std::to_string(field.vertex_count),
         "give a field of this mesh");
  if (!fits)
    fail(field,
         "dimension " + std::to_string(mesh.dimension) + ", that of " + name_of(mesh) + ", found " +
             std::to_string(field.dimension),
         "give a field of this mesh");
  expect_values(field);
}

void expect_one_metric(const AnyField& field, const AnyMesh& mesh) {
  expect_coordinates(mesh);
  if (field.types.size() != 1)
    fail(field, "one field, the metric, found " + std::to_string(field.types.size()),
         {"give the metric alone", "keep the metric alone in its file"});
  if (field.types[0] == Type::vector)
    fail(field,
         "a metric, sizes (type 1), symmetric tensors (type 3) or symmetric matrices (type 4), "
         "found type " +
             std::to_string(static_cast<int>(field.types[0])),
         "give another field");
  expect_values_of(field, mesh, field.dimension >= mesh.dimension);
}

/// An order of components that others write, and where ours are in it.
template <int Dim>
struct ComponentOrder {
  const char* text;
  std::array<std::size_t, Metric<Dim>::size> from;
};

template <int Dim>
auto other_orders() {
  if constexpr (Dim == 2)
    return std::array{ComponentOrder<2>{"xx yy xy, not xx xy yy", {0, 2, 1}}};
  else
    return std::array{
        ComponentOrder<3>{"xx yy zz xy yz xz, as in VTK's files, not xx xy yy xz yz zz",
                          {0, 3, 1, 5, 4, 2}},
        ComponentOrder<3>{"xx xy yy xz yz zz, not xx yy zz xy yz xz, as in VTK's files",
                          {0, 2, 5, 1, 4, 3}},
        ComponentOrder<3>{"xx yy zz yz xz xy, not xx xy yy xz yz zz", {0, 5, 1, 4, 3, 2}}};
}

/// If all tensors are metrics in another order of components, a hint that it is theirs.
template <int Dim>
std::string suspected_order(const AnyField& field) {
  if (field.types[0] != Type::symmetric || field.dimension != Dim) return {};
  for (const ComponentOrder<Dim>& order : other_orders<Dim>()) {
    bool all = true;
    for (std::size_t v = 0; all && v < field.vertex_count; ++v) {
      Metric<Dim> metric;
      for (std::size_t k = 0; k < metric.m.size(); ++k)
        metric.m[k] = field.values[v * Metric<Dim>::size + order.from[k]];
      all = in_range(metric);
    }
    if (all)
      return "; the order of components may be " + std::string(order.text) +
             ": all tensors are positive definite in that order";
  }
  return {};
}

template <int Dim>
void expect_metric(const AnyField& field, std::size_t vertex, const Metric<Dim>& metric) {
  if (surely_in_range(metric)) return;
  const bool huge = std::any_of(metric.m.begin(), metric.m.end(),
                                [](double x) { return !(std::abs(x) < 1e151); });
  if (huge)
    fail_at(field, vertex, "a tensor of sizes from 1e-75 to 1e75",
            "components beyond 1e150 or no numbers");
  const auto values = principal_axes(metric).value;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const double shortest = 1 / std::sqrt(*largest);
  const double longest = 1 / std::sqrt(*smallest);
  switch (range_fault(values)) {
    case RangeFault::nothing:
      return;
    case RangeFault::indefinite:
      fail_at(field, vertex, "a positive definite tensor",
              "eigenvalues from " + number(*smallest) + " to " + number(*largest) +
                  suspected_order<Dim>(field));
    case RangeFault::size:
      fail_at(field, vertex, "sizes from 1e-75 to 1e75",
              number(shortest) + " to " + number(longest));
    case RangeFault::anisotropy:
      fail_at(field, vertex,
              "sizes that differ by at most " + number(largest_anisotropy) + " times",
              number(shortest) + " to " + number(longest));
  }
}

/// A size that is none by itself, but large or small, is the bound. A size of 0 is none at all.
double within_bounds(double size, const SizeBounds& bounds) {
  if (size > largest_size && bounds.largest > 0) return bounds.largest;
  if (size > 0 && size < smallest_size && bounds.smallest > 0) return bounds.smallest;
  return size;
}

template <int Dim>
void append_isotropic(AnyField& result, const AnyField& field, std::size_t vertex,
                      const SizeBounds& bounds) {
  const double size = within_bounds(field.values[vertex], bounds);
  if (!(size >= smallest_size && size <= largest_size))
    fail_at(field, vertex, "a size from 1e-75 to 1e75", number(size));
  const Metric<Dim> metric = isotropic<Dim>(size);
  result.values.insert(result.values.end(), metric.m.begin(), metric.m.end());
}

/// The tensor of a full matrix, which rounding may have made a little unsymmetric.
template <int Dim>
Metric<Dim> tensor_of_matrix(const AnyField& field, std::size_t vertex) {
  constexpr double rounding = 1e-6;
  const auto at = [&](std::size_t row, std::size_t column) {
    return field.values[(vertex * Dim + row) * Dim + column];
  };
  double trace = 0;
  for (std::size_t i = 0; i < Dim; ++i) trace += std::abs(at(i, i));
  Metric<Dim> metric;
  double* component = metric.m.data();
  for (std::size_t j = 0; j < Dim; ++j)
    for (std::size_t i = 0; i <= j; ++i) {
      if (std::abs(at(i, j) - at(j, i)) > rounding * trace)
        fail_at(field, vertex, "a symmetric matrix",
                number(at(i, j)) + " in row " + std::to_string(i) + ", column " +
                    std::to_string(j) + " and " + number(at(j, i)) + " opposite");
      *component++ = i == j ? at(i, i) : 0.5 * at(i, j) + 0.5 * at(j, i);
    }
  return metric;
}

/// The tensor at a vertex of a field of this dimension.
template <int Dim>
Metric<Dim> tensor_at(const AnyField& field, std::size_t vertex) {
  if (field.types[0] == Type::matrix) return tensor_of_matrix<Dim>(field, vertex);
  Metric<Dim> metric;
  std::copy_n(&field.values[vertex * Metric<Dim>::size], metric.m.size(), metric.m.begin());
  return metric;
}

/// Which components of a tensor in space are those in a coordinate plane, and which lead out of it.
struct PlanePart {
  std::array<std::size_t, 3> in;
  std::array<std::size_t, 2> out;
};
constexpr std::array<PlanePart, 3> plane_without{
    // [axis]
    {{{2, 4, 5}, {1, 3}}, {{0, 3, 5}, {1, 4}}, {{0, 1, 2}, {3, 4}}}};

/// The part in the plane of a flat mesh of a tensor in space.
Metric<2> plane_part(const AnyField& field, std::size_t vertex, int dropped_axis) {
  constexpr double rounding = 1e-6;
  const PlanePart& part = plane_without.at(static_cast<std::size_t>(dropped_axis));
  const auto values = tensor_at<3>(field, vertex).m;
  const double trace = std::abs(values[0]) + std::abs(values[2]) + std::abs(values[5]);
  for (const std::size_t out : part.out)
    if (!(std::abs(values[out]) <= rounding * trace))
      fail_at(field, vertex, "a tensor without components out of the plane, as the mesh is flat",
              number(values[part.out[0]]) + " and " + number(values[part.out[1]]));
  return {{values[part.in[0]], values[part.in[1]], values[part.in[2]]}};
}

template <int Dim>
void append_tensor(AnyField& result, const AnyField& field, std::size_t vertex,
                   const SizeBounds& bounds, int dropped_axis) {
  Metric<Dim> metric;
  if constexpr (Dim == 2)
    if (field.dimension == 3) metric = plane_part(field, vertex, dropped_axis);
  if (field.dimension == Dim) metric = tensor_at<Dim>(field, vertex);
  if (has_bounds(bounds) && !in_range(metric)) metric = meshadapt::within_bounds(metric, bounds);
  expect_metric(field, vertex, metric);
  result.values.insert(result.values.end(), metric.m.begin(), metric.m.end());
}

/// [vertex] Where its value is read: at the vertex itself, or, if no element has the vertex, at the
/// first that one has, because such a value does not matter.
template <int Dim>
std::vector<std::size_t> places_of_values(const AnyMesh& mesh) {
  std::vector<std::size_t> place_of(mesh.vertex_count(), no_index);
  for (const auto& corners : elements_in<Dim>(mesh).vertices)
    for (const std::uint32_t v : corners)
      if (v < place_of.size()) place_of[v] = v;
  const auto first = std::find_if(place_of.begin(), place_of.end(),
                                  [](std::size_t place) { return place != no_index; });
  for (std::size_t v = 0; v < place_of.size(); ++v)
    if (place_of[v] == no_index) place_of[v] = first == place_of.end() ? v : *first;
  return place_of;
}

template <int Dim>
void append_metrics(AnyField& result, const AnyField& field, const SizeBounds& bounds,
                    const AnyMesh& mesh) {
  for (const std::size_t vertex : places_of_values<Dim>(mesh))
    if (field.types[0] == Type::scalar)
      append_isotropic<Dim>(result, field, vertex, bounds);
    else
      append_tensor<Dim>(result, field, vertex, bounds, mesh.dropped_axis);
}

}  // namespace

AnyField metric_of(const AnyField& field, const AnyMesh& mesh, const SizeBounds& bounds) {
  expect_bounds(bounds);
  expect_one_metric(field, mesh);
  AnyField result;
  result.name = field.name;
  result.dimension = mesh.dimension;
  result.vertex_count = field.vertex_count;
  result.types = {Type::symmetric};
  result.values.reserve(field.vertex_count * stride_of(result));
  mesh.dimension == 2 ? append_metrics<2>(result, field, bounds, mesh)
                      : append_metrics<3>(result, field, bounds, mesh);
  return result;
}

void expect_field_of(const AnyField& field, const AnyMesh& mesh) {
  expect_values_of(field, mesh, field.dimension == mesh.dimension);
}

template <int Dim>
std::vector<Metric<Dim>> tensors_of(const runtime::Executor& executor, const AnyField& field,
                                    std::size_t component) {
  expect_values(field);
  const std::size_t stride = stride_of(field);
  if (field.dimension != Dim || component > stride || stride - component < Metric<Dim>::size)
    throw InputError(name_of(field) + ": expected tensors of dimension " + std::to_string(Dim) +
                     " from component " + std::to_string(component) + " on, found " +
                     std::to_string(stride) + " components of dimension " +
                     std::to_string(field.dimension));
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
