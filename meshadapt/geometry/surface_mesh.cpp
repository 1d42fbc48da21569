#include "geometry/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/check_input.hpp"
#include "geometry/classify.hpp"
#include "geometry/curvature.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/fill_mesh.hpp"
#include "geometry/tag_boundary.hpp"
#include "mesh/neighbours.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// The number of the facet that is the triangle, in an element without a fourth corner.
constexpr int boundary_facet = 3;

/// The next corner of a triangle.
constexpr std::size_t next_corner(std::size_t corner) { return (corner + 1) % 3; }

/// A surface as the boundary of elements that have no fourth corner; without patches and curves.
Mesh<3> as_boundary(const Executor& executor, const Mesh<2, 3>& mesh) {
  Mesh<3> boundary;
  boundary.elements_of.reset(executor, 0);
  boundary.links_of.reset(executor, 0);
  boundary.grow(executor, mesh.vertex_slots(), mesh.element_slots());
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    const auto [a, b, c] = mesh.corners_of[e];
    boundary.corners_of[e] = {a, c, b, none};  // whose last facet is a b c
    boundary.patches_of[e] = {0, 0, 0, 0};
    boundary.region_of[e] = 0;
  });
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    boundary.site_of[v] = mesh.site_of[v];
    boundary.kind_of[v] = mesh.kind_of[v];
    boundary.entity_of[v] = mesh.entity_of[v];
    boundary.reference_of[v] = mesh.reference_of[v];
    for (const ElementId e : mesh.elements_of.of(static_cast<VertexId>(v)))
      boundary.elements_of.insert(static_cast<std::uint32_t>(v), e);
  });
  boundary.regions.push_back({});
  return boundary;
}

/// The same with its patches and curves.
Mesh<3> classified_boundary(const Executor& executor, const Mesh<2, 3>& mesh) {
  Mesh<3> boundary = as_boundary(executor, mesh);
  parallel_for(executor, mesh.element_slots(),
               [&](std::size_t e) { boundary.patches_of[e][boundary_facet] = mesh.region_of[e]; });
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t at) {
    const auto v = static_cast<VertexId>(at);
    const auto around = mesh.elements_of.of(v);
    if (mesh.kind_of[v].class_dimension == 2 && !around.empty())
      boundary.entity_of[v] = mesh.region_of[around[0]];
    std::vector<CurveLink> links;  // once for each triangle
    for (const ElementId e : around)
      for (std::size_t i = 0; i < 3; ++i)
        if (const CurveId curve = mesh.patches_of[e][i]; curve != 0) {
          const VertexId a = mesh.corners_of[e][next_corner(i)],
                         b = mesh.corners_of[e][next_corner(next_corner(i))];
          if (a == v || b == v) links.push_back({a == v ? b : a, curve});
        }
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    for (const CurveLink& link : links) boundary.links_of.insert(v, link);
  });
  boundary.patches = mesh.regions;
  boundary.curves = mesh.patches;
  boundary.surface = mesh.surface;
  return boundary;
}

class SurfaceMeshMaker {
 public:
  SurfaceMeshMaker(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options,
                   Neighbours<2>& neighbours, std::vector<std::string>& warnings)
      : executor_(executor),
        any_(any),
        options_(options),
        neighbours_(neighbours),
        warnings_(warnings),
        corners_(any.triangles.vertices),
        sides_(executor, corners_.size(), [&](std::size_t e) { return corners_[e]; }) {}

  Mesh<2, 3> make() {
    fill();
    rebuild_elements_of(executor_, mesh_);
    report_unused_vertices(executor_, any_, mesh_, warnings_);
    find_neighbours(executor_, mesh_, neighbours_);
    parallel_for(executor_, mesh_.element_slots(),
                 [&](std::size_t e) { std::ranges::replace(neighbours_[e], crowded, none); });
    classify();
    return std::move(mesh_);
  }

 private:
  void warn(const std::string& text) { warnings_.push_back(name_of(any_) + ": " + text); }

  // ---- The mesh ----

  void fill() {
    fill_mesh(executor_, any_, corners_, mesh_);
    parallel_for(executor_, any_.vertex_count(), [&](std::size_t v) { mesh_.entity_of[v] = 0; });
  }

  // ---- Patches and curves ----

  std::vector<TaggedFacet<3>> facets() const {
    const auto required = marked(any_, any_.triangles.size(), any_.required_triangles, "triangle");
    std::vector<TaggedFacet<3>> facets(corners_.size());
    parallel_for(executor_, facets.size(), [&](std::size_t e) {
      facets[e].corners = corners_[e];
      facets[e].data = {{}, any_.triangles.reference[e], true, required[e]};
      facets[e].element = static_cast<ElementId>(e);
      facets[e].facet = boundary_facet;
    });
    return facets;
  }

  /// Edges that are listed, that cannot be smooth, or that shall stay.
  std::vector<ListedEdge> listed_edges(MeshInMaking<3>& making) {
    std::vector<ListedEdge> edges = tag_edges(making);
    const std::vector<SideKey> seams = seams_of(sides_, corners_);
    if (!seams.empty())
      warn("the surface has one side only: " + std::to_string(seams.size()) +
           " edges, where neighbours cannot be turned alike, are kept as curves");
    std::map<SideKey, std::size_t> index_of;
    for (std::size_t i = 0; i < edges.size(); ++i)
      index_of.emplace(edge_key(edges[i].a, edges[i].b), i);
    const auto keep = [&](SideKey key, bool required) {
      const auto [at, is_new] = index_of.emplace(key, edges.size());
      if (is_new) edges.push_back({static_cast<VertexId>(key >> 32U), static_cast<VertexId>(key)});
      edges[at->second].required = edges[at->second].required || required;
    };
    for (const SideKey key : seams) keep(key, false);
    if (options_.lock_boundary)
      sides_.each_run([&](std::span<const FacetSide> run) {
        if (run.size() == 1) keep(run[0].key, true);
      });
    return edges;
  }

  void classify() {
    Neighbours<3> unused;
    MeshInMaking<3> making{
        executor_, any_, options_, unused, warnings_, false, as_boundary(executor_, mesh_)};
    const auto edges = listed_edges(making);
    Mesh<3>& boundary = making.mesh;
    meshadapt::classify(executor_, boundary, facets(), edges, options_);
    parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t v) {
      mesh_.kind_of[v] = boundary.kind_of[v];
      mesh_.entity_of[v] = boundary.kind_of[v].class_dimension == 1 ? boundary.entity_of[v] : 0;
    });
    parallel_for(executor_, mesh_.element_slots(), [&](std::size_t e) {
      mesh_.region_of[e] = boundary.patches_of[e][boundary_facet];
      for (std::size_t i = 0; i < 3; ++i)
        mesh_.patches_of[e][i] = boundary.curve_of(corners_[e][next_corner(i)],
                                                   corners_[e][next_corner(next_corner(i))]);
    });
    mark_crack_sides(boundary);
    mesh_.patches = std::move(boundary.curves);
    mesh_.regions = std::move(boundary.patches);
    mesh_.surface = std::move(boundary.surface);
    mesh_.rounding = std::move(boundary.rounding);
  }

  /// Curves with the same ends may be the sides of a slit.
  static void mark_crack_sides(Mesh<3>& boundary) {
    std::vector<std::array<VertexId, 2>> ends_of(boundary.curves.size(), {none, none});
    for (VertexId v = 0; v < boundary.vertex_slots(); ++v)
      if (boundary.kind_of[v].class_dimension == 0)
        for (const CurveLink& link : boundary.links_of.of(v)) {
          auto& ends = ends_of[link.curve];
          (ends[0] == none ? ends[0] : ends[1]) = v;
        }
    std::map<std::array<VertexId, 2>, CurveId> first_with;
    for (CurveId c = 1; c < boundary.curves.size(); ++c) {
      if (ends_of[c][1] == none) continue;
      const auto [at, is_new] = first_with.emplace(ends_of[c], c);
      if (!is_new) boundary.curves[c].crack_side = boundary.curves[at->second].crack_side = true;
    }
  }

  const Executor& executor_;
  const AnyMesh& any_;
  const MakeMeshOptions& options_;
  Neighbours<2>& neighbours_;
  std::vector<std::string>& warnings_;
  Mesh<2, 3> mesh_;
  const std::vector<Corners<2>>& corners_;  // [element]
  FacetSides<3> sides_;
};

}  // namespace

Mesh<2, 3> make_surface_mesh(const Executor& executor, const AnyMesh& any,
                             const MakeMeshOptions& options, Neighbours<2>& neighbours,
                             std::vector<std::string>& warnings) {
  const auto mended = mended_surface(executor, any, options, warnings);
  return SurfaceMeshMaker(executor, mended ? *mended : any, options, neighbours, warnings).make();
}

void bound_curved_sizes(const Executor& executor, const Mesh<2, 3>& mesh, double tolerance,
                        std::vector<Metric<3>>& metric_of) {
  bound_curved_sizes(executor, classified_boundary(executor, mesh), tolerance, metric_of);
}

}  // namespace ductile::meshadapt
