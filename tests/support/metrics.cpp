#include "support/metrics.hpp"
#include "core/determinant.hpp"

#include <algorithm>
#include <cmath>

namespace ductile::meshadapt::test {

namespace {

template <int Dim>
Vector<Dim> random_direction(Random& random) {
  for (;;) {
    Vector<Dim> d;
    for (double& x : d.x) x = uniform(random, -1, 1);
    const double length = norm(d);
    if (length > 0.1 && length < 1) return (1 / length) * d;
  }
}

template <int Dim>
Metric<Dim> metric_at(const AnyField& field, std::size_t vertex) {
  Metric<Dim> metric;
  std::copy_n(&field.values[vertex * Metric<Dim>::size], Metric<Dim>::size, metric.m.begin());
  return metric;
}

template <int Dim>
double complexity_in(const AnyMesh& mesh, const AnyField& field) {
  double sum = 0;
  for (const auto& corners : elements<Dim>(mesh).vertices) {
    std::array<Vector<Dim>, Dim + 1> p;
    double density = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      p[i] = point<Dim>(mesh, corners[i]);
      density += std::sqrt(std::max(0.0, determinant(metric_at<Dim>(field, corners[i]))));
    }
    sum += std::abs(certain_determinant<Dim>(p)) / (Dim == 2 ? 2 : 6) * density / (Dim + 1);
  }
  return sum;
}

template <int Dim>
AnyField wild_in(const AnyMesh& mesh, Random& random, double jump, double anisotropy) {
  return metric_field<Dim>(mesh, [&](std::uint32_t) {
    const double size = std::pow(jump, uniform(random, 0, 1));
    std::array<double, Dim> sizes;
    for (double& h : sizes) h = size * std::pow(anisotropy, uniform(random, 0, 1));
    return random_metric<Dim>(random, sizes);
  });
}

template <int Dim>
AnyField layer_in(const AnyMesh& mesh, Random& random, double thin) {
  const Vector<Dim> normal = random_direction<Dim>(random);
  const Vector<Dim> origin =
      point<Dim>(mesh, static_cast<std::uint32_t>(below(random, mesh.vertex_count())));
  double extent = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    extent = std::max(extent, norm(point<Dim>(mesh, v) - origin));
  return metric_field<Dim>(mesh, [&](std::uint32_t v) {
    const double distance = std::abs(dot(point<Dim>(mesh, v) - origin, normal)) / extent;
    const double across = std::min(1.0, thin + distance);
    Metric<Dim> metric = isotropic<Dim>(1);
    for (int column = 0, at = 0; column < Dim; ++column)
      for (int row = 0; row <= column; ++row, ++at)
        metric.m[static_cast<std::size_t>(at)] +=
            (1 / (across * across) - 1) * normal[row] * normal[column];
    return metric;
  });
}

}  // namespace

template <int Dim>
Metric<Dim> random_metric(Random& random, const std::array<double, Dim>& sizes) {
  PrincipalAxes<Dim> axes;
  for (std::size_t i = 0; i < Dim; ++i) axes.value[i] = 1 / (sizes[i] * sizes[i]);
  axes.vector[0] = random_direction<Dim>(random);
  if constexpr (Dim == 2) {
    axes.vector[1] = {{-axes.vector[0][1], axes.vector[0][0]}};
  } else {
    Vector<3> other = cross(axes.vector[0], random_direction<3>(random));
    while (norm(other) < 0.1) other = cross(axes.vector[0], random_direction<3>(random));
    axes.vector[1] = (1 / norm(other)) * other;
    axes.vector[2] = cross(axes.vector[0], axes.vector[1]);
  }
  return compose(axes);
}

template Metric<2> random_metric<2>(Random&, const std::array<double, 2>&);
template Metric<3> random_metric<3>(Random&, const std::array<double, 3>&);

AnyField wild_field(const AnyMesh& mesh, Random& random, double jump, double anisotropy) {
  return mesh.dimension == 2 ? wild_in<2>(mesh, random, jump, anisotropy)
                             : wild_in<3>(mesh, random, jump, anisotropy);
}

AnyField layer_field(const AnyMesh& mesh, Random& random, double thin) {
  return mesh.dimension == 2 ? layer_in<2>(mesh, random, thin) : layer_in<3>(mesh, random, thin);
}

double complexity(const AnyMesh& mesh, const AnyField& field) {
  return mesh.dimension == 2 ? complexity_in<2>(mesh, field) : complexity_in<3>(mesh, field);
}

void scale_to(AnyField& field, const AnyMesh& mesh, double wanted_complexity) {
  const double factor = std::pow(wanted_complexity / complexity(mesh, field), 2.0 / mesh.dimension);
  for (double& value : field.values) value *= factor;
}

}  // namespace ductile::meshadapt::test
