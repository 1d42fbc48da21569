#include "metrics.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "facets.hpp"
#include "geometry.hpp"
#include "tensor.hpp"

namespace ductile::campaign {
namespace {

using TensorAt = std::function<Tensor(const Point&)>;  // at a point of the unit cube

class MetricMaker {
 public:
  MetricMaker(Random& random, const Mesh& mesh)
      : random_(random), mesh_(mesh), box_(box_of(mesh.points)), unit_(normalised(mesh, box_)) {}

  MetricCase make(const TensorAt& tensor_at_point, bool as_sizes) {
    for (const Point& point : unit_.points) tensors_.push_back(tensor_at_point(point));
    const double factor = scaling();
    MetricCase made;
    made.size = box_.extent() / factor * mean_size_;
    const double power = factor * factor / (box_.extent() * box_.extent());
    made.field.dimension = mesh_.dimension;
    made.field.components = as_sizes ? 1 : mesh_.dimension == 2 ? 3 : 6;
    double largest = 0;
    for (const Tensor& tensor : tensors_) {
      largest = std::max({largest, tensor[0], tensor[2], mesh_.dimension == 3 ? tensor[5] : 0});
      if (as_sizes)
        made.field.values.push_back(1 / std::sqrt(power * tensor[0]));
      else
        for (int i = 0; i < made.field.components; ++i)
          made.field.values.push_back(power * tensor[static_cast<std::size_t>(i)]);
    }
    made.smallest = 1 / std::sqrt(power * largest);
    return made;
  }

 private:
  /// The factor for all lengths that keeps the number of elements, the longest edge and, in 3D, the
  /// area of the boundary within bounds, all measured in the metric.
  double scaling() {
    if (mesh_.surface) return surface_scaling();
    const bool flat = mesh_.dimension == 2;
    double complexity = 0, volume = 0;
    for (const Cell& element : unit_.elements().corners) {
      double density = 0;
      for (int i = 0; i <= mesh_.dimension; ++i)
        density += std::sqrt(std::max(
            0.0,
            determinant(tensors_[static_cast<std::size_t>(element[static_cast<std::size_t>(i)])])));
      const double size = std::abs(measure(unit_, element));
      volume += size;
      complexity += size * density / (mesh_.dimension + 1);
    }
    double target = random_.power(0.5, flat ? 2.7 : 1.9);
    if (random_.chance(0.05)) target = random_.power(-6, 0);
    mean_size_ = std::pow(volume / complexity, 1.0 / mesh_.dimension);
    double factor = std::pow(target / complexity, 1.0 / mesh_.dimension);
    double longest = 0, sum = 0;
    for (const auto& edge : edges_of(unit_.elements().corners, mesh_.corner_count())) {
      const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
      const Point along = unit_.points[b] - unit_.points[a];
      const double length =
          std::sqrt(std::max(square_length(tensors_[a], along), square_length(tensors_[b], along)));
      longest = std::max(longest, length);
      sum += length;
    }
    factor = std::min({factor, (flat ? 60 : 15) / longest, (flat ? 3000 : 4000) / sum});
    if (!flat) factor = std::min(factor, std::sqrt(600 / boundary_area()));
    return factor;
  }

  /// For some tens to some thousands of triangles.
  double surface_scaling() {
    double area = 0, plain = 0, longest = 0;
    for (const Cell& element : unit_.elements().corners) {
      area += area_of(element);
      plain += measure(unit_, element);
    }
    for (const auto& edge : edges_of(unit_.elements().corners, 3))
      for (const int end : edge)
        longest = std::max(
            longest, std::sqrt(square_length(tensors_[static_cast<std::size_t>(end)],
                                             unit_.points[static_cast<std::size_t>(edge[1])] -
                                                 unit_.points[static_cast<std::size_t>(edge[0])])));
    area = std::max(area, 1e-300);
    mean_size_ = std::sqrt(plain / area);
    return std::min(std::sqrt(random_.power(1, 3.3) / area), 40 / longest);
  }

  /// The area of a triangle in the metric.
  double area_of(const Cell& triangle) const {
    const Tensor& m = tensors_[static_cast<std::size_t>(triangle[0])];
    const Point a = corner(unit_, triangle, 1) - corner(unit_, triangle, 0);
    const Point b = corner(unit_, triangle, 2) - corner(unit_, triangle, 0);
    const double aa = square_length(m, a), bb = square_length(m, b);
    const double ab = (square_length(m, a + b) - aa - bb) / 2;
    return std::sqrt(std::max(0.0, aa * bb - ab * ab)) / 2;
  }

  double boundary_area() const {
    double area = 0;
    for (const Facet& facet : facets_of(unit_))
      if (facet.on_boundary()) area += area_of(facet.corners);
    return std::max(area, 1e-300);
  }

  Random& random_;
  const Mesh& mesh_;
  Box box_;
  Mesh unit_;
  std::vector<Tensor> tensors_;
  double mean_size_ = 1;
};

const std::array<Point, 3> straight_axes = {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};

Tensor isotropic(double size) { return tensor_of(straight_axes, {size, size, size}); }

/// In 2D the third size is 1, so that the determinant is that of the plane.
Tensor in_dimension(const Mesh& mesh, const std::array<Point, 3>& axes, Point sizes) {
  if (mesh.dimension == 2) sizes[2] = 1;
  return tensor_of(axes, sizes);
}

Point random_sizes(Random& random, double largest_ratio) {
  const double range = std::log10(largest_ratio);
  return {random.power(-range, 0), random.power(-range, 0), random.power(-range, 0)};
}

/// Small sizes across a sphere, large ones along it.
TensorAt layer(const Mesh& mesh, Random& random, double thin) {
  const Point middle = mesh.dimension == 2 ? Point{0.5, 0.5, 0} : Point{0.5, 0.5, 0.5};
  const double radius = random.uniform(0.2, 0.5);
  const int dimension = mesh.dimension;
  return [=](const Point& x) {
    const Point out = x - middle;
    const double r = norm(out) + 1e-9;
    const double across = std::min(0.3, thin + 0.5 * std::abs(r - radius));
    const Point n = (1 / r) * out;
    const double wide = 1 / 0.09, extra = 1 / (across * across) - wide;
    return Tensor{wide + extra * n[0] * n[0], extra * n[0] * n[1],
                  wide + extra * n[1] * n[1], extra * n[0] * n[2],
                  extra * n[1] * n[2],        dimension == 2 ? 1 : wide + extra * n[2] * n[2]};
  };
}

/// Axes that turn with position.
TensorAt turning(const Mesh& mesh, Random& random, double ratio) {
  const double turns = random.uniform(0.5, 6), phase = random.uniform(0, 6);
  const Point sizes = {1 / ratio, 1, mesh.dimension == 2 ? 1 : random.pick({1.0, 1 / ratio})};
  return [=](const Point& x) {
    const double turn = turns * (x[0] + x[1] + x[2]) + phase, c = std::cos(turn),
                 s = std::sin(turn);
    return tensor_of({Point{c, s, 0}, Point{-s, c, 0}, Point{0, 0, 1}}, sizes);
  };
}

}  // namespace

MetricCase uniform_metric(Random& random, const Mesh& mesh) {
  return MetricMaker(random, mesh).make([](const Point&) { return isotropic(1); }, true);
}

MetricCase random_metric(Random& random, const Mesh& mesh) {
  MetricMaker maker(random, mesh);
  const double ratio = random.power(0, random.chance(0.3) ? 6 : 3);
  const bool as_sizes = random.chance(0.5);
  const Point direction = {random.normal(), random.normal(), random.normal()};
  const Point at = random.point();
  const double level = random.normal() * 0.5;
  const auto dimensioned = [&](double size) {
    return in_dimension(mesh, straight_axes, {size, size, size});
  };
  switch (random.below(8)) {
    case 0:
      return maker.make([&](const Point&) { return dimensioned(1); }, as_sizes);
    case 1:
      return maker.make(
          [&](const Point& x) {
            return dimensioned(0.05 + 0.5 * std::abs(dot(x, direction) - level));
          },
          as_sizes);
    case 2: {
      const double least = random.power(-4, -1);
      return maker.make([&](const Point& x) { return dimensioned(least + 0.3 * norm(x - at)); },
                        as_sizes);
    }
    case 3: {
      const auto axes = random.axes(mesh.dimension);
      const Point sizes = random_sizes(random, ratio);
      return maker.make([&](const Point&) { return in_dimension(mesh, axes, sizes); }, false);
    }
    case 4:
      return maker.make(layer(mesh, random, 1 / ratio), false);
    case 5: {
      MetricCase made = maker.make(turning(mesh, random, std::min(ratio, 1e3)), false);
      made.smooth = false;
      return made;
    }
    case 6: {
      const auto axes = random.axes(mesh.dimension);
      const double jump = random.power(-2, 2);
      const Point sizes =
          random.chance(0.5) ? random_sizes(random, ratio) : Point{jump, jump, jump};
      MetricCase made = maker.make(
          [&](const Point& x) {
            return dot(x, direction) > level ? in_dimension(mesh, axes, sizes) : dimensioned(1);
          },
          false);
      made.smooth = false;
      return made;
    }
    default: {
      const double most = std::min(ratio, 100.0);
      MetricCase made = maker.make(
          [&](const Point&) {
            return in_dimension(mesh, random.axes(mesh.dimension), random_sizes(random, most));
          },
          false);
      made.smooth = false;
      return made;
    }
  }
}

MetricCase strong_metric(Random& random, const Mesh& mesh) {
  MetricMaker maker(random, mesh);
  const bool exact = random.chance(0.4), aligned = exact || random.chance(0.4);
  const double ratio = exact ? 1e8 : random.power(6, aligned ? 8 : 7.9);
  const auto axes = aligned ? straight_axes : random.axes(mesh.dimension);
  const Point sizes = {1 / ratio, 1, random.pick({1.0, 1 / ratio})};
  MetricCase made =
      maker.make([&](const Point&) { return in_dimension(mesh, axes, sizes); }, false);
  // Rounding of rotated tensors may remove the smaller eigenvalue.
  if (!aligned && ratio > 1e6) made.refusals = {"positive definite", "anisotropy", "differ by"};
  return made;
}

MetricCase unlimited_metric(Random& random, const Mesh& mesh) {
  MetricCase made = uniform_metric(random, mesh);
  made.unlimited = true;
  const bool everywhere = random.chance(0.3);
  const auto spared = [&] { return !everywhere && random.chance(0.5); };
  if (random.chance(0.5)) {
    const double size = random.pick({1e300, 1e200, std::numeric_limits<double>::infinity(), 1e80});
    for (double& value : made.field.values)
      if (!spared()) value = size;
    return made;
  }
  const double m = 1 / (made.size * made.size);
  const std::size_t count = made.field.size();
  made.field.components = mesh.dimension == 2 ? 3 : 6;
  made.field.values.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const double other = spared() ? m : 0;
    if (mesh.dimension == 2)
      made.field.values.insert(made.field.values.end(), {m, 0, other});
    else
      made.field.values.insert(made.field.values.end(), {m, 0, other, 0, 0, other});
  }
  return made;
}

}  // namespace ductile::campaign
