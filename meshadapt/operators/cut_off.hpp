/// @file
/// Cutting off: a poor element that lies flat below a smooth patch, with two facets on it, goes,
/// and the patch runs along its other two facets. That is a flip of the edge between the facets, as
/// in 2D, where no other element is below that edge.
#pragma once

#include <algorithm>
#include <optional>

#include "ductile/meshadapt/adapt_options.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/cavity.hpp"
#include "operators/ring.hpp"

namespace ductile::meshadapt {

/// The smooth patch on which a poor element has the two facets that are opposite to p and to q; 0
/// if it is not poor, or has not, or must stay.
inline PatchId patch_above(const Mesh<3>& mesh, ElementId element, VertexId p, VertexId q) {
  static const auto poor = static_cast<float>(quality_of_mean_ratio<3>(0.15));
  if (!(mesh.quality_of[element] < poor)) return 0;
  const auto patch_opposite = [&](VertexId v) {
    const int place = corner_of(mesh.corners_of[element], v);
    return mesh.patches_of[element][static_cast<std::size_t>(place)];
  };
  const PatchId patch = patch_opposite(p);
  if (patch == 0 || patch != patch_opposite(q)) return 0;
  const bool may_change = mesh.patches[patch].smooth && !mesh.patches[patch].required;
  return may_change && !mesh.required_element(element) ? patch : 0;
}

/// Are all facets around this edge inside?
inline bool is_inside(const Mesh<3>& mesh, const Shell& shell, VertexId p, VertexId q) {
  return std::none_of(shell.begin(), shell.end(),
                      [&](ElementId e) { return patch_of_edge(mesh, e, p, q) != 0; });
}

/// Cuts off an element around the edge p-q, which then lies on the patch, if the patch stays close
/// to what it was in the input.
inline std::optional<Replacement<3>> plan_cut_off(const Mesh<3>& mesh, VertexId p, VertexId q,
                                                  const Shell& shell, const Ring& ring) {
  const std::size_t count = shell.size();
  const auto element = [&](std::size_t i) { return shell[ring.order[i % count]]; };
  std::size_t at = 0;
  PatchId patch = 0;
  while (at < count && (patch = patch_above(mesh, element(at), p, q)) == 0) ++at;
  if (at == count || ring.open || mesh.curve_of(p, q) != 0 || !is_inside(mesh, shell, p, q))
    return {};
  const ElementId cut = element(at), before = element(at + count - 1), after = element(at + 1);
  const VertexId a = ring.vertices[at], b = ring.vertices[(at + 1) % count];
  for (const VertexId v : {p, q})  // a patch between regions has elements on both sides
    if (neighbour(mesh, cut, corner_of(mesh.corners_of[cut], v)) != none) return {};
  if (mesh.curve_of(a, b) != 0 || !convex_in_patch(mesh, {a, p, b, q}, patch)) return {};
  Replacement<3> result;
  result.old_elements = {before, after, cut};
  result.new_elements = {mesh.corners_of[before], mesh.corners_of[after]};
  result.new_facets = {{a, p, q}, {b, p, q}};
  result.new_patch = patch;
  return result;
}

}  // namespace ductile::meshadapt
