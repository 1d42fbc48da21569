#include "support/rest_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::test {

namespace {

/// A metric with sizes along an axis and across it that depend on the position.
template <int Dim>
struct Formula {
  enum class Kind { constant, growing, plane, shell } kind;
  Vector<Dim> normal, centre;
  double thin;          ///< smallest size across, relative to that along
  Metric<Dim> uniform;  ///< for the kind `constant`

  Metric<Dim> operator()(const Vector<Dim>& at) const {
    const Vector<Dim> from = at - centre;
    const double radius = std::max(1e-9, norm(from));
    if (kind == Kind::constant) return uniform;
    if (kind == Kind::growing) return isotropic<Dim>(std::min(1.0, thin + radius));
    const Vector<Dim> across = kind == Kind::plane ? normal : (1 / radius) * from;
    const double distance = std::abs(kind == Kind::plane ? dot(from, normal) : radius - 0.4);
    const double size = std::min(1.0, thin + 2 * distance);
    Metric<Dim> metric = isotropic<Dim>(1);
    for (int column = 0, k = 0; column < Dim; ++column)
      for (int row = 0; row <= column; ++row, ++k)
        metric.m[static_cast<std::size_t>(k)] +=
            (1 / (size * size) - 1) * across[row] * across[column];
    return metric;
  }
};

template <int Dim>
Formula<Dim> random_formula(Random& random, std::string& what) {
  static constexpr std::array names{"constant", "growing", "plane", "shell"};
  const std::size_t kind = below(random, names.size());
  Formula<Dim> formula;
  formula.kind = static_cast<typename Formula<Dim>::Kind>(kind);
  for (int i = 0; i < Dim; ++i) formula.normal[i] = uniform(random, -1, 1);
  formula.normal = (1 / norm(formula.normal)) * formula.normal;
  for (int i = 0; i < Dim; ++i) formula.centre[i] = uniform(random, 0.1, 0.9);
  formula.thin = std::pow(10.0, -uniform(random, 0.3, Dim == 2 ? 1.5 : 1));
  std::array<double, Dim> sizes;
  for (double& size : sizes) size = chance(random, 0.5) ? 1 : uniform(random, 0.1, 1);
  formula.uniform = random_metric<Dim>(random, sizes);
  what += std::string(", ") + names[kind] + ", thin " + std::to_string(formula.thin);
  return formula;
}

template <int Dim>
void set_metric(RestCase& made, Random& random) {
  const Formula<Dim> formula = random_formula<Dim>(random, made.what);
  const auto unscaled = [formula](const AnyMesh& mesh) {
    return metric_field<Dim>(mesh, [&](std::uint32_t v) { return formula(point<Dim>(mesh, v)); });
  };
  const double wanted =
      std::pow(10.0, Dim == 2 ? uniform(random, 1.5, 3) : uniform(random, 1, 2.3));
  const double factor = std::pow(wanted / complexity(made.mesh, unscaled(made.mesh)), 2.0 / Dim);
  made.metric_on = [=](const AnyMesh& mesh) {
    AnyField field = unscaled(mesh);
    for (double& value : field.values) value *= factor;
    return field;
  };
}

AnyMesh random_shape(Random& random, int dimension, std::string& what) {
  const int n = dimension == 2 ? 3 + static_cast<int>(below(random, 12))
                               : 2 + static_cast<int>(below(random, 4));
  Grid grid = unit_grid(dimension, n);
  grid.seed = random();
  const std::size_t shape = below(random, 5);
  if (shape == 1) grid.region = l_shape(n);
  if (shape == 2 && n > 2) grid.region = with_hole(n);
  if (shape == 3) grid.region = two_halves(n);
  if (shape == 4) grid.region = random_regions(random(), 3, false);
  AnyMesh mesh = make_grid(grid, chance(random, 0.7));
  if (chance(random, 0.7)) jiggle(mesh, random, uniform(random, 0, 0.4));
  what += ", shape " + std::to_string(shape) + " of " + std::to_string(n);
  return mesh;
}

std::vector<std::uint32_t> some(Random& random, std::size_t count) {
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < count; ++i)
    if (chance(random, 0.03)) chosen.push_back(i);
  return chosen;
}

void choose_options(RestCase& made, Random& random) {
  AnyMesh& mesh = made.mesh;
  if (chance(random, 0.3)) {
    bend(mesh, uniform(random, 0.5, 2));
    made.options.make.hausdorff_tolerance = std::pow(10.0, -uniform(random, 1, 3));
    made.what += ", bent, tolerance " + std::to_string(made.options.make.hausdorff_tolerance);
  } else if (chance(random, 0.2)) {
    made.options.gradation = uniform(random, 1.2, 2);
    made.what += ", gradation";
  }
  if (chance(random, 0.3)) {
    mesh.required_vertices = some(random, mesh.vertex_count());
    mesh.required_edges = some(random, mesh.edges.size());
    mesh.required_triangles = some(random, mesh.triangles.size());
    made.what += ", required entities";
  }
  if (chance(random, 0.1)) made.options.thorough = true, made.what += ", thorough";
  if (chance(random, 0.05)) made.options.move = false, made.what += ", no moves";
  if (chance(random, 0.05)) made.options.swap = false, made.what += ", no swaps";
  if (chance(random, 0.05)) made.options.insert = false, made.what += ", no insertion";
}

}  // namespace

RestCase rest_case(std::uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15U + 3);
  random.discard(10);
  const int dimension = seed % 2 == 0 ? 2 : 3;
  RestCase made;
  made.what = std::to_string(dimension) + "D";
  made.mesh = random_shape(random, dimension, made.what);
  choose_options(made, random);
  dimension == 2 ? set_metric<2>(made, random) : set_metric<3>(made, random);
  return made;
}

}  // namespace ductile::meshadapt::test
