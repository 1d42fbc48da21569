#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::meshadapt {
namespace {

template <int Dim>
class PatchFinder {
 public:
  explicit PatchFinder(BoundaryParts<Dim>& parts) : parts_(parts) { find_neighbours(); }

  void find() {
    find_patches();
    if (!(parts_.within.surface > 0)) return;
    find_kept(parts_.options.keep_facets_at);
    find_noise<Dim>(parts_, std::span(beside_));
    join_patches();
  }

 private:
  // ---- Sides: what facets share ----

  /// Sets beside_, where a side does not separate patches by itself, and across_, where a patch
  /// that is flat goes on.
  void find_neighbours() {
    std::array<std::uint32_t, Dim> nobody;
    nobody.fill(none);
    runtime::grow_filled(parts_.executor, across_, parts_.facets.size(), nobody);
    runtime::grow_filled(parts_.executor, beside_, parts_.facets.size(), nobody);
    runtime::parallel_for(parts_.executor, parts_.sides.size(), [&](std::size_t i) {
      if (!parts_.sides.begins_run(i)) return;
      const auto both = parts_.sides.run_at(i);
      if (both.size() != 2 || separates(both[0].key) || !agree(both[0].facet, both[1].facet))
        return;
      const auto link = [&](auto& others) {
        others[both[0].facet][both[0].number] = both[1].facet;
        others[both[1].facet][both[1].number] = both[0].facet;
      };
      link(beside_);
      if (!folds_back<Dim>(parts_.mesh, parts_.facets[both[0].facet].corners,
                           parts_.facets[both[1].facet].corners, both[0].key))
        link(across_);
    });
  }

  bool separates(SideKey key) const {
    if constexpr (Dim == 3) return parts_.listed.contains(key);
    const VertexKind& kind = parts_.mesh.kind_of[static_cast<VertexId>(key)];
    return kind.corner || kind.required;
  }

  // ---- Patches: grow each from its largest facet over flat neighbours that agree with it ----

  void find_patches() {
    parts_.mesh.patches.assign(1, {});
    using Seed = std::pair<double, std::uint32_t>;
    auto order = runtime::make_unset_vector<Seed>(parts_.executor, parts_.facets.size());
    runtime::parallel_for(parts_.executor, order.size(), [&](std::size_t f) {
      order[f] = {-norm(normal_of<Dim>(parts_.mesh, parts_.facets[f].corners)),
                  static_cast<std::uint32_t>(f)};
    });
    runtime::parallel_sort(parts_.executor, std::span(order));
    find_flat_parts<Dim>(parts_, std::span(across_));
    for (const auto& [size, seed] : order)
      if (parts_.facets[seed].patch == 0) grow_patch(seed);
  }

  void grow_patch(std::uint32_t seed) {
    const auto id = static_cast<PatchId>(parts_.mesh.patches.size());
    Patch<Dim> patch = parts_.facets[seed].data;
    patch.normal = normal_of<Dim>(parts_.mesh, parts_.facets[seed].corners);
    patch.normal *= 1 / norm(patch.normal);
    const Vector<Dim> origin = parts_.mesh.site_of[parts_.facets[seed].corners[0]].position;
    parts_.facets[seed].patch = id;
    std::vector<std::uint32_t> front{seed};
    while (!front.empty()) {
      const std::uint32_t f = front.back();
      front.pop_back();
      for (const std::uint32_t next : across_[f]) {
        if (next == none || parts_.facets[next].patch != 0) continue;
        if (!in_plane(parts_.facets[next].corners, origin, patch.normal)) continue;
        parts_.facets[next].patch = id;
        front.push_back(next);
      }
    }
    parts_.mesh.patches.push_back(patch);
  }

  bool agree(std::uint32_t f, std::uint32_t g) const {
    const auto traits = [&](const TaggedFacet<Dim>& t) {
      const auto region = [&](ElementId e) { return e == none ? none : parts_.mesh.region_of[e]; };
      const std::uint32_t a = region(t.element), b = region(t.other);
      return std::tuple(t.data.reference, t.data.listed, t.data.required, t.data.ridge,
                        std::min(a, b), std::max(a, b));
    };
    return traits(parts_.facets[f]) == traits(parts_.facets[g]) &&
           parts_.sheet_of(f) == parts_.sheet_of(g);
  }

  bool in_plane(const Facet<Dim>& facet, const Vector<Dim>& origin,
                const Vector<Dim>& normal) const {
    for (const VertexId v : facet)
      if (std::abs(dot(parts_.mesh.site_of[v].position - origin, normal)) > parts_.within.flat)
        return false;
    const Vector<Dim> own = normal_of<Dim>(parts_.mesh, facet);
    return std::abs(dot(own, normal)) > 0.9 * norm(own);
  }

  // ---- Smooth patches: flat ones that turn little where they meet ----

  /// If the boundary lies against itself, both sides keep their facets, so that they do not cross.
  void find_kept(const std::vector<VertexId>& more) {
    constexpr double touch = 1e-8;  // of the extent
    find_touching(parts_, touch * parts_.extent);
    for (const VertexId v : more) parts_.kept[v] = 1;
  }

  bool keeps_shape(const TaggedFacet<Dim>& facet) const {
    return std::any_of(facet.corners.begin(), facet.corners.end(),
                       [&](VertexId v) { return parts_.kept[v] != 0; });
  }

  void join_patches() {
    runtime::DisjointSets joined(parts_.executor, parts_.mesh.patches.size());
    for (const FacetSide& side : parts_.sides) {
      const std::uint32_t f = side.facet, g = beside_[f][side.number];
      if (g == none || g < f || parts_.mesh.patches[parts_.facets[f].patch].required ||
          keeps_shape(parts_.facets[f]) || keeps_shape(parts_.facets[g]))
        continue;
      const PatchId p = joined.lowest(parts_.facets[f].patch);
      const PatchId q = joined.lowest(parts_.facets[g].patch);
      if (p == q || !may_join(f, g, side.key)) continue;
      joined.unite(p, q);
      parts_.mesh.patches[p].smooth = parts_.mesh.patches[q].smooth = true;
    }
    parts_.plane_of.reserve(parts_.facets.size());
    for (TaggedFacet<Dim>& facet : parts_.facets) {
      parts_.plane_of.push_back(facet.patch);
      facet.patch = joined.lowest(facet.patch);
    }
    for (std::uint32_t f = 0; f < parts_.facets.size(); ++f) {
      Patch<Dim>& patch = parts_.mesh.patches[parts_.facets[f].patch];
      patch.sheet = parts_.reference == nullptr ? parts_.facets[f].patch : parts_.sheet_of(f);
      if (parts_.is_on_curved_sheet(f) && !patch.required && !keeps_shape(parts_.facets[f]))
        patch.smooth = true;
    }
  }

  /// Are two facets parts of one smooth patch? With a reference, if it has one there.
  bool may_join(std::uint32_t f, std::uint32_t g, SideKey side) const {
    if (parts_.reference == nullptr) return parts_.turns_little(f, g, side);
    // The sheet of g is the same, see agree().
    return parts_.is_on_curved_sheet(f) && (!folds_back<Dim>(parts_.mesh, parts_.facets[f].corners,
                                                             parts_.facets[g].corners, side) ||
                                            parts_.turns_little(f, g, side));
  }

  using Others = std::array<std::uint32_t, Dim>;
  BoundaryParts<Dim>& parts_;
  runtime::UnsetVector<Others> across_;  // [facet][side], the other facet or none
  runtime::UnsetVector<Others> beside_;  // the same, though it may fold back
};

}  // namespace

template <int Dim>
void classify_patches(BoundaryParts<Dim>& parts) {
  PatchFinder<Dim>(parts).find();
}

template void classify_patches(BoundaryParts<2>&);
template void classify_patches(BoundaryParts<3>&);

}  // namespace ductile::meshadapt
