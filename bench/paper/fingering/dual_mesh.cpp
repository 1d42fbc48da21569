#include "fingering/dual_mesh.hpp"

#include <algorithm>
#include <tuple>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::paper {

namespace {

/// An edge of one triangle.
struct HalfEdge {
  Edge edge;
  std::uint32_t place;  // 3 * element + i
};

void find_edges(DualMesh& dual) {
  std::vector<HalfEdge> halves;
  halves.reserve(3 * dual.mesh.element_count());
  for (std::uint32_t e = 0; e < dual.mesh.element_count(); ++e)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto& corners = dual.mesh.corners_of[e];
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      halves.push_back({{low, high}, 3 * e + i});
    }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.edge.from, a.edge.to, a.place) < std::tie(b.edge.from, b.edge.to, b.place);
  });
  dual.edges_of.resize(dual.mesh.element_count());
  for (const auto& [edge, place] : halves) {
    if (dual.edges.empty() || dual.edges.back().from != edge.from ||
        dual.edges.back().to != edge.to)
      dual.edges.push_back(edge);
    dual.edges_of[place / 3][place % 3] = static_cast<EdgeId>(dual.edges.size() - 1);
  }
}

void list_edges_at_vertices(DualMesh& dual) {
  dual.first_around.assign(dual.vertex_count() + 1, 0);
  for (const Edge& edge : dual.edges) {
    ++dual.first_around[edge.from + 1];
    ++dual.first_around[edge.to + 1];
  }
  for (std::size_t v = 0; v < dual.vertex_count(); ++v)
    dual.first_around[v + 1] += dual.first_around[v];
  std::vector<std::uint32_t> next = dual.first_around;
  dual.around.resize(2 * dual.edges.size());
  for (EdgeId e = 0; e < dual.edges.size(); ++e) {
    dual.around[next[dual.edges[e].from]++] = e;
    dual.around[next[dual.edges[e].to]++] = e;
  }
}

void find_stiffness(DualMesh& dual) {
  dual.stiffness_of.assign(dual.edges.size(), 0);
  for (meshadapt::ElementId e = 0; e < dual.mesh.element_count(); ++e) {
    const auto gradients = meshadapt::hat_gradients<2>(dual.mesh.points(e));
    for (std::size_t i = 0; i < 3; ++i)
      dual.stiffness_of[dual.edges_of[e][i]] -=
          dual.mesh.volume_of[e] * dot(gradients[i], gradients[(i + 1) % 3]);
  }
}

void find_sides(DualMesh& dual, const AnyMesh& mesh) {
  dual.inflow_of.assign(dual.vertex_count(), 0);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges.vertices[e];
    const double length = norm(dual.mesh.position_of[a] - dual.mesh.position_of[b]);
    if (mesh.edges.reference[e] == meshadapt::Side::left)
      for (const VertexId v : {a, b}) dual.inflow_of[v] += length / 2;
    if (mesh.edges.reference[e] == meshadapt::Side::right)
      for (const VertexId v : {a, b}) dual.outlet.push_back(v);
  }
  std::sort(dual.outlet.begin(), dual.outlet.end());
  dual.outlet.erase(std::unique(dual.outlet.begin(), dual.outlet.end()), dual.outlet.end());
}

}  // namespace

DualMesh make_dual_mesh(const runtime::Executor& executor, const AnyMesh& mesh) {
  DualMesh dual;
  dual.mesh = meshadapt::make_fixed_mesh<2>(executor, mesh);
  find_edges(dual);
  list_edges_at_vertices(dual);
  find_stiffness(dual);
  find_sides(dual, mesh);
  return dual;
}

}  // namespace ductile::paper
