#include "ductile/meshadapt/default_metric.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/indices.hpp"
#include "metric/metric_of_element.hpp"

namespace ductile::meshadapt {

namespace {

AnyField isotropic_field(const AnyMesh& mesh, const std::vector<double>& size_of) {
  AnyField field;
  field.dimension = mesh.dimension;
  field.vertex_count = mesh.vertex_count();
  field.types = {AnyField::Type::symmetric};
  field.name = mesh.name;
  const auto stride =
      static_cast<std::size_t>(component_count(AnyField::Type::symmetric, mesh.dimension));
  field.values.assign(stride * field.vertex_count, 0.0);
  for (std::size_t v = 0; v < field.vertex_count; ++v)
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(mesh.dimension); ++axis)
      field.values[v * stride + axis * (axis + 3) / 2] = 1 / (size_of[v] * size_of[v]);
  return field;
}

double distance(const AnyMesh& mesh, std::size_t a, std::size_t b) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  double squares = 0;
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const double d =
        mesh.coordinates[a * dimension + axis] - mesh.coordinates[b * dimension + axis];
    squares += d * d;
  }
  return std::sqrt(squares);
}

/// The logarithms of the edge lengths at each vertex, added up over the elements around it.
struct LogLengths {
  explicit LogLengths(std::size_t vertices) : sum(vertices), count(vertices) {}
  std::vector<double> sum;
  std::vector<std::uint32_t> count;
};

template <int Dim>
void add_elements(LogLengths& logs, const AnyMesh& mesh) {
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e) {
    if (names_others<Dim>(mesh, e)) refuse_corners<Dim>(mesh, e);
    const auto& corner = elements_in<Dim>(mesh).vertices[e];
    for (std::size_t i = 0; i < corner.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double length = distance(mesh, corner[i], corner[j]);
        if (!(length > 0)) continue;
        for (const std::uint32_t v : {corner[i], corner[j]}) {
          logs.sum[v] += std::log(length);
          ++logs.count[v];
        }
      }
    }
  }
}

void expect_sizes(const AnyMesh& mesh, const std::vector<double>& size_of) {
  const auto bad = std::find_if(size_of.begin(), size_of.end(), [](double size) {
    return !(size >= smallest_size && size <= largest_size);
  });
  if (bad == size_of.end()) return;
  std::ostringstream found;
  found << *bad;
  throw InputError(mesh.name + ": expected edges of lengths from 1e-75 to 1e75, found " +
                   found.str() + " at vertex " + std::to_string(bad - size_of.begin() + 1) +
                   "; scale the mesh");
}

template <int Dim>
AnyField implied_tensors_in(const runtime::Executor& executor, const AnyMesh& any) {
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  std::vector<Metric<Dim>> weighted(mesh.element_count());  // logarithms, times the volume
  runtime::parallel_for(executor, weighted.size(), [&](std::size_t e) {
    const auto metric = metric_of_element<Dim>(mesh.points(static_cast<ElementId>(e)));
    weighted[e] = mesh.volume_of[e] * logarithm(metric);
  });
  std::vector<Metric<Dim>> metric_of(mesh.vertex_count(), isotropic<Dim>(1));
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    if (!(mesh.share_of[v] > 0)) return;
    Metric<Dim> sum;
    for (const ElementId e : mesh.elements_of(static_cast<VertexId>(v))) sum += weighted[e];
    metric_of[v] = exponential(1 / ((Dim + 1) * mesh.share_of[v]) * sum);
  });
  return symmetric_field(executor, metric_of, any.name);
}

}  // namespace

AnyField constant_metric(const AnyMesh& mesh, double size) {
  return isotropic_field(mesh, std::vector<double>(mesh.vertex_count(), size));
}

AnyField implied_metric(const AnyMesh& mesh) {
  expect_coordinates(mesh);
  LogLengths logs(mesh.vertex_count());
  mesh.dimension == 2 ? add_elements<2>(logs, mesh) : add_elements<3>(logs, mesh);
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < logs.sum.size(); ++v) {
    sum += logs.sum[v];
    count += logs.count[v];
  }
  const double overall = count > 0 ? std::exp(sum / count) : 1;
  std::vector<double> size_of(mesh.vertex_count(), overall);
  for (std::size_t v = 0; v < size_of.size(); ++v)
    if (logs.count[v] > 0) size_of[v] = std::exp(logs.sum[v] / logs.count[v]);
  expect_sizes(mesh, size_of);
  return isotropic_field(mesh, size_of);
}

AnyField implied_tensors(const runtime::Executor& executor, const AnyMesh& mesh) {
  return mesh.dimension == 2 ? implied_tensors_in<2>(executor, mesh)
                             : implied_tensors_in<3>(executor, mesh);
}

}  // namespace ductile::meshadapt
