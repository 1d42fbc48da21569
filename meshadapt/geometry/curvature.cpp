#include "geometry/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

namespace {

/// Adds weight * v v' of the unit vector in a direction; nothing if there is none.
template <int Dim>
void add_square(Metric<Dim>& sum, double weight, const Vector<Dim>& direction) {
  const double length = norm(direction);
  if (!(length > 0)) return;
  const Vector<Dim> v = (1 / length) * direction;
  std::size_t at = 0;
  for (int j = 0; j < Dim; ++j)
    for (int i = 0; i <= j; ++i) sum.m[at++] += weight * v[i] * v[j];
}

/// 0 if one of them has no direction.
double angle_between(const auto& u, const auto& v) {
  const double lengths = norm(u) * norm(v);
  return lengths > 0 ? std::acos(std::clamp(dot(u, v) / lengths, -1.0, 1.0)) : 0;
}

/// The facets of one smooth patch around a vertex, by their other corners.
template <int Dim>
struct Fan {
  PatchId patch;
  std::vector<std::array<VertexId, Dim - 1>> facets;
};

template <int Dim>
class VertexCurvature {
 public:
  VertexCurvature(const Mesh<Dim>& mesh, VertexId vertex) : mesh_(mesh), vertex_(vertex) {}

  /// Calls visit(curvature, edges) for each smooth patch at the vertex: a tensor, positive
  /// semidefinite, and the edges from the vertex that it was found by.
  void each(auto&& visit) {
    find_fans();
    for (const Fan<Dim>& fan : fans_) {
      edges_.clear();
      if constexpr (Dim == 2) {
        if (fan.facets.size() == 2) visit(curvature(fan), edges_);
      } else {
        visit(absolute(curvature(fan)), edges_);
      }
    }
  }

 private:
  Vector<Dim> to(VertexId v) const {
    return mesh_.site_of[v].position - mesh_.site_of[vertex_].position;
  }

  void find_fans() {
    for (const ElementId e : mesh_.elements_of.of(vertex_))
      for (std::size_t i = 0; i <= Dim; ++i) {
        const PatchId patch = mesh_.patches_of[e][i];
        if (!mesh_.patches[patch].smooth || mesh_.corners_of[e][i] == vertex_) continue;
        const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], static_cast<int>(i));
        std::array<VertexId, Dim - 1> others{};
        std::copy_if(facet.begin(), facet.end(), others.begin(),
                     [&](VertexId v) { return v != vertex_; });
        std::sort(others.begin(), others.end());
        add(patch, others);
      }
  }

  /// Once, though an interface is seen from both sides.
  void add(PatchId patch, const std::array<VertexId, Dim - 1>& others) {
    auto fan = std::find_if(fans_.begin(), fans_.end(),
                            [&](const Fan<Dim>& f) { return f.patch == patch; });
    if (fan == fans_.end()) fan = fans_.insert(fans_.end(), {patch, {}});
    if (std::find(fan->facets.begin(), fan->facets.end(), others) == fan->facets.end())
      fan->facets.push_back(others);
  }

  /// Of two edges: the turn over half of their length.
  Metric<Dim> curvature(const Fan<Dim>& fan) requires(Dim == 2) {
    const Vector<2> before = to(fan.facets[0][0]), after = to(fan.facets[1][0]);
    const Vector<2> along = after - before;
    edges_.push_back(before);
    edges_.push_back(after);
    Metric<2> result;
    const double turn = angle_between(-1.0 * before, after);
    add_square(result, 2 * turn / (norm(before) + norm(after)), along);
    return result;
  }

  /// Of the facets: the turn across each edge between two of them, over the part of its length and
  /// of the area that is the vertex's.
  Metric<Dim> curvature(const Fan<Dim>& fan) requires(Dim == 3) {
    std::vector<Vector<3>> normals;  // as long as the facets are large, all to one side
    Vector<3> sum{};
    for (const auto& [a, b] : fan.facets) {
      Vector<3> normal = cross(to(a), to(b));
      if (dot(normal, sum) < 0) normal *= -1;
      sum += normal;
      normals.push_back(normal);
    }
    Metric<3> total;
    double area = 0;
    for (std::size_t f = 0; f < fan.facets.size(); ++f) {
      area += norm(normals[f]) / 2;
      for (std::size_t g = 0; g < f; ++g) {
        const VertexId shared = shared_by(fan.facets[f], fan.facets[g]);
        if (shared == none) continue;
        const Vector<3> edge = to(shared), across = cross(sum, edge);
        const VertexId beyond = fan.facets[g][fan.facets[g][0] == shared ? 1 : 0];
        const double turn =
            std::copysign(angle_between(normals[f], normals[g]), dot(to(beyond), normals[f]));
        add_square(total, turn * norm(edge) / 2, across);
        edges_.push_back(edge);
      }
    }
    if (area > 0) total *= 3 / area;
    return total;
  }

  static VertexId shared_by(const std::array<VertexId, 2>& f, const std::array<VertexId, 2>& g) {
    for (const VertexId v : f)
      if (v == g[0] || v == g[1]) return v;
    return none;
  }

  const Mesh<Dim>& mesh_;
  VertexId vertex_;
  std::vector<Fan<Dim>> fans_;
  std::vector<Vector<Dim>> edges_;
};

/// By how much a metric has to be multiplied so that it measures no less than a tensor.
template <int Dim>
double excess(const Metric<Dim>& tensor, const Metric<Dim>& metric) {
  const PrincipalAxes<Dim> axes = principal_axes(metric);
  Metric<Dim> seen;  // the tensor where the metric is the unit tensor
  std::size_t at = 0;
  for (std::size_t j = 0; j < Dim; ++j)
    for (std::size_t i = 0; i <= j; ++i)
      seen.m[at++] = dot(axes.vector[i], product(tensor, axes.vector[j])) /
                     std::sqrt(axes.value[i] * axes.value[j]);
  const auto values = principal_axes(seen).value;
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of) {
  runtime::parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    const auto vertex = static_cast<VertexId>(v);
    if (!mesh.vertex_alive(vertex) || mesh.kind_of[v].freedom == Dim) return;
    double factor = 1;
    VertexCurvature<Dim>(mesh, vertex).each([&](Metric<Dim> sizes, const auto& edges) {
      sizes *= 1 / (8 * tolerance);
      double longest = 1;  // squared, of the edges that there are
      for (const auto& edge : edges) longest = std::max(longest, squared_length(sizes, edge));
      factor = std::max(factor, excess(sizes, metric_of[v]) / longest);
    });
    if (factor > 1 && std::isfinite(factor)) metric_of[v] *= factor;
  });
}

template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                 std::vector<Metric<2>>&);
template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                 std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
