#include "metric/charts.hpp"

#include <algorithm>

#include "core/unit.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

using Triangles = FixedMesh<2, 3>;

/// Does a surface turn by less than 45 degrees at the edge of a triangle across from a corner?
bool is_smooth_at(const Triangles& surface, ElementId e, std::size_t corner) {
  constexpr double least_turn = 0.70710678118654752;
  const ElementId other = surface.neighbour_of[e][corner];
  if (other == none) return false;
  const Corners<2>& corners = surface.corners_of[e];
  const VertexId from = corners[(corner + 1) % 3], to = corners[(corner + 2) % 3];
  const Vector<3>& origin = surface.position_of[from];
  const Vector<3> along = surface.position_of[to] - origin;
  const auto away = [&](VertexId v) {
    const Vector<3> d = surface.position_of[v] - origin;
    return dot(along, along) * d - dot(d, along) * along;
  };
  VertexId opposite = none;
  for (const VertexId v : surface.corners_of[other])
    if (v != from && v != to) opposite = v;
  const Vector<3> u = away(corners[corner]), v = away(opposite);
  return -dot(u, v) >= least_turn * norm(u) * norm(v);
}

/// The triangles around a vertex, in parts that are connected where the surface is smooth.
struct Fans {
  std::vector<std::uint32_t> fan_of;  // [index among the triangles around]
  std::uint32_t count = 0;
};

Fans fans_around(const Triangles& surface, VertexId vertex) {
  const auto around = surface.elements_of(vertex);
  Fans fans{std::vector<std::uint32_t>(around.size(), none)};
  std::vector<std::size_t> front;
  for (std::size_t seed = 0; seed < around.size(); ++seed) {
    if (fans.fan_of[seed] != none) continue;
    fans.fan_of[seed] = fans.count;
    front.assign(1, seed);
    while (!front.empty()) {
      const ElementId e = around[front.back()];
      front.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        if (surface.corners_of[e][i] == vertex || !is_smooth_at(surface, e, i)) continue;
        const auto at = std::ranges::lower_bound(around, surface.neighbour_of[e][i]);
        const auto next = static_cast<std::size_t>(at - around.begin());
        if (fans.fan_of[next] == none) {
          fans.fan_of[next] = fans.count;
          front.push_back(next);
        }
      }
    }
    ++fans.count;
  }
  return fans;
}

/// The normal is the mean by area; triangles may be turned to either side.
std::array<Vector<3>, 3> frame_at(const Triangles& nodes, VertexId node) {
  const auto around = nodes.elements_of(node);
  const Vector<3> mean = mean_direction(
      around.size(), [&](std::size_t i) { return facet_normal(nodes.points(around[i])); });
  const Vector<3> normal = norm(mean) > 0 ? mean : Vector<3>{{0, 0, 1}};
  const Vector<3> axis = axis_across(normal);
  const Vector<3> along = unit(axis - dot(axis, normal) * normal);
  return {along, cross(normal, along), normal};
}

}  // namespace

Charts<2, 3>::Charts(const Executor& executor, const FixedMesh<2, 3>& surface) {
  const std::size_t vertices = surface.vertex_count();
  first_node_.resize(vertices + 1);
  AnyMesh open;  // the surface after it is cut
  open.dimension = 3;
  open.triangles.vertices = surface.corners_of;
  open.triangles.reference.resize(surface.element_count());
  parallel_for(executor, vertices, [&](std::size_t at) {
    const auto v = static_cast<VertexId>(at);
    const auto around = surface.elements_of(v);
    const Fans fans = fans_around(surface, v);
    first_node_[v] = std::max(fans.count, 1U);
    for (std::size_t i = 0; i < around.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        if (surface.corners_of[around[i]][c] == v)
          open.triangles.vertices[around[i]][c] = fans.fan_of[i];
  });
  runtime::exclusive_scan(executor, std::span(first_node_));
  vertex_of_.resize(first_node_.back());
  open.vertex_reference.resize(vertex_of_.size());
  open.coordinates.resize(3 * vertex_of_.size());
  parallel_for(executor, vertices, [&](std::size_t v) {
    for (VertexId node = first_node_[v]; node < first_node_[v + 1]; ++node) {
      vertex_of_[node] = static_cast<VertexId>(v);
      std::ranges::copy(surface.position_of[v].x, &open.coordinates[std::size_t{3} * node]);
    }
  });
  parallel_for(executor, surface.element_count(), [&](std::size_t e) {
    for (std::size_t c = 0; c < 3; ++c)
      open.triangles.vertices[e][c] += first_node_[surface.corners_of[e][c]];
  });
  mesh_ = make_fixed_mesh<2, 3>(executor, open);
  frame_of_.resize(vertex_of_.size());
  parallel_for(executor, frame_of_.size(), [&](std::size_t node) {
    frame_of_[node] = frame_at(mesh_, static_cast<VertexId>(node));
  });
}

Vector<2> Charts<2, 3>::offset(VertexId from, VertexId to) const {
  const Vector<3> d = mesh_.position_of[to] - mesh_.position_of[from];
  const Frame& frame = frame_of_[from];
  const Vector<2> flat{{dot(d, frame[0]), dot(d, frame[1])}};
  const double length = norm(flat);
  return length > 0 ? (norm(d) / length) * flat : flat;
}

std::vector<Metric<3>> Charts<2, 3>::lifted(const Executor& executor,
                                            const std::vector<Metric<2>>& at_nodes) const {
  const auto lift = [&](VertexId node) {
    const PrincipalAxes<2> flat = principal_axes(at_nodes[node]);
    const Frame& frame = frame_of_[node];
    PrincipalAxes<3> axes;
    for (std::size_t i = 0; i < 2; ++i) {
      axes.value[i] = flat.value[i];
      axes.vector[i] = flat.vector[i][0] * frame[0] + flat.vector[i][1] * frame[1];
    }
    axes.value[2] = std::min(flat.value[0], flat.value[1]);
    axes.vector[2] = frame[2];
    return compose(axes);
  };
  std::vector<Metric<3>> metric_of(first_node_.size() - 1);
  parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    metric_of[v] = lift(first_node_[v]);
    for (VertexId node = first_node_[v] + 1; node < first_node_[v + 1]; ++node)
      metric_of[v] = intersect(metric_of[v], lift(node));
  });
  return metric_of;
}

std::vector<Metric<2>> Charts<2, 3>::restricted(const Executor& executor,
                                                const std::vector<Metric<3>>& at_vertices) const {
  std::vector<Metric<2>> metric_of(vertex_of_.size());
  parallel_for(executor, metric_of.size(), [&](std::size_t node) {
    const Metric<3>& metric = at_vertices[vertex_of_[node]];
    const auto& [u, v, normal] = frame_of_[node];
    metric_of[node].m = {squared_length(metric, u), dot(u, product(metric, v)),
                         squared_length(metric, v)};
  });
  return metric_of;
}

}  // namespace ductile::meshadapt
