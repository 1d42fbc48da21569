#include "mesh/pinches.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

namespace {

/// What facets share: the ends of an edge, the lower first, or in 2D a vertex.
template <int Dim>
using Joint = std::array<VertexId, Dim - 1>;

template <int Dim>
std::array<Joint<Dim>, Dim> joints_of(const Facet<Dim>& facet) {
  if constexpr (Dim == 2) {
    return {{{facet[0]}, {facet[1]}}};
  } else {
    const auto edge = [&](std::size_t a, std::size_t b) {
      return Joint<3>{std::min(facet[a], facet[b]), std::max(facet[a], facet[b])};
    };
    return {edge(0, 1), edge(1, 2), edge(2, 0)};
  }
}

/// The joints that have not two facets, sorted, and how many they have. They are put into buckets
/// by their first vertex.
template <int Dim>
std::vector<std::pair<Joint<Dim>, std::size_t>> odd_joints(const std::vector<Facet<Dim>>& facets,
                                                           std::size_t vertex_count) {
  const auto each_joint = [&](auto visit) {
    for (const Facet<Dim>& facet : facets)
      for (const Joint<Dim>& joint : joints_of<Dim>(facet)) visit(joint);
  };
  std::vector<std::size_t> begin(vertex_count + 2);  // [vertex + 1], and while they are filled
  each_joint([&](const Joint<Dim>& joint) { ++begin[joint[0] + 2]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Joint<Dim>> joints(Dim * facets.size());
  each_joint([&](const Joint<Dim>& joint) { joints[begin[joint[0] + 1]++] = joint; });
  for (std::size_t v = 0; v < vertex_count; ++v)
    std::sort(joints.data() + begin[v], joints.data() + begin[v + 1]);
  std::vector<std::pair<Joint<Dim>, std::size_t>> odd;
  for (std::size_t i = 0, end = 0; i < joints.size(); i = end) {
    while (end < joints.size() && joints[end] == joints[i]) ++end;
    if (end - i != 2) odd.emplace_back(joints[i], end - i);
  }
  return odd;
}

}  // namespace

template <int Dim>
std::vector<Facet<Dim>> listed_facets_at_pinches(const AnyMesh& mesh) {
  const auto& listed = facets_in<Dim>(mesh).vertices;
  const auto odd = odd_joints<Dim>(listed, mesh.vertex_count());
  if (odd.empty()) return {};
  const auto is_odd = [&](const Joint<Dim>& joint) {
    const auto at = std::lower_bound(odd.begin(), odd.end(), std::pair(joint, std::size_t{0}));
    return at != odd.end() && at->first == joint;
  };
  std::map<Facet<Dim>, int> elements_at;
  std::vector<bool> concerned(mesh.vertex_count());  // [vertex]
  for (Facet<Dim> facet : listed) {
    const auto joints = joints_of<Dim>(facet);
    if (std::none_of(joints.begin(), joints.end(), is_odd)) continue;
    std::sort(facet.begin(), facet.end());
    elements_at.emplace(facet, 0);
    for (const VertexId v : facet) concerned[v] = true;
  }
  for (const Corners<Dim>& corners : elements_in<Dim>(mesh).vertices) {
    if (std::count_if(corners.begin(), corners.end(), [&](VertexId v) { return concerned[v]; }) <
        Dim)
      continue;
    for (int i = 0; i <= Dim; ++i) {
      Facet<Dim> facet = facet_of<Dim>(corners, i);
      std::sort(facet.begin(), facet.end());
      if (const auto at = elements_at.find(facet); at != elements_at.end()) ++at->second;
    }
  }
  std::vector<Facet<Dim>> found;
  for (const auto& [facet, count] : elements_at)
    if (count == 1) found.push_back(facet);
  return found;
}

template <int Dim>
double pinched_length(const AnyMesh& mesh, const std::vector<Facet<Dim>>& boundary) {
  double sum = 0;
  for (const auto& [joint, count] : odd_joints<Dim>(boundary, mesh.vertex_count())) {
    if (count < 3) continue;  // one with one facet here has another that is at no pinch
    double length = 1;
    if constexpr (Dim == 3)
      length = norm(position_in<3>(mesh, joint[1]) - position_in<3>(mesh, joint[0]));
    sum += length * (static_cast<double>(count) / 2 - 1);
  }
  return sum;
}

template std::vector<Facet<2>> listed_facets_at_pinches<2>(const AnyMesh&);
template std::vector<Facet<3>> listed_facets_at_pinches<3>(const AnyMesh&);
template double pinched_length<2>(const AnyMesh&, const std::vector<Facet<2>>&);
template double pinched_length<3>(const AnyMesh&, const std::vector<Facet<3>>&);

}  // namespace ductile::meshadapt
