#include "ductile/meshadapt/metric_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/indices.hpp"
#include "mesh/scale.hpp"
#include "mesh/wording.hpp"
#include "metric/metric_of_element.hpp"

namespace ductile::meshadapt {

namespace {

AnyField isotropic_field(const AnyMesh& mesh, const std::vector<double>& size_of) {
  AnyField field{mesh.dimension, mesh.vertex_count(), {AnyField::Type::symmetric}, {}, mesh.name};
  const std::size_t stride = stride_of(field);
  field.values.assign(stride * field.vertex_count, 0.0);
  for (std::size_t v = 0; v < field.vertex_count; ++v)
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(mesh.dimension); ++axis)
      field.values[v * stride + axis * (axis + 3) / 2] = 1 / (size_of[v] * size_of[v]);
  return field;
}

void expect_sizes(const AnyMesh& mesh, const std::vector<double>& size_of) {
  const auto bad = std::find_if(size_of.begin(), size_of.end(), [](double size) {
    return !(size >= smallest_size && size <= largest_size);
  });
  if (bad == size_of.end()) return;
  const auto vertex = static_cast<std::size_t>(bad - size_of.begin());
  refuse(name_of(mesh) + ": expected edges of lengths from 1e-75 to 1e75, found " + number(*bad) +
         " at vertex " + index_word(vertex) + "; scale the mesh");
}

/// The size that the mesh has at each vertex, alike in all directions: the mean, of logarithms, of
/// the lengths of its edges, counted per element.
template <int Dim, int Space = Dim>
std::vector<double> sizes_in(const AnyMesh& mesh) {
  expect_coordinates(mesh);
  std::vector<double> log_of(mesh.vertex_count());
  std::vector<std::uint32_t> count_of(mesh.vertex_count());
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e) {
    if (names_others<Dim>(mesh, e)) refuse_corners<Dim>(mesh, e);
    const Corners<Dim>& corner = elements_in<Dim>(mesh).vertices[e];
    for (std::size_t i = 0; i < corner.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double length =
            norm(position_in<Space>(mesh, corner[i]) - position_in<Space>(mesh, corner[j]));
        if (!(length > 0)) continue;
        for (const VertexId v : {corner[i], corner[j]}) {
          log_of[v] += std::log(length);
          ++count_of[v];
        }
      }
  }
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < log_of.size(); ++v) {
    sum += log_of[v];
    count += count_of[v];
  }
  std::vector<double> size_of(log_of.size(), count > 0 ? std::exp(sum / count) : 1);
  for (std::size_t v = 0; v < size_of.size(); ++v)
    if (count_of[v] > 0) size_of[v] = std::exp(log_of[v] / count_of[v]);
  expect_sizes(mesh, size_of);
  return size_of;
}

template <int Dim, int Space = Dim>
class DefaultMetric {
 public:
  DefaultMetric(const runtime::Executor& executor, const AnyMesh& mesh)
      : executor_(executor),
        size_of_(sizes_in<Dim, Space>(mesh)),  // which checks the mesh, too
        mesh_(mesh),
        lists_(list_elements<Dim>(executor, elements_in<Dim>(mesh).vertices, mesh.vertex_count())),
        log_of_(elements_in<Dim>(mesh).size()),
        volume_of_(log_of_.size()) {
    runtime::parallel_for(executor_, log_of_.size(), [&](std::size_t e) {
      const auto corner = points_in<Space>(mesh, elements_in<Dim>(mesh).vertices[e]);
      volume_of_[e] = measure_of(corner);
      if (volume_of_[e] > 0) log_of_[e] = logarithm(metric_of_element<Dim>(corner));
    });
  }

  AnyField field() const {
    std::vector<Metric<Space>> metric_of(mesh_.vertex_count());
    runtime::parallel_for(executor_, metric_of.size(), [&](std::size_t v) {
      metric_of[v] = metric_at(static_cast<VertexId>(v));
    });
    return symmetric_field(executor_, metric_of, mesh_.name);
  }

 private:
  /// Volume times 2 or 6, rounding and all.
  static double measure_of(const std::array<Vector<Space>, Dim + 1>& corner) {
    if constexpr (Dim < Space)
      return norm(facet_normal(corner));
    else
      return std::abs(plain_determinant(corner));
  }

  Metric<Space> metric_at(VertexId v) const {
    double volume = 0;
    for (const ElementId e : lists_.elements_of(v)) volume += volume_of_[e];
    if (!(volume > 0)) return isotropic<Space>(size_of_[v]);
    Metric<Space> mean;
    for (const ElementId e : lists_.elements_of(v))
      if (volume_of_[e] > 0) mean += volume_of_[e] / volume * log_of_[e];
    const Metric<Space> shape = exponential(without_little_stretch(mean));
    return std::exp(-2 * mean_log_length(shape, v)) * shape;
  }

  /// The mean logarithm of the lengths of a vertex's edges, counted per element.
  double mean_log_length(const Metric<Space>& metric, VertexId v) const {
    double sum = 0;
    int count = 0;
    for (const ElementId e : lists_.elements_of(v))
      for (const VertexId w : elements_in<Dim>(mesh_).vertices[e]) {
        const double square =
            squared_length(metric, position_in<Space>(mesh_, w) - position_in<Space>(mesh_, v));
        if (!(square > 0)) continue;  // v itself, or where it is but for rounding
        sum += std::log(square) / 2;
        ++count;
      }
    return count > 0 ? sum / count : 0;
  }

  const runtime::Executor& executor_;
  std::vector<double> size_of_;  // [vertex]
  const AnyMesh& mesh_;
  VertexElements lists_;
  std::vector<Metric<Space>> log_of_;  // [element], unset where the element is flat
  std::vector<double> volume_of_;      // [element], times 2 or 6
};

template <int Dim, int Space = Dim>
AnyField implied_tensors_in(const runtime::Executor& executor, const AnyMesh& any) {
  const auto mesh = make_fixed_mesh<Dim, Space>(executor, any);
  std::vector<Metric<Space>> weighted(mesh.element_count());  // logarithms, times the volume
  runtime::parallel_for(executor, weighted.size(), [&](std::size_t e) {
    const auto metric = metric_of_element<Dim>(mesh.points(static_cast<ElementId>(e)));
    weighted[e] = mesh.volume_of[e] * logarithm(metric);
  });
  std::vector<Metric<Space>> metric_of(mesh.vertex_count(), isotropic<Space>(1));
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    if (!(mesh.share_of[v] > 0)) return;
    Metric<Space> sum;
    for (const ElementId e : mesh.elements_of(static_cast<VertexId>(v))) sum += weighted[e];
    metric_of[v] = exponential(1 / ((Dim + 1) * mesh.share_of[v]) * sum);
  });
  return symmetric_field(executor, metric_of, any.name);
}

}  // namespace

AnyField constant_metric(const AnyMesh& mesh, double size) {
  expect_coordinates(mesh);
  if (!(size >= smallest_size && size <= largest_size))
    throw InputError("size: expected a length from 1e-75 to 1e75, found " + number(size));
  return isotropic_field(mesh, std::vector<double>(mesh.vertex_count(), size));
}

AnyField coarsest_metric(const AnyMesh& mesh, double largest_size) {
  expect_coordinates(mesh);
  const double diagonal = diagonal_of(mesh);
  const double size =
      diagonal > 0 ? std::clamp(diagonal, smallest_size, meshadapt::largest_size) : 1;
  return constant_metric(mesh, largest_size != 0 ? largest_size : size);
}

AnyField default_metric(const runtime::Executor& executor, const AnyMesh& mesh) {
  if (is_surface(mesh)) return DefaultMetric<2, 3>(executor, mesh).field();
  return mesh.dimension == 2 ? DefaultMetric<2>(executor, mesh).field()
                             : DefaultMetric<3>(executor, mesh).field();
}

AnyField implied_metric(const AnyMesh& mesh) {
  if (is_surface(mesh)) return isotropic_field(mesh, sizes_in<2, 3>(mesh));
  return isotropic_field(mesh, mesh.dimension == 2 ? sizes_in<2>(mesh) : sizes_in<3>(mesh));
}

AnyField implied_tensors(const runtime::Executor& executor, const AnyMesh& mesh) {
  if (is_surface(mesh)) return implied_tensors_in<2, 3>(executor, mesh);
  return mesh.dimension == 2 ? implied_tensors_in<2>(executor, mesh)
                             : implied_tensors_in<3>(executor, mesh);
}

}  // namespace ductile::meshadapt
