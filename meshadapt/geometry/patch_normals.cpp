#include "geometry/patch_normals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/unit.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "geometry/quadric.hpp"

namespace ductile::meshadapt {

using runtime::parallel_for;

namespace {

/// The corner of its facet across from a side.
std::size_t opposite(const FacetSide& side) { return (side.number + 2U) % 3; }

}  // namespace

PatchNormals::PatchNormals(const runtime::Executor& executor, const ModelInput<3>& input,
                           const CurveTangents<3>& curves)
    : executor_(executor),
      input_(input),
      curves_(curves),
      sides_(executor, input.facets.size(), [&](std::size_t f) { return input.facets[f].corner; }) {
  find_edges();
  find_nodes();
  find_flat();
  find_straight();
  find_rims();
  normal_of_.resize(creased_.size());
  parallel_for(executor_, normal_of_.size(),
               [&](std::size_t n) { normal_of_[n] = normal_at(static_cast<Node>(n)); });
}

void PatchNormals::find_edges() {
  edge_at_.assign(input_.facets.size(), {no_edge, no_edge, no_edge});
  for (auto e = static_cast<std::uint32_t>(input_.edges.size()); e-- > 0;) {
    const auto [a, b] = input_.edges[e].corner;
    for (const FacetSide& side : sides_.at(edge_key(a, b)))
      edge_at_[side.facet][opposite(side)] = e;
  }
}

/// A node is a point as a part of one patch.
void PatchNormals::find_nodes() {
  const auto& facets = input_.facets;
  node_facets_ = runtime::make_unset_vector<NodeFacet>(executor_, 3 * facets.size());
  const auto key = [&](std::size_t f, std::size_t i) {
    return std::uint64_t{facets[f].patch} << 32U | facets[f].corner[i];
  };
  parallel_for(executor_, facets.size(), [&](std::size_t f) {
    for (std::size_t i = 0; i < 3; ++i)
      node_facets_[3 * f + i] = {key(f, i), static_cast<std::uint32_t>(f)};
  });
  runtime::parallel_sort(executor_, std::span(node_facets_));
  for (std::size_t i = 0; i < node_facets_.size(); ++i)
    if (i == 0 || node_facets_[i].key != node_facets_[i - 1].key)
      first_of_.push_back(static_cast<std::uint32_t>(i));
  creased_.assign(first_of_.size(), 0);
  first_of_.push_back(static_cast<std::uint32_t>(node_facets_.size()));
  node_of_.resize(facets.size());
  parallel_for(executor_, facets.size(), [&](std::size_t f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = std::upper_bound(
          first_of_.begin(), first_of_.end() - 1, key(f, i),
          [&](std::uint64_t k, std::uint32_t first) { return k < node_facets_[first].key; });
      node_of_[f][i] = static_cast<Node>(found - first_of_.begin() - 1);
    }
  });
}

std::span<const PatchNormals::NodeFacet> PatchNormals::facets_at(Node node) const {
  return std::span(node_facets_).subspan(first_of_[node], first_of_[node + 1] - first_of_[node]);
}

Vector<3> PatchNormals::facet_normal_of(std::uint32_t facet) const {
  const auto& [a, b, c] = input_.facets[facet].corner;
  return facet_normal({input_.points[a], input_.points[b], input_.points[c]});
}

// ---- What is flat for good ----

/// Planes with a vertex that they surround, and those that turn too much at a side.
void PatchNormals::find_flat() {
  std::uint32_t plane_count = 0;
  for (const auto& facet : input_.facets) plane_count = std::max(plane_count, facet.plane + 1);
  std::vector<std::uint8_t> planes(plane_count);
  std::vector<std::uint32_t> plane_at(input_.points.size(), no_edge);  // or one more for several
  const std::uint32_t several = plane_count;
  std::vector<std::uint32_t> size(plane_count);
  for (const auto& facet : input_.facets) {
    ++size[facet.plane];
    for (const std::uint32_t point : facet.corner) {
      std::uint32_t& plane = plane_at[point];
      plane = plane == no_edge || plane == facet.plane ? facet.plane : several;
    }
  }
  sides_.each_run([&](std::span<const FacetSide> run) {
    const auto [a, b] = ends_of(run[0].key);
    if (run.size() == 2) keep_flat(run, planes);
    if (run.size() != 2 || edge_at_[run[0].facet][opposite(run[0])] != no_edge)
      plane_at[a] = plane_at[b] = several;
  });
  for (const std::uint32_t plane : plane_at)
    if (plane < several) planes[plane] = 1;
  flat_.resize(input_.facets.size());
  for (std::size_t f = 0; f < flat_.size(); ++f)
    flat_[f] = !input_.facets[f].smooth ||
               (planes[input_.facets[f].plane] != 0 && size[input_.facets[f].plane] > 1);
}

/// Marks planes that are too wide for what they turn by at this side.
void PatchNormals::keep_flat(std::span<const FacetSide> both,
                             std::vector<std::uint8_t>& planes) const {
  constexpr double most = 2;  // of the tolerance: an arc of a mesh in a loop may have used it up
  const std::uint32_t f = both[0].facet, g = both[1].facet;
  const auto &one = input_.facets[f], &other = input_.facets[g];
  if (one.patch != other.patch || one.plane == other.plane ||
      edge_at_[f][opposite(both[0])] != no_edge)
    return;
  const Vector<3> u = facet_normal_of(f), v = facet_normal_of(g);
  const double turn = std::asin(std::min(1.0, norm(cross(unit(u), unit(v)))));
  const auto [a, b] = ends_of(both[0].key);
  const double length = norm(input_.points[a] - input_.points[b]);
  for (const auto& [facet, normal] : {std::pair(f, u), std::pair(g, v)})
    if (norm(normal) / length * turn / 8 > most * input_.tolerance)
      planes[input_.facets[facet].plane] = 1;
}

void PatchNormals::find_straight() {
  straight_.resize(input_.facets.size());
  sides_.each_run([&](std::span<const FacetSide> run) {
    bool straight = run.size() != 2;
    for (const FacetSide& side : run)
      straight = straight || is_flat(side.facet) || input_.facets[side.facet].held;
    for (const FacetSide& side : run) straight_[side.facet][opposite(side)] = straight;
  });
}

/// Is an edge inside of a patch sharp? It is where the patch turns by the ridge angle or a ridge is
/// listed. Other edges, such as the seams of closed surfaces, lie on what is smooth.
bool PatchNormals::is_crease(std::span<const FacetSide> both) const {
  const FacetSide &one = both[0], &other = both[1];
  if (input_.facets[one.facet].patch != input_.facets[other.facet].patch) return false;
  if (input_.edges[edge_at_[one.facet][opposite(one)]].ridge) return true;
  const auto [low, high] = ends_of(one.key);
  const Vector<3>&a = input_.points[low], along = input_.points[high] - a;
  const auto away = [&](const FacetSide& side) {
    const Vector<3> d = input_.points[input_.facets[side.facet].corner[opposite(side)]] - a;
    return d - (dot(d, along) / dot(along, along)) * along;
  };
  const Vector<3> u = away(one), v = away(other);
  return !(-dot(u, v) > input_.least_turn * norm(u) * norm(v));
}

/// Curves at the ends of patches, and creases inside them.
void PatchNormals::find_rims() {
  sides_.each_run([&](std::span<const FacetSide> run) {
    for (const FacetSide& side : run) {
      const std::uint32_t edge = edge_at_[side.facet][opposite(side)];
      if (edge == no_edge) continue;
      const bool crease = run.size() == 2 && is_crease(run);
      for (const std::uint32_t k : {side.number + 0U, (side.number + 1U) % 3}) {
        const Node node = node_of_[side.facet][k];
        if (crease) creased_[node] = 1;
        const std::uint32_t corner = input_.facets[side.facet].corner[k];
        rims_.push_back({node, {edge, input_.edges[edge].corner[0] == corner ? 0 : 1}});
      }
    }
  });
  std::sort(rims_.begin(), rims_.end());
}

// ---- Normals ----

Samples<3, 3> PatchNormals::samples() const {
  constexpr double near = 0.99;
  Samples<3, 3> result;
  result.all.resize(normal_of_.size());
  parallel_for(executor_, result.all.size(), [&](std::size_t i) {
    const auto node = static_cast<Node>(i);
    const auto facets = facets_at(node);
    if (!input_.facets[facets[0].facet].smooth) return;
    const Vector<3> mean = mean_normal(node), &normal = normal_of_[node];
    auto& sample = result.all[node];
    sample = {place(node), std::abs(dot(normal, mean)) > near ? normal : mean};
    for (const NodeFacet& at : facets) sample.area += norm(facet_normal_of(at.facet)) / 6;
  });
  result.facets = node_of_;
  for (std::size_t f = 0; f < result.facets.size(); ++f)
    if (!input_.facets[f].smooth) result.facets[f].fill(none);
  return result;
}

/// By area, to the side of the largest facet.
Vector<3> PatchNormals::mean_normal(Node node) const {
  const auto facets = facets_at(node);
  return mean_direction(facets.size(),
                        [&](std::size_t i) { return facet_normal_of(facets[i].facet); });
}

Vector<3> PatchNormals::normal_at(Node node) const {
  const auto facets = facets_at(node);
  const std::uint32_t point = static_cast<std::uint32_t>(facets[0].key);
  if (!input_.facets[facets[0].facet].smooth || creased_[node] != 0 || input_.ends[point] != 0)
    return {};
  Vector<3> flat;
  for (const NodeFacet& at : facets) {
    const Vector<3> normal = facet_normal_of(at.facet);
    if (is_flat(at.facet) && dot(normal, normal) > dot(flat, flat)) flat = normal;
  }
  if (norm(flat) > 0) return unit(flat);
  Quadric quadric(mean_normal(node));
  const auto neighbours = around(node);
  double farthest = 0;  // squared
  for (const Neighbour& n : neighbours) {
    quadric.measure(n.offset);
    farthest = std::max(farthest, dot(n.offset, n.offset));
  }
  quadric.turn_along();
  // Close neighbours say more about the normal, unless they are so close that noise decides.
  constexpr double too_close = 0.1;
  for (const Neighbour& n : neighbours)
    quadric.add(n.offset, n.weight / (dot(n.offset, n.offset) + too_close * farthest));
  return along_rims(node, quadric.normal());
}

/// The vertices next to it, and those next to these, not across what is flat or a crease.
std::vector<PatchNormals::Neighbour> PatchNormals::around(Node node) const {
  constexpr double second = 0.1;
  constexpr std::size_t most = 64;
  std::vector<Node> ring, all;
  const auto add = [&](Node centre, std::vector<Node>& nodes) {
    for (const NodeFacet& at : facets_at(centre)) {
      if (is_flat(at.facet)) continue;
      for (const Node n : node_of_[at.facet])
        if (n != node && std::find(all.begin(), all.end(), n) == all.end()) {
          all.push_back(n);
          nodes.push_back(n);
        }
    }
  };
  add(node, ring);
  std::vector<Node> beyond;
  for (const Node n : ring)
    if (creased_[n] == 0 && all.size() < most) add(n, beyond);
  std::vector<Neighbour> result;
  result.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    result.push_back({place(all[i]) - place(node), i < ring.size() ? 1 : second});
  return result;
}

/// The curves at the end of a patch are tangent to it.
Vector<3> PatchNormals::along_rims(Node node, const Vector<3>& normal) const {
  Vector<3> first;
  for (auto at = std::lower_bound(rims_.begin(), rims_.end(), std::pair(node, std::pair(0U, 0U)));
       at != rims_.end() && at->first == node; ++at) {
    const Vector<3> tangent = unit(curves_.tangent(at->second.first, at->second.second));
    if (norm(first) == 0) {
      first = tangent;
      continue;
    }
    const Vector<3> across = cross(first, tangent);
    if (norm(across) > 0.3) return std::copysign(1 / norm(across), dot(across, normal)) * across;
  }
  return unit(normal - dot(normal, first) * first);
}

}  // namespace ductile::meshadapt
