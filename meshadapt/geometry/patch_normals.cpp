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

PatchNormals::PatchNormals(const runtime::Executor& executor, const ModelInput<3>& input,
                           const CurveTangents<3>& curves)
    : executor_(executor), input_(input), curves_(curves) {
  find_sides();
  find_edges();
  find_nodes();
  find_flat();
  find_straight();
  find_rims();
  normal_of_.resize(creased_.size());
  parallel_for(executor_, normal_of_.size(),
               [&](std::size_t n) { normal_of_[n] = normal_at(static_cast<Node>(n)); });
}

void PatchNormals::find_sides() {
  sides_ = runtime::make_unset_vector<ModelSide>(executor_, 3 * input_.facets.size());
  parallel_for(executor_, input_.facets.size(), [&](std::size_t f) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto& corner = input_.facets[f].corner;
      const std::uint32_t a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
      sides_[3 * f + i] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(f), i};
    }
  });
  runtime::parallel_sort(executor_, std::span(sides_));
}

std::size_t PatchNormals::end_of_run(std::size_t begin) const {
  std::size_t end = begin + 1;
  while (end < sides_.size() && sides_[end].low == sides_[begin].low &&
         sides_[end].high == sides_[begin].high)
    ++end;
  return end;
}

void PatchNormals::find_edges() {
  using Key = std::array<std::uint32_t, 3>;
  std::vector<Key> edges;
  edges.reserve(input_.edges.size());
  for (std::uint32_t e = 0; e < input_.edges.size(); ++e) {
    const auto [a, b] = input_.edges[e].corner;
    edges.push_back({std::min(a, b), std::max(a, b), e});
  }
  std::sort(edges.begin(), edges.end());
  edge_at_.assign(input_.facets.size(), {no_edge, no_edge, no_edge});
  std::size_t e = 0;
  for (const ModelSide& side : sides_) {
    const std::array at{side.low, side.high};
    while (e < edges.size() && std::array{edges[e][0], edges[e][1]} < at) ++e;
    if (e < edges.size() && std::array{edges[e][0], edges[e][1]} == at)
      edge_at_[side.facet][side.opposite] = edges[e][2];
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
  for (std::size_t i = 0; i < sides_.size(); i = end_of_run(i)) {
    if (end_of_run(i) == i + 2) keep_flat(i, i + 2, planes);
    if (end_of_run(i) != i + 2 || edge_at_[sides_[i].facet][sides_[i].opposite] != no_edge)
      plane_at[sides_[i].low] = plane_at[sides_[i].high] = several;
  }
  for (const std::uint32_t plane : plane_at)
    if (plane < several) planes[plane] = 1;
  flat_.resize(input_.facets.size());
  for (std::size_t f = 0; f < flat_.size(); ++f)
    flat_[f] = !input_.facets[f].smooth ||
               (planes[input_.facets[f].plane] != 0 && size[input_.facets[f].plane] > 1);
}

/// Marks planes that are too wide for what they turn by at this side.
void PatchNormals::keep_flat(std::size_t begin, std::size_t end,
                             std::vector<std::uint8_t>& planes) const {
  constexpr double most = 2;  // of the tolerance: an arc of a mesh in a loop may have used it up
  const std::uint32_t f = sides_[begin].facet, g = sides_[begin + 1].facet;
  const auto &one = input_.facets[f], &other = input_.facets[g];
  if (one.patch != other.patch || one.plane == other.plane ||
      edge_at_[f][sides_[begin].opposite] != no_edge)
    return;
  const Vector<3> u = facet_normal_of(f), v = facet_normal_of(g);
  const double turn = std::asin(std::min(1.0, norm(cross(unit(u), unit(v)))));
  const double length = norm(input_.points[sides_[begin].low] - input_.points[sides_[begin].high]);
  for (std::size_t i = begin; i < end; ++i) {
    const double height = norm(i == begin ? u : v) / length;
    if (height * turn / 8 > most * input_.tolerance)
      planes[input_.facets[sides_[i].facet].plane] = 1;
  }
}

void PatchNormals::find_straight() {
  straight_.resize(input_.facets.size());
  for (std::size_t i = 0; i < sides_.size();) {
    const std::size_t end = end_of_run(i);
    const auto f = [&](std::size_t k) { return sides_[k].facet; };
    bool straight = end != i + 2;
    for (std::size_t k = i; k < end; ++k)
      straight = straight || is_flat(f(k)) || input_.facets[f(k)].held;
    for (; i < end; ++i) straight_[sides_[i].facet][sides_[i].opposite] = straight;
  }
}

/// Is an edge inside of a patch sharp? It is where the patch turns by the ridge angle or a ridge is
/// listed. Other edges, such as the seams of closed surfaces, lie on what is smooth.
bool PatchNormals::is_crease(const ModelSide& one, const ModelSide& other) const {
  if (input_.facets[one.facet].patch != input_.facets[other.facet].patch) return false;
  if (input_.edges[edge_at_[one.facet][one.opposite]].ridge) return true;
  const Vector<3>&a = input_.points[one.low], along = input_.points[one.high] - a;
  const auto away = [&](const ModelSide& side) {
    const Vector<3> d = input_.points[input_.facets[side.facet].corner[side.opposite]] - a;
    return d - (dot(d, along) / dot(along, along)) * along;
  };
  const Vector<3> u = away(one), v = away(other);
  return !(-dot(u, v) > input_.least_turn * norm(u) * norm(v));
}

/// Curves at the ends of patches, and creases inside them.
void PatchNormals::find_rims() {
  for (std::size_t i = 0; i < sides_.size();) {
    const std::size_t begin = i, end = end_of_run(i);
    for (; i < end; ++i) {
      const auto [low, high, f, opposite] = sides_[i];
      const std::uint32_t edge = edge_at_[f][opposite];
      if (edge == no_edge) continue;
      const bool crease = end == begin + 2 && is_crease(sides_[begin], sides_[begin + 1]);
      for (const std::uint32_t k : {(opposite + 1) % 3, (opposite + 2) % 3}) {
        const Node node = node_of_[f][k];
        if (crease) creased_[node] = 1;
        const std::uint32_t at = input_.edges[edge].corner[0] == input_.facets[f].corner[k] ? 0 : 1;
        rims_.push_back({node, {edge, at}});
      }
    }
  }
  std::sort(rims_.begin(), rims_.end());
}

// ---- Normals ----

Vector<3> PatchNormals::normal_at(Node node) const {
  const auto facets = facets_at(node);
  const std::uint32_t point = static_cast<std::uint32_t>(facets[0].key);
  if (!input_.facets[facets[0].facet].smooth || creased_[node] != 0 || input_.ends[point] != 0)
    return {};
  Vector<3> largest, flat, sum;
  for (const NodeFacet& at : facets) {
    const Vector<3> normal = facet_normal_of(at.facet);
    if (dot(normal, normal) > dot(largest, largest)) largest = normal;
    if (is_flat(at.facet) && dot(normal, normal) > dot(flat, flat)) flat = normal;
  }
  if (norm(flat) > 0) return unit(flat);
  for (const NodeFacet& at : facets) {
    const Vector<3> normal = facet_normal_of(at.facet);
    sum += std::copysign(1.0, dot(normal, largest)) * normal;
  }
  const Vector<3> base = unit(sum);
  Quadric quadric(base);
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
  const auto place = [&](Node n) {
    return input_.points[static_cast<std::uint32_t>(node_facets_[first_of_[n]].key)];
  };
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
