#include "geometry/touching.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "ductile/runtime/worklist.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/distance.hpp"

namespace ductile::meshadapt {

template <int Dim>
std::vector<std::uint8_t> touching_vertices(const runtime::Executor& executor,
                                            const Mesh<Dim>& mesh,
                                            const std::vector<Facet<Dim>>& facets, double within) {
  const auto points = [&](std::size_t f) {
    std::array<Vector<Dim>, Dim> at;
    for (std::size_t i = 0; i < Dim; ++i) at[i] = mesh.site_of[facets[f][i]].position;
    return at;
  };
  const BoxHierarchy<Dim> index(facets.size(),
                                [&](std::size_t f) { return box_around(points(f)); });
  using Contact = std::pair<VertexId, std::uint32_t>;  // and a facet
  const auto find = [&](std::size_t f, auto&& append) {
    for (const VertexId v : facets[f]) {
      const Vector<Dim>& at = mesh.site_of[v].position;
      auto box = Box<Dim>{at, at};
      for (int i = 0; i < Dim; ++i) {
        box.low[i] -= within;
        box.high[i] += within;
      }
      index.each_meeting(box, [&](std::size_t g) {
        if (contains(facets[g], v) || norm(closest_point(points(g), at) - at) > within) return;
        append(Contact{v, static_cast<std::uint32_t>(g)});
      });
    }
  };
  std::vector<std::uint8_t> touching(mesh.vertex_slots());
  for (const auto& [v, facet] : runtime::parallel_collect<Contact>(executor, facets.size(), find)) {
    touching[v] = 1;
    for (const VertexId corner : facets[facet]) touching[corner] = 1;
  }
  return touching;
}

template std::vector<std::uint8_t> touching_vertices<2>(const runtime::Executor&, const Mesh<2>&,
                                                        const std::vector<Facet<2>>&, double);
template std::vector<std::uint8_t> touching_vertices<3>(const runtime::Executor&, const Mesh<3>&,
                                                        const std::vector<Facet<3>>&, double);

}  // namespace ductile::meshadapt
