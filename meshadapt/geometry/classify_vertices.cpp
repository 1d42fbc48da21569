#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::meshadapt {
namespace {

template <int Dim>
class VertexClassifier {
 public:
  explicit VertexClassifier(const BoundaryParts<Dim>& parts) : parts_(parts) {}

  void run() const {
    const auto corners = corners_with_patches();  // vertex, then patch
    const auto vertex_at = [&](std::size_t i) { return static_cast<VertexId>(corners[i] >> 32U); };
    std::vector<std::uint32_t> first_of(parts_.mesh.vertex_slots(),
                                        none);  // [vertex], among corners
    runtime::parallel_for(parts_.executor, corners.size(), [&](std::size_t i) {
      if (i == 0 || vertex_at(i - 1) != vertex_at(i))
        first_of[vertex_at(i)] = static_cast<std::uint32_t>(i);
    });
    runtime::parallel_for(parts_.executor, parts_.mesh.vertex_slots(), [&](std::size_t v) {
      std::vector<PatchId> patches;
      std::size_t facet_count = 0;
      for (std::size_t i = first_of[v]; i < corners.size() && vertex_at(i) == v; ++i) {
        const auto patch = static_cast<PatchId>(corners[i]);
        if (patches.empty() || patches.back() != patch) patches.push_back(patch);
        ++facet_count;
      }
      classify_vertex(static_cast<VertexId>(v), patches, facet_count);
    });
  }

 private:
  /// The corners of all facets, each with its facet's patch, sorted.
  runtime::UnsetVector<std::uint64_t> corners_with_patches() const {
    auto corners =
        runtime::make_unset_vector<std::uint64_t>(parts_.executor, Dim * parts_.facets.size());
    runtime::parallel_for(parts_.executor, parts_.facets.size(), [&](std::size_t f) {
      for (std::size_t i = 0; i < Dim; ++i)
        corners[Dim * f + i] =
            std::uint64_t{parts_.facets[f].corners[i]} << 32U | parts_.facets[f].patch;
    });
    runtime::parallel_sort(parts_.executor, std::span(corners));
    return corners;
  }

  void classify_vertex(VertexId v, const std::vector<PatchId>& patches,
                       std::size_t facet_count) const {
    VertexKind& kind = parts_.mesh.kind_of[v];
    kind.class_dimension = 0;
    parts_.mesh.entity_of[v] = 0;
    if (kind.corner || kind.required || touches_required(v, patches)) return;
    std::uint32_t links = 0;
    if constexpr (Dim == 3) links = static_cast<std::uint32_t>(parts_.mesh.links_of.of(v).size());
    if (patches.empty() && links == 0) {
      kind.class_dimension = Dim;
    } else if (patches.size() == 1 && links == 0 &&
               (Dim == 3 ? is_met_once(v, facet_count)
                         : facet_count == 2 && !parts_.is_sharp(parts_.sides.at(v)))) {
      kind.class_dimension = Dim - 1;
      parts_.mesh.entity_of[v] = patches[0];
    } else if constexpr (Dim == 3) {
      if (!on_one_curve(v, patches) || !is_met_once(v, facet_count)) return;
      kind.class_dimension = 1;
      parts_.mesh.entity_of[v] = parts_.mesh.links_of.of(v)[0].curve;
    }
  }

  bool on_one_curve(VertexId v, const std::vector<PatchId>& patches) const {
    const auto links = parts_.mesh.links_of.of(v);
    if (links.size() != 2 || links[0].curve != links[1].curve) return false;
    auto along = parts_.patches_at(edge_key(v, links[0].to));
    along.erase(std::unique(along.begin(), along.end()), along.end());
    return along == patches;
  }

  /// Are all facets around a vertex connected there, by facets or along its curve? What bends may
  /// touch itself at a vertex; what is flat has another patch there.
  bool is_met_once(VertexId v, std::size_t facet_count) const {
    if (parts_.within.surface == 0 || facet_count == 0) return true;
    if constexpr (Dim == 3) {
      const auto links = parts_.mesh.links_of.of(v);
      if (!links.empty()) {
        std::size_t count = 0;
        for (const FacetSide& side : parts_.sides.at(edge_key(v, links[0].to)))
          count += facets_around(parts_.mesh, parts_.facets, parts_.sides, v, side);
        return count == facet_count;
      }
      for (const ElementId e : parts_.mesh.elements_of.of(v))
        for (std::size_t i = 0; i < 4; ++i) {
          if (parts_.mesh.patches_of[e][i] == 0 || parts_.mesh.corners_of[e][i] == v) continue;
          const Facet<3> facet = facet_of<3>(parts_.mesh.corners_of[e], static_cast<int>(i));
          const VertexId other = facet[0] == v ? facet[1] : facet[0];
          return facets_around(parts_.mesh, parts_.facets, parts_.sides, v,
                               parts_.sides.at(edge_key(v, other))[0]) == facet_count;
        }
    }
    return true;
  }

  bool touches_required(VertexId v, const std::vector<PatchId>& patches) const {
    for (const PatchId p : patches)
      if (parts_.mesh.patches[p].required) return true;
    if constexpr (Dim == 3)
      for (const CurveLink& link : parts_.mesh.links_of.of(v))
        if (parts_.mesh.curves[link.curve].required) return true;
    for (const ElementId e : parts_.mesh.elements_of.of(v))
      if (parts_.mesh.required_element(e)) return true;
    return false;
  }

  const BoundaryParts<Dim>& parts_;
};

}  // namespace

template <int Dim>
void classify_vertices(const BoundaryParts<Dim>& parts) {
  VertexClassifier<Dim>(parts).run();
}

template void classify_vertices(const BoundaryParts<2>&);
template void classify_vertices(const BoundaryParts<3>&);

}  // namespace ductile::meshadapt
