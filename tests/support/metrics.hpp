/// @file
/// Metric fields to test with, from simple to hard.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

/// A metric with random axes that asks for these sizes along them.
template <int Dim>
Metric<Dim> random_metric(Random& random, const std::array<double, Dim>& sizes);

/// Largest difference between the entries of two metrics, each over the root of the product of the
/// first one's diagonal entries in its row and column.
template <int Dim>
double difference(const Metric<Dim>& a, const Metric<Dim>& b) {
  double most = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j)
      most = std::max(most, std::abs(a(i, j) - b(i, j)) / std::sqrt(a(i, i) * a(j, j)));
  return most;
}

/// A field with a metric of make(vertex) at each vertex.
template <int Dim, class Make>
AnyField metric_field(const AnyMesh& mesh, Make&& make) {
  AnyField field;
  field.dimension = Dim;
  field.vertex_count = mesh.vertex_count();
  field.types = {AnyField::Type::symmetric};
  field.name = "test.sol";
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Metric<Dim> metric = make(v);
    field.values.insert(field.values.end(), metric.m.begin(), metric.m.end());
  }
  return field;
}

/// Random axes and sizes at every vertex: sizes differ by up to the factor `jump` between vertices,
/// and by up to `anisotropy` between directions.
AnyField wild_field(const AnyMesh& mesh, Random& random, double jump, double anisotropy);

/// A layer across the mesh: sizes grow from `thin` times their value elsewhere with the distance
/// from a random plane, in its normal direction only.
AnyField layer_field(const AnyMesh& mesh, Random& random, double thin);

/// Integral of sqrt(det metric): about 0.43 times the triangles, 0.12 times the tetrahedra wanted.
double complexity(const AnyMesh& mesh, const AnyField& field);

/// Scales the field, the same everywhere, to this complexity.
void scale_to(AnyField& field, const AnyMesh& mesh, double wanted_complexity);

}  // namespace ductile::meshadapt::test
