#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <utility>

#include "core/unit.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

namespace {

/// The curves at the vertices of a mesh.
class Chains {
 public:
  Chains(const std::vector<CurveEdge>& edges, std::size_t vertex_count)
      : count_(vertex_count), next_(vertex_count, {none, none}) {
    for (const CurveEdge& edge : edges) {
      add(edge.a, edge.b);
      add(edge.b, edge.a);
    }
  }
  bool has(VertexId v) const { return count_[v] != 0; }
  /// Does a curve lead through?
  bool passes(VertexId v) const { return count_[v] == 2; }
  const std::array<VertexId, 2>& beside(VertexId v) const { return next_[v]; }
  /// Coming from another vertex; none where the curve ends.
  VertexId after(VertexId v, VertexId from) const {
    if (!passes(v)) return none;
    return next_[v][0] == from ? next_[v][1] : next_[v][0];
  }

 private:
  void add(VertexId v, VertexId to) {
    if (count_[v] < 2) next_[v][count_[v]] = to;
    ++count_[v];
  }
  std::vector<std::uint32_t> count_;
  std::vector<std::array<VertexId, 2>> next_;
};

template <int Dim>
class Denoiser {
 public:
  Denoiser(const BoundaryParts<Dim>& parts, const std::vector<CurveEdge>& curve_edges)
      : parts_(parts), mesh_(parts.mesh), chains_(curve_edges, mesh_.vertex_slots()) {
    find_nodes(held(curve_edges));
  }

  std::vector<Vector<Dim>> places() {
    constexpr int steps = 30;
    if (nodes_.empty()) return {};
    places_.resize(mesh_.vertex_slots());
    for (std::size_t v = 0; v < places_.size(); ++v) places_[v] = mesh_.site_of[v].position;
    std::vector<Vector<Dim>> next(nodes_.size());
    for (int step = 0; step < steps; ++step) {
      runtime::parallel_for(parts_.executor, nodes_.size(),
                            [&](std::size_t n) { next[n] = moved(nodes_[n]); });
      for (std::size_t n = 0; n < nodes_.size(); ++n) places_[nodes_[n].vertex] = next[n];
    }
    return std::move(places_);
  }

 private:
  /// A vertex that may move.
  struct Node {
    VertexId vertex;
    std::vector<std::uint32_t> facets;
    std::vector<VertexId> beside;   // on its curve, or all
    std::vector<Vector<Dim>> flat;  // normals of flat patches, at right angles to each other
    Vector<Dim> normal;             // of its smooth patches, to either side
  };

  const Vector<Dim>& at(VertexId v) const { return mesh_.site_of[v].position; }

  /// [vertex], whether it stays.
  std::vector<std::uint8_t> held(const std::vector<CurveEdge>& curve_edges) const {
    std::vector<std::uint8_t> held = parts_.kept;
    for (VertexId v = 0; v < held.size(); ++v)
      if (parts_.mesh.kind_of[v].corner || parts_.mesh.kind_of[v].required) held[v] = 1;
    for (const TaggedFacet<Dim>& facet : parts_.facets)
      if (parts_.mesh.patches[facet.patch].required)
        for (const VertexId v : facet.corners) held[v] = 1;
    if constexpr (Dim == 2)
      parts_.sides.each_run([&](std::span<const FacetSide> run) {
        if (parts_.ends_patch(run)) held[static_cast<VertexId>(run[0].key)] = 1;
      });
    for (const CurveEdge& edge : curve_edges)
      if (edge.data.required) held[edge.a] = held[edge.b] = 1;
    return held;
  }

  void find_nodes(const std::vector<std::uint8_t>& held) {
    std::vector<std::uint8_t> is_noise(mesh_.vertex_slots());
    for (std::uint32_t f = 0; f < parts_.facets.size(); ++f)
      if (parts_.is_noise(f))
        for (const VertexId v : parts_.facets[f].corners) is_noise[v] = 1;
    std::vector<std::uint32_t> node_of(mesh_.vertex_slots(), none);
    for (VertexId v = 0; v < is_noise.size(); ++v) {
      if (held[v] != 0) continue;
      if (chains_.has(v)) {
        if (!chains_.passes(v) || (turns(v) && turns_widely(v))) continue;
        if (!turns_nearby(v)) continue;
      } else if (is_noise[v] == 0) {
        continue;
      }
      node_of[v] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({v, {}, {}, {}, {}});
    }
    for (std::uint32_t f = 0; f < parts_.facets.size() && !nodes_.empty(); ++f)
      for (const VertexId v : parts_.facets[f].corners)
        if (node_of[v] != none) add_facet(nodes_[node_of[v]], f);
    // Straight edges between flat patches are no noise, whatever is beside them.
    std::erase_if(nodes_, [&](const Node& node) {
      return !(norm(node.normal) > 0) && !(chains_.passes(node.vertex) && turns(node.vertex));
    });
    for (Node& node : nodes_)
      if (chains_.has(node.vertex)) {
        const auto& beside = chains_.beside(node.vertex);
        node.beside.assign(beside.begin(), beside.end());
      }
  }

  void add_facet(Node& node, std::uint32_t f) {
    const TaggedFacet<Dim>& facet = parts_.facets[f];
    node.facets.push_back(f);
    for (const VertexId v : facet.corners)
      if (v != node.vertex &&
          std::find(node.beside.begin(), node.beside.end(), v) == node.beside.end())
        node.beside.push_back(v);
    const Patch<Dim>& patch = mesh_.patches[facet.patch];
    if (patch.smooth) {
      const Vector<Dim> area = norm(normal_of<Dim>(mesh_, facet.corners)) * parts_.direction(f);
      node.normal += (dot(area, node.normal) < 0 ? -1.0 : 1.0) * area;
      return;
    }
    Vector<Dim> across = patch.normal;
    for (const Vector<Dim>& other : node.flat) across -= dot(across, other) * other;
    if (norm(across) > 1e-6) node.flat.push_back(unit(across));
  }

  // ---- Curves ----

  bool turns(const Vector<Dim>& before, const Vector<Dim>& after) const {
    return !(dot(before, after) > parts_.within.least_turn * norm(before) * norm(after));
  }
  /// Does the curve turn by much at a vertex?
  bool turns(VertexId v) const {
    const auto [a, b] = chains_.beside(v);
    return turns(at(v) - at(a), at(b) - at(v));
  }
  bool turns_widely(VertexId v) const {
    const auto [a, b] = chains_.beside(v);
    return turns(at(v) - ahead(v, a), ahead(v, b) - at(v));
  }
  /// Does it at a vertex that noise here may reach? Where it does not, it has none.
  bool turns_nearby(VertexId v) const {
    if (turns(v)) return true;
    const auto [a, b] = chains_.beside(v);
    return turns_towards(v, a) || turns_towards(v, b);
  }
  bool turns_towards(VertexId from, VertexId next) const {
    VertexId before = from;
    while (next != from && chains_.passes(next) &&
           norm(at(next) - at(from)) < 2 * parts_.within.surface) {
      if (turns(next)) return true;
      before = std::exchange(next, chains_.after(next, before));
    }
    return false;
  }
  /// The point where the curve from a vertex over the next one leaves the range of noise.
  Vector<Dim> ahead(VertexId from, VertexId next) const {
    constexpr int most_steps = 200;
    const double reach = 2 * parts_.within.surface;
    VertexId before = from;
    for (int i = 0; i < most_steps && norm(at(next) - at(from)) < reach; ++i) {
      const VertexId after = chains_.after(next, before);
      if (after == none || after == from) return at(next);
      before = std::exchange(next, after);
    }
    // Between the last two, not far beyond the reach.
    double inside = 0, outside = 1;
    for (int i = 0; i < 20; ++i) {
      const double middle = (inside + outside) / 2;
      const Vector<Dim> p = at(before) + middle * (at(next) - at(before));
      (norm(p - at(from)) < reach ? inside : outside) = middle;
    }
    return at(before) + outside * (at(next) - at(before));
  }

  // ---- One step ----

  Vector<Dim> moved(const Node& node) const {
    const Vector<Dim>&origin = at(node.vertex), &here = places_[node.vertex];
    const bool on_curve = chains_.has(node.vertex);
    const Vector<Dim> normal = unit(node.normal);
    const Vector<Dim> chord =
        on_curve ? unit(places_[node.beside[1]] - places_[node.beside[0]]) : Vector<Dim>{};
    const auto along = [&](const Vector<Dim>& v) {
      return on_curve ? dot(v, chord) * chord : v - dot(v, normal) * normal;
    };
    Vector<Dim> mean;
    for (const VertexId v : node.beside)
      mean += (1.0 / static_cast<double>(node.beside.size())) * (places_[v] - here);
    Vector<Dim> away = here - origin + to_planes(node) + 0.5 * along(mean);
    away = limited(away, along(away), parts_.within.surface / 4);
    away = limited(away, away, parts_.within.surface / 2);
    for (const Vector<Dim>& across : node.flat) away -= dot(away, across) * across;
    return origin + away;
  }

  /// Less of a part of a displacement, where that is longer than it may be.
  static Vector<Dim> limited(const Vector<Dim>& away, const Vector<Dim>& part, double most) {
    const double length = norm(part);
    return length > most ? away - (1 - most / length) * part : away;
  }

  /// Towards the planes through the centres of the facets, by their normals.
  Vector<Dim> to_planes(const Node& node) const {
    Vector<Dim> sum;
    double weight = 0;
    for (const std::uint32_t f : node.facets) {
      const auto& corners = parts_.facets[f].corners;
      Vector<Dim> centre;
      for (const VertexId v : corners) centre += (1.0 / Dim) * places_[v];
      const double area = norm(normal_of<Dim>(mesh_, corners));
      const Vector<Dim> across = parts_.direction(f);
      sum += (area * dot(across, centre - places_[node.vertex])) * across;
      weight += area;
    }
    return weight > 0 ? (1 / weight) * sum : Vector<Dim>{};
  }

  const BoundaryParts<Dim>& parts_;
  const Mesh<Dim>& mesh_;
  Chains chains_;
  std::vector<Node> nodes_;
  std::vector<Vector<Dim>> places_;  // [vertex]
};

}  // namespace

template <int Dim>
void denoise(BoundaryParts<Dim>& parts, const std::vector<CurveEdge>& curve_edges) {
  parts.places = Denoiser<Dim>(parts, curve_edges).places();
}

template void denoise(BoundaryParts<2>&, const std::vector<CurveEdge>&);
template void denoise(BoundaryParts<3>&, const std::vector<CurveEdge>&);

}  // namespace ductile::meshadapt
