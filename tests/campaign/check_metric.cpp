#include <set>
#include <sstream>

#include "check.hpp"
#include "exact.hpp"
#include "facets.hpp"
#include "geometry.hpp"
#include "tensor.hpp"

namespace ductile::campaign {
namespace {

/// Is the tensor positive definite up to the rounding of its components? If sizes differ by 1e8,
/// doubles cannot tell more about the largest one.
bool is_metric(const double* metric, int dimension) {
  Tensor raised{};
  const int count = dimension == 2 ? 3 : 6;
  double largest = std::max(metric[0], metric[2]);
  if (dimension == 3) largest = std::max(largest, metric[5]);
  for (int i = 0; i < count; ++i) {
    const bool diagonal = i == 0 || i == 2 || i == 5;
    raised[static_cast<std::size_t>(i)] = metric[i] + (diagonal ? 1e-15 * largest : 0);
  }
  return is_positive_definite(raised.data(), dimension);
}

/// Is a size of `metric` shorter (sign -1) or longer (sign 1) than `size`, beyond rounding? False
/// if sign (1/size^2 (1 - sign .002) - metric) is negative definite.
bool beyond(const double* metric, int dimension, double size, int sign) {
  Tensor rest{};
  const int count = dimension == 2 ? 3 : 6;
  const double limit = (1 - sign * 0.002) / (size * size);
  for (int i = 0; i < count; ++i) {
    const bool diagonal = i == 0 || i == 2 || i == 5;
    rest[static_cast<std::size_t>(i)] = sign * (metric[i] - (diagonal ? limit : 0));
  }
  return !is_positive_definite(rest.data(), dimension);
}

void check_definite(const Field& metric, const Promise& promise, Faults& faults) {
  std::size_t indefinite = 0, too_small = 0, too_large = 0;
  const auto stride = static_cast<std::size_t>(metric.components);
  for (std::size_t i = 0; i < metric.size(); ++i) {
    const double* value = &metric.values[i * stride];
    const bool fine = stride == 1 ? *value > 0 : is_metric(value, metric.dimension);
    if (!fine) {
      ++indefinite;
      continue;
    }
    if (stride == 1) continue;
    if (promise.shortest_size > 0 && beyond(value, metric.dimension, promise.shortest_size, -1))
      ++too_small;
    if (promise.largest_size > 0 && beyond(value, metric.dimension, promise.largest_size, 1))
      ++too_large;
  }
  report("metric", indefinite, "tensors that are not positive definite", faults);
  report("metric", too_small, "sizes below -hmin", faults);
  report("metric", too_large, "sizes above -hmax", faults);
}

/// Edges that no kernel may change: required ones, and those between two required vertices.
std::set<std::array<int, 2>> fixed_edges(const Mesh& mesh) {
  std::set<std::array<int, 2>> fixed;
  for (const auto& [name, corners] : {std::pair<const char*, int>{"RequiredEdges", 2},
                                      {"RequiredTriangles", 3},
                                      {"RequiredTetrahedra", 4}})
    for (const int index : mesh.list(name))
      for (const auto& edge :
           edges_of({mesh.cells_of(corners).corners[static_cast<std::size_t>(index)]}, corners))
        fixed.insert(edge);
  return fixed;
}

void check_lengths(const Mesh& mesh, const Field& metric, double longest, Faults& faults) {
  const auto fixed = fixed_edges(mesh);
  std::size_t too_long = 0;
  double worst = 0;
  for (const auto& edge : edges_of(mesh.elements().corners, mesh.corner_count())) {
    if (fixed.count(edge) != 0) continue;
    const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
    const Point along = mesh.points[b] - mesh.points[a];
    const double length = mean_length(std::sqrt(square_length(tensor_at(metric, a), along)),
                                      std::sqrt(square_length(tensor_at(metric, b), along)));
    worst = std::max(worst, length);
    if (length > longest) ++too_long;
  }
  if (too_long == 0) return;
  std::ostringstream text;
  text << "lengths: " << too_long << " edges longer than " << longest << ", the longest is "
       << worst;
  faults.push_back(text.str());
}

}  // namespace

Faults check_metric(const Mesh& mesh, const Field& metric, const Promise& promise) {
  if (metric.dimension != mesh.dimension || metric.size() != mesh.points.size())
    return {"metric: not one value for each vertex"};
  Faults faults;
  for (const double value : metric.values)
    if (!std::isfinite(value)) return {"metric: a value that is not finite"};
  check_definite(metric, promise, faults);
  if (promise.longest_edge > 0 && faults.empty())
    check_lengths(mesh, metric, promise.longest_edge, faults);
  return faults;
}

}  // namespace ductile::campaign
