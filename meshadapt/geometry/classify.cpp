#include "geometry/classify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>

#include "ductile/meshadapt/geometry.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "geometry/crack_sides.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/levelled.hpp"
#include "geometry/reference_surface.hpp"
#include "geometry/rough_parts.hpp"
#include "geometry/rounding.hpp"
#include "geometry/surface.hpp"
#include "geometry/touching.hpp"
#include "geometry/wide_normals.hpp"

namespace ductile::meshadapt {

namespace {

/// Flat and straight mean: within this fraction of the mesh's extent of one plane or line; or as
/// far from one as rounding explains (see rough_parts.hpp).
constexpr double flatness = 1e-10;
/// Of the extent. Coordinates that seem to be rounded by as much are round numbers by choice.
constexpr double coarsest = 0.02;

template <int Dim>
double extent(const runtime::Executor& executor, const Mesh<Dim>& mesh) {
  VertexId first = 0;
  while (first < mesh.vertex_slots() && !mesh.vertex_alive(first)) ++first;
  const auto distance = [&](std::size_t v) {
    if (!mesh.vertex_alive(static_cast<VertexId>(v))) return 0.0;
    return norm(mesh.site_of[v].position - mesh.site_of[first].position);
  };
  return runtime::parallel_reduce(executor, mesh.vertex_slots(), 0.0, distance,
                                  [](double a, double b) { return std::max(a, b); });
}

template <int Dim>
class Classifier {
 public:
  Classifier(const runtime::Executor& executor, Mesh<Dim>& mesh,
             std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
             const MakeMeshOptions& options)
      : executor_(executor),
        mesh_(mesh),
        facets_(std::move(facets)),
        extent_(extent(executor, mesh)),
        tolerance_(flatness * extent_),
        options_(options),
        hausdorff_tolerance_(options.hausdorff_tolerance),
        least_turn_(std::cos(options.ridge_angle * std::numbers::pi / 180)),
        sides_(executor, facets_) {
    if (options.geometry && hausdorff_tolerance_ > 0) reference_ = options.geometry->surface<Dim>();
    if (reference_ != nullptr) sheet_of_ = reference_->sheets_of(executor, mesh, facets_);
    if constexpr (Dim == 3)
      for (const ListedEdge& edge : edges) listed_.emplace(edge_key(edge.a, edge.b), edge);
    find_neighbours();
  }

  void run() {
    find_patches();
    if (hausdorff_tolerance_ > 0) {
      find_kept(options_.keep_facets_at);
      wide_normals_ = wide_normals<Dim>(executor_, mesh_, facets_, std::span(beside_),
                                        {hausdorff_tolerance_, least_turn_});
      join_patches();
    }
    if constexpr (Dim == 3) find_curve_edges();
    if (hausdorff_tolerance_ > 0 && reference_ == nullptr) level();
    if constexpr (Dim == 3) grow_curves();
    const bool is_rough = rounding_ && !(rounding_->plane_of.empty() && rounding_->line_of.empty());
    mark_crack_sides(executor_, mesh_, facets_, sides_,
                     is_rough ? rounding_->tolerance : tolerance_);
    store_patches();
    if (hausdorff_tolerance_ > 0) keep_surface();
    classify_vertices();
    if (is_rough) mesh_.rounding = std::move(rounding_);
  }

 private:
  // ---- Sides: what facets share ----

  /// Sets beside_, where a side does not separate patches by itself, and across_, where a patch
  /// that is flat goes on.
  void find_neighbours() {
    std::array<std::uint32_t, Dim> nobody;
    nobody.fill(none);
    runtime::grow_filled(executor_, across_, facets_.size(), nobody);
    runtime::grow_filled(executor_, beside_, facets_.size(), nobody);
    runtime::parallel_for(executor_, sides_.size(), [&](std::size_t i) {
      if (!sides_.begins_run(i)) return;
      const auto both = sides_.run_at(i);
      if (both.size() != 2 || separates(both[0].key) || !agree(both[0].facet, both[1].facet))
        return;
      const auto link = [&](auto& others) {
        others[both[0].facet][both[0].number] = both[1].facet;
        others[both[1].facet][both[1].number] = both[0].facet;
      };
      link(beside_);
      if (!folds_back<Dim>(mesh_, facets_[both[0].facet].corners, facets_[both[1].facet].corners,
                           both[0].key))
        link(across_);
    });
  }

  bool separates(SideKey key) const {
    if constexpr (Dim == 3) return listed_.contains(key);
    const VertexKind& kind = mesh_.kind_of[static_cast<VertexId>(key)];
    return kind.corner || kind.required;
  }

  // ---- Patches: grow each from its largest facet over flat neighbours that agree with it ----

  void find_patches() {
    mesh_.patches.assign(1, {});
    using Seed = std::pair<double, std::uint32_t>;
    auto order = runtime::make_unset_vector<Seed>(executor_, facets_.size());
    runtime::parallel_for(executor_, order.size(), [&](std::size_t f) {
      order[f] = {-norm(normal_of<Dim>(mesh_, facets_[f].corners)), static_cast<std::uint32_t>(f)};
    });
    runtime::parallel_sort(executor_, std::span(order));
    find_rough_patches();
    for (const auto& [size, seed] : order)
      if (facets_[seed].patch == 0) grow_patch(seed);
  }

  // ---- What is flat up to how precisely it was written ----

  /// By how much rounding may have moved what the boundary and curves are made of; 0 if they are
  /// precise.
  double rounding() {
    if (rounding_) return rounding_->tolerance;
    rounding_ = std::make_shared<Rounding<Dim>>();
    std::vector<bool> seen(mesh_.vertex_slots());
    PrecisionFinder finder;
    const auto add = [&](VertexId v) {
      if (seen[v]) return true;
      seen[v] = true;
      const auto& x = mesh_.site_of[v].position.x;
      return std::all_of(x.begin(), x.end(), [&](double value) { return finder.add(value); });
    };
    const auto add_all = [&](const auto& corners) {
      return std::all_of(corners.begin(), corners.end(), add);
    };
    for (const TaggedFacet<Dim>& f : facets_)
      if (!add_all(f.corners)) return 0;
    for (const auto& [key, edge] : listed_)
      if (!add_all(std::array{edge.a, edge.b})) return 0;
    rounding_->precision = finder.precision();
    const double tolerance = rounding_tolerance<Dim>(rounding_->precision);
    const bool matters = tolerance > tolerance_ && tolerance < coarsest * extent_;
    return rounding_->tolerance = matters ? tolerance : 0;
  }

  void find_rough_patches() {
    const RoughParts<Dim, decltype(across_)> parts(mesh_, facets_, across_);
    const bool rough = runtime::parallel_reduce(
        executor_, facets_.size(), false,
        [&](std::size_t f) { return parts.is_rough(static_cast<std::uint32_t>(f), tolerance_); },
        std::logical_or<>());
    if (!rough || !(rounding() > 0)) return;
    const auto found = parts.all(rounding(), tolerance_);
    // If none is rough, the coordinates are round numbers by choice.
    if (std::none_of(found.begin(), found.end(), [](const auto& part) { return part.rough; }))
      return;
    for (const auto& [part, plane, _] : found) {
      const auto id = static_cast<PatchId>(mesh_.patches.size());
      Patch<Dim> patch = facets_[part.front()].data;
      patch.normal = plane.direction;
      for (const std::uint32_t f : part) facets_[f].patch = id;
      mesh_.patches.push_back(patch);
      rounding_->plane_of.resize(mesh_.patches.size());
      rounding_->plane_of.back() = plane;
    }
  }

  void grow_patch(std::uint32_t seed) {
    const auto id = static_cast<PatchId>(mesh_.patches.size());
    Patch<Dim> patch = facets_[seed].data;
    patch.normal = normal_of<Dim>(mesh_, facets_[seed].corners);
    patch.normal *= 1 / norm(patch.normal);
    const Vector<Dim> origin = mesh_.site_of[facets_[seed].corners[0]].position;
    facets_[seed].patch = id;
    std::vector<std::uint32_t> front{seed};
    while (!front.empty()) {
      const std::uint32_t f = front.back();
      front.pop_back();
      for (const std::uint32_t next : across_[f]) {
        if (next == none || facets_[next].patch != 0) continue;
        if (!in_plane(facets_[next].corners, origin, patch.normal)) continue;
        facets_[next].patch = id;
        front.push_back(next);
      }
    }
    mesh_.patches.push_back(patch);
  }

  bool agree(std::uint32_t f, std::uint32_t g) const {
    const auto traits = [&](const TaggedFacet<Dim>& t) {
      const auto region = [&](ElementId e) { return e == none ? none : mesh_.region_of[e]; };
      const std::uint32_t a = region(t.element), b = region(t.other);
      return std::tuple(t.data.reference, t.data.listed, t.data.required, t.data.ridge,
                        std::min(a, b), std::max(a, b));
    };
    return traits(facets_[f]) == traits(facets_[g]) && sheet_of(f) == sheet_of(g);
  }

  /// The reference's sheet that a facet stands for; none if there is no such or no reference.
  std::uint32_t sheet_of(std::uint32_t facet) const {
    return sheet_of_.empty() ? none : sheet_of_[facet];
  }
  bool is_on_curved_sheet(std::uint32_t facet) const {
    return sheet_of(facet) != none && reference_->is_smooth[sheet_of(facet)] != 0;
  }

  bool in_plane(const Facet<Dim>& facet, const Vector<Dim>& origin,
                const Vector<Dim>& normal) const {
    for (const VertexId v : facet)
      if (std::abs(dot(mesh_.site_of[v].position - origin, normal)) > tolerance_) return false;
    const Vector<Dim> own = normal_of<Dim>(mesh_, facet);
    return std::abs(dot(own, normal)) > 0.9 * norm(own);
  }

  // ---- Smooth patches: flat ones that turn little where they meet ----

  /// Where the boundary lies against itself both sides keep the facets they have, lest they cross.
  void find_kept(const std::vector<VertexId>& more) {
    constexpr double touch = 1e-8;  // of the extent
    std::vector<Facet<Dim>> boundary;
    for (const TaggedFacet<Dim>& facet : facets_)
      if (facet.other == none) boundary.push_back(facet.corners);
    kept_ = touching_vertices<Dim>(executor_, mesh_, boundary, touch * extent_);
    for (const VertexId v : more) kept_[v] = 1;
  }

  bool keeps_shape(const TaggedFacet<Dim>& facet) const {
    return std::any_of(facet.corners.begin(), facet.corners.end(),
                       [&](VertexId v) { return kept_[v] != 0; });
  }

  void join_patches() {
    std::vector<PatchId> joined(mesh_.patches.size());  // [patch], another of the same, or itself
    std::iota(joined.begin(), joined.end(), 0);
    const auto find = [&](PatchId p) {
      while (joined[p] != p) p = joined[p] = joined[joined[p]];
      return p;
    };
    for (const FacetSide& side : sides_) {
      const std::uint32_t f = side.facet, g = beside_[f][side.number];
      if (g == none || g < f || mesh_.patches[facets_[f].patch].required ||
          keeps_shape(facets_[f]) || keeps_shape(facets_[g]))
        continue;
      const PatchId p = find(facets_[f].patch), q = find(facets_[g].patch);
      if (p == q || !may_join(f, g, side.key)) continue;
      joined[std::max(p, q)] = std::min(p, q);
      mesh_.patches[p].smooth = mesh_.patches[q].smooth = true;
    }
    plane_of_.reserve(facets_.size());
    for (TaggedFacet<Dim>& facet : facets_) {
      plane_of_.push_back(facet.patch);
      facet.patch = find(facet.patch);
    }
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      Patch<Dim>& patch = mesh_.patches[facets_[f].patch];
      patch.sheet = reference_ == nullptr ? facets_[f].patch : sheet_of(f);
      if (is_on_curved_sheet(f) && !patch.required && !keeps_shape(facets_[f])) patch.smooth = true;
    }
  }

  /// Are two facets parts of one smooth patch? With a reference, if it has one there.
  bool may_join(std::uint32_t f, std::uint32_t g, SideKey side) const {
    if (reference_ == nullptr) return turns_little(f, g, side);
    // The sheet of g is the same, see agree().
    return is_on_curved_sheet(f) &&
           (!folds_back<Dim>(mesh_, facets_[f].corners, facets_[g].corners, side) ||
            turns_little(f, g, side));
  }

  /// Does a smooth patch have an edge here, or in 2D a corner, that fades out elsewhere?
  bool is_sharp(std::span<const FacetSide> both) const {
    const std::uint32_t f = both[0].facet, g = both[1].facet;
    return mesh_.patches[facets_[f].patch].smooth && !turns_little(f, g, both[0].key);
  }

  bool turns_little(std::uint32_t f, std::uint32_t g, SideKey key) const {
    const Facet<Dim>&p = facets_[f].corners, &q = facets_[g].corners;
    const Vector<Dim> u = away_from<Dim>(mesh_, p, key), v = away_from<Dim>(mesh_, q, key);
    if (dot(u, v) < -least_turn_ * norm(u) * norm(v)) return true;
    if (wide_normals_.empty() || !(is_noise(f) || is_noise(g))) return false;
    const double side = face_alike(mesh_, facets_[f], facets_[g]) ? 1 : -1;
    return side * dot(wide_normal(f), wide_normal(g)) > least_turn_;
  }
  bool is_noise(std::uint32_t facet) const { return norm(wide_normals_[facet]) > 0; }
  Vector<Dim> wide_normal(std::uint32_t facet) const {
    if (is_noise(facet)) return wide_normals_[facet];
    const Vector<Dim> own = normal_of<Dim>(mesh_, outward_corners(mesh_, facets_[facet]));
    return (1 / norm(own)) * own;
  }

  /// Keeps what smooth patches and curves are like, and what their facets must not come close to.
  void keep_surface() {
    if (reference_ != nullptr) {
      mesh_.surface = reference_->surface;
      return;
    }
    std::vector<SurfaceEdge> edges;
    edges.reserve(curve_edges_.size());
    for (const CurveEdge& e : curve_edges_)
      edges.push_back({e.a, e.b, e.curve, first_two(e.patches)});
    mesh_.surface =
        make_surface<Dim>(executor_, mesh_, {facets_, plane_of_, wide_normals_, edges, places_},
                          {hausdorff_tolerance_, tolerance_, least_turn_, options_.functions});
  }

  /// Of sorted patches two that differ, 0 where there is no other.
  static std::array<PatchId, 2> first_two(const std::vector<PatchId>& patches) {
    if (patches.empty()) return {};
    return {patches.front(), patches.back() == patches.front() ? 0 : patches.back()};
  }

  void store_patches() {
    runtime::parallel_for(executor_, facets_.size(), [&](std::size_t i) {
      const TaggedFacet<Dim>& f = facets_[i];
      mesh_.patches_of[f.element][static_cast<std::size_t>(f.facet)] = f.patch;
      if (f.other != none)
        mesh_.patches_of[f.other][static_cast<std::size_t>(f.other_facet)] = f.patch;
    });
  }

  // ---- Noise: where vertices would be without it ----

  void level() {
    std::vector<std::uint8_t> held = kept_;
    for (VertexId v = 0; v < held.size(); ++v)
      if (mesh_.kind_of[v].corner || mesh_.kind_of[v].required) held[v] = 1;
    for (const TaggedFacet<Dim>& facet : facets_)
      if (mesh_.patches[facet.patch].required)
        for (const VertexId v : facet.corners) held[v] = 1;
    if constexpr (Dim == 2)
      for (std::size_t i = 0; i < sides_.size(); ++i) {
        const auto both = sides_.run_at(i);
        if (both.size() != 2 || facets_[both[0].facet].patch != facets_[both[1].facet].patch ||
            is_sharp(both))
          held[static_cast<VertexId>(both[0].key)] = 1;
      }
    std::vector<std::array<VertexId, 2>> edges;
    edges.reserve(curve_edges_.size());
    for (const CurveEdge& edge : curve_edges_) {
      edges.push_back({edge.a, edge.b});
      if (edge.data.required) held[edge.a] = held[edge.b] = 1;
    }
    places_ = levelled_places<Dim>(
        executor_, mesh_, {facets_, wide_normals_, edges, held, hausdorff_tolerance_, least_turn_});
  }

  const Vector<Dim>& place(VertexId v) const {
    return places_.empty() ? mesh_.site_of[v].position : places_[v];
  }
  bool is_levelled(VertexId v) const {
    return !places_.empty() && places_[v] != mesh_.site_of[v].position;
  }
  bool is_levelled(const auto& edge) const { return is_levelled(edge.a) || is_levelled(edge.b); }

  // ---- Curves: edges where patches meet or that the file lists, chained where straight ----

  struct CurveEdge {
    VertexId a, b;
    Curve data;
    std::vector<PatchId> patches;  // sorted
    CurveId curve = 0;
    bool bends = false;          ///< more than rounding makes it
    std::uint32_t sheet = none;  ///< the curve of the reference that it stands for
    bool agrees_with(const CurveEdge& o) const {
      return std::tie(data.reference, data.listed, data.required, data.ridge, patches, sheet) ==
             std::tie(o.data.reference, o.data.listed, o.data.required, o.data.ridge, o.patches,
                      o.sheet);
    }
  };

  std::vector<PatchId> patches_at(SideKey key) const {
    std::vector<PatchId> patches;
    for (const FacetSide& side : sides_.at(key)) patches.push_back(facets_[side.facet].patch);
    std::sort(patches.begin(), patches.end());
    return patches;
  }

  void find_curve_edges() {
    auto keys = runtime::parallel_collect<SideKey>(
        executor_, sides_.size(), [&](std::size_t i, auto&& append) {
          if (!sides_.begins_run(i)) return;
          const auto both = sides_.run_at(i);
          if (both.size() != 2 || facets_[both[0].facet].patch != facets_[both[1].facet].patch ||
              is_sharp(both))
            append(both[0].key);
        });
    for (const auto& [key, edge] : listed_) keys.push_back(key);
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const SideKey key : keys) add_curve_edge(key);
  }

  void grow_curves() {
    mesh_.curves.assign(1, {});
    for (std::uint32_t e = 0; e < curve_edges_.size(); ++e)
      if (curve_edges_[e].curve == 0) grow_curve(e);
    for (const CurveEdge& e : curve_edges_) {
      mesh_.links_of.insert(e.a, {e.b, e.curve});
      mesh_.links_of.insert(e.b, {e.a, e.curve});
    }
  }

  void add_curve_edge(SideKey key) {
    CurveEdge edge{
        static_cast<VertexId>(key >> 32U), static_cast<VertexId>(key), {}, patches_at(key)};
    if (const auto found = listed_.find(key); found != listed_.end()) {
      const ListedEdge& listed = found->second;
      edge.data = {{}, listed.reference, true, listed.required, listed.ridge};
    }
    if constexpr (Dim == 3)
      if (reference_ != nullptr)
        edge.sheet = reference_->sheet_of_edge(
            {mesh_.site_of[edge.a].position, mesh_.site_of[edge.b].position}, edge.data.reference);
    for (const VertexId v : {edge.a, edge.b})
      edges_at_[v].push_back(static_cast<std::uint32_t>(curve_edges_.size()));
    curve_edges_.push_back(std::move(edge));
  }

  void grow_curve(std::uint32_t seed) {
    const auto id = static_cast<CurveId>(mesh_.curves.size());
    Curve curve = curve_edges_[seed].data;
    curve.smooth = is_levelled(curve_edges_[seed]);
    const auto [origin, direction, tolerance] = line_along(seed);
    curve_edges_[seed].curve = id;
    for (const VertexId start : {curve_edges_[seed].a, curve_edges_[seed].b}) {
      const Vector<Dim> towards = (start == curve_edges_[seed].a ? -1.0 : 1.0) * direction;
      Vector<Dim> heading = towards;
      VertexId v = start;
      for (std::uint32_t e = next_edge(seed, v); e != none; e = next_edge(e, v)) {
        CurveEdge& edge = curve_edges_[e];
        const VertexId end = edge.a == v ? edge.b : edge.a;
        const Vector<Dim> d = place(end) - origin, step = place(end) - place(v);
        const bool straight =
            !is_levelled(edge) && norm(d - dot(d, direction) * direction) <= tolerance;
        const double along = dot(step, heading);
        if (edge.curve != 0 || !edge.agrees_with(curve_edges_[seed])) break;
        if (edge.sheet != none && !edge.data.required) {
          curve.smooth = true;
        } else if (reference_ == nullptr && hausdorff_tolerance_ > 0 && !edge.data.required) {
          // By no more than 60 degrees in all, so that a closed curve keeps three ends.
          if (!(along > least_turn_ * norm(step)) || !(dot(step, towards) > 0.5 * norm(step)))
            break;
          curve.smooth = curve.smooth || !straight;
          heading = (1 / norm(step)) * step;
        } else if (!straight || along <= 0) {
          break;
        }
        edge.curve = id;
        v = end;
      }
    }
    if constexpr (Dim == 3) curve.direction = direction;
    if (curve_edges_[seed].sheet != none && !curve.required) curve.smooth = true;
    curve.sheet = reference_ == nullptr ? id : curve_edges_[seed].sheet;
    mesh_.curves.push_back(curve);
  }

  /// What a curve has to be close to if it is to be straight.
  struct Line {
    Vector<Dim> origin, direction;
    double tolerance;
  };

  /// Through an edge, or near what continues it, if only rounding makes that bend.
  Line line_along(std::uint32_t seed) {
    const CurveEdge& edge = curve_edges_[seed];
    Vector<Dim> direction = place(edge.b) - place(edge.a);
    direction *= 1 / norm(direction);
    if constexpr (Dim == 3) {
      if (auto line = is_levelled(edge) ? std::nullopt : rough_line(seed)) {
        if (dot(line->direction, direction) < 0) line->direction *= -1;
        rounding_->line_of.resize(mesh_.curves.size() + 1);
        rounding_->line_of.back() = line;
        return {line->origin, line->direction, rounding()};
      }
    }
    return {place(edge.a), direction, tolerance_};
  }

  /// The line near a chain of edges that would lie on it without rounding.
  std::optional<Flat<Dim>> rough_line(std::uint32_t seed) {
    if (curve_edges_[seed].bends) return {};
    std::vector<std::uint32_t> chain{seed};
    std::vector<Vector<Dim>> points;
    bool bends = false;
    for (const VertexId start : {curve_edges_[seed].a, curve_edges_[seed].b}) {
      VertexId v = start, before = curve_edges_[seed].a + curve_edges_[seed].b - start;
      points.push_back(mesh_.site_of[v].position);
      for (std::uint32_t e = next_edge(seed, v); e != none && e != seed; e = next_edge(e, v)) {
        const CurveEdge& edge = curve_edges_[e];
        const VertexId end = edge.a == v ? edge.b : edge.a;
        if (edge.curve != 0 || !edge.agrees_with(curve_edges_[seed])) break;
        const Turn turn = turn_at(before, v, end);
        if (turn == Turn::much) break;
        bends = bends || turn == Turn::little;
        chain.push_back(e);
        points.push_back(mesh_.site_of[end].position);
        before = std::exchange(v, end);
      }
    }
    if (!bends) return {};
    const auto line = line_near(points, rounding());
    if (!line)
      for (const std::uint32_t e : chain) curve_edges_[e].bends = true;
    return line;
  }

  /// Whether a curve turns at a vertex by more than rounding explains, or, if not, at all.
  enum class Turn { none, little, much };
  Turn turn_at(VertexId before, VertexId v, VertexId after) {
    const auto at = [&](VertexId w) { return mesh_.site_of[w].position; };
    const Vector<Dim> u = at(v) - at(before), w = at(after) - at(v);
    if (!(dot(u, w) > 0) || !turns_by_rounding(u, w)) return Turn::much;
    if (norm(w - dot(w, u) / dot(u, u) * u) <= tolerance_) return Turn::none;
    if (!(rounding() > 0)) return Turn::much;
    return explains_line(at(before), at(v), at(after), rounding()) &&
                   explains_line(at(after), at(v), at(before), rounding())
               ? Turn::little
               : Turn::much;
  }

  /// The other curve edge at a vertex where exactly two meet and nothing stops the curve.
  std::uint32_t next_edge(std::uint32_t edge, VertexId v) const {
    const auto& edges = edges_at_.at(v);
    if (edges.size() != 2 || mesh_.kind_of[v].corner || mesh_.kind_of[v].required) return none;
    return edges[0] == edge ? edges[1] : edges[0];
  }

  // ---- Vertices ----

  void classify_vertices() {
    const auto corners = corners_with_patches();  // vertex, then patch
    const auto vertex_at = [&](std::size_t i) { return static_cast<VertexId>(corners[i] >> 32U); };
    std::vector<std::uint32_t> first_of(mesh_.vertex_slots(), none);  // [vertex], among corners
    runtime::parallel_for(executor_, corners.size(), [&](std::size_t i) {
      if (i == 0 || vertex_at(i - 1) != vertex_at(i))
        first_of[vertex_at(i)] = static_cast<std::uint32_t>(i);
    });
    runtime::parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t v) {
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

  /// The corners of all facets, each with its facet's patch, sorted.
  runtime::UnsetVector<std::uint64_t> corners_with_patches() const {
    auto corners = runtime::make_unset_vector<std::uint64_t>(executor_, Dim * facets_.size());
    runtime::parallel_for(executor_, facets_.size(), [&](std::size_t f) {
      for (std::size_t i = 0; i < Dim; ++i)
        corners[Dim * f + i] = std::uint64_t{facets_[f].corners[i]} << 32U | facets_[f].patch;
    });
    runtime::parallel_sort(executor_, std::span(corners));
    return corners;
  }

  void classify_vertex(VertexId v, const std::vector<PatchId>& patches, std::size_t facet_count) {
    VertexKind& kind = mesh_.kind_of[v];
    kind.class_dimension = 0;
    mesh_.entity_of[v] = 0;
    if (kind.corner || kind.required || touches_required(v, patches)) return;
    std::uint32_t links = 0;
    if constexpr (Dim == 3) links = static_cast<std::uint32_t>(mesh_.links_of.of(v).size());
    if (patches.empty() && links == 0) {
      kind.class_dimension = Dim;
    } else if (patches.size() == 1 && links == 0 &&
               (Dim == 3 ? is_met_once(v, facet_count)
                         : facet_count == 2 && !is_sharp(sides_.at(v)))) {
      kind.class_dimension = Dim - 1;
      mesh_.entity_of[v] = patches[0];
    } else if constexpr (Dim == 3) {
      if (!on_one_curve(v, patches) || !is_met_once(v, facet_count)) return;
      kind.class_dimension = 1;
      mesh_.entity_of[v] = mesh_.links_of.of(v)[0].curve;
    }
  }

  bool on_one_curve(VertexId v, const std::vector<PatchId>& patches) const {
    const auto links = mesh_.links_of.of(v);
    if (links.size() != 2 || links[0].curve != links[1].curve) return false;
    auto along = patches_at(edge_key(v, links[0].to));
    along.erase(std::unique(along.begin(), along.end()), along.end());
    return along == patches;
  }

  /// Are all facets around a vertex connected there, by facets or along its curve? What bends may
  /// touch itself at a vertex; what is flat has another patch there.
  bool is_met_once(VertexId v, std::size_t facet_count) const {
    if (hausdorff_tolerance_ == 0 || facet_count == 0) return true;
    if constexpr (Dim == 3) {
      const auto links = mesh_.links_of.of(v);
      if (!links.empty()) {
        std::size_t count = 0;
        for (const FacetSide& side : sides_.at(edge_key(v, links[0].to)))
          count += facets_around(mesh_, facets_, sides_, v, side);
        return count == facet_count;
      }
      for (const ElementId e : mesh_.elements_of.of(v))
        for (std::size_t i = 0; i < 4; ++i) {
          if (mesh_.patches_of[e][i] == 0 || mesh_.corners_of[e][i] == v) continue;
          const Facet<3> facet = facet_of<3>(mesh_.corners_of[e], static_cast<int>(i));
          const VertexId other = facet[0] == v ? facet[1] : facet[0];
          return facets_around(mesh_, facets_, sides_, v, sides_.at(edge_key(v, other))[0]) ==
                 facet_count;
        }
    }
    return true;
  }

  bool touches_required(VertexId v, const std::vector<PatchId>& patches) const {
    for (const PatchId p : patches)
      if (mesh_.patches[p].required) return true;
    if constexpr (Dim == 3)
      for (const CurveLink& link : mesh_.links_of.of(v))
        if (mesh_.curves[link.curve].required) return true;
    for (const ElementId e : mesh_.elements_of.of(v))
      if (mesh_.required_element(e)) return true;
    return false;
  }

  const runtime::Executor& executor_;
  Mesh<Dim>& mesh_;
  std::vector<TaggedFacet<Dim>> facets_;
  double extent_;                            // of the mesh
  double tolerance_;                         // of flatness
  std::shared_ptr<Rounding<Dim>> rounding_;  // null until it is known, see rounding()
  const MakeMeshOptions& options_;
  double hausdorff_tolerance_;  // of what is not flat; 0 if nothing is to be smooth
  double least_turn_;           // cosine of the angle from which on edges are ridges
  FacetSides<Dim> sides_;
  const ReferenceSurface<Dim>* reference_ = nullptr;  // null where the mesh is its own
  std::vector<std::uint32_t> sheet_of_;               // [facet], of the reference
  using Others = std::array<std::uint32_t, Dim>;
  runtime::UnsetVector<Others> across_;             // [facet][side], the other facet or none
  runtime::UnsetVector<Others> beside_;             // the same, though it may fold back
  std::vector<Vector<Dim>> wide_normals_;           // [facet], 0 if its own; empty if all are
  std::vector<Vector<Dim>> places_;                 // [vertex], see levelled_places()
  std::unordered_map<SideKey, ListedEdge> listed_;  // 3D
  std::vector<std::uint8_t> kept_;  // [vertex], whether facets there keep their shape
  std::vector<PatchId> plane_of_;   // [facet], its patch before flat ones were joined
  std::vector<CurveEdge> curve_edges_;
  std::unordered_map<VertexId, std::vector<std::uint32_t>> edges_at_;
};

}  // namespace

template <int Dim>
void classify(const runtime::Executor& executor, Mesh<Dim>& mesh,
              std::vector<TaggedFacet<Dim>> facets, const std::vector<ListedEdge>& edges,
              const MakeMeshOptions& options) {
  Classifier<Dim>(executor, mesh, std::move(facets), edges, options).run();
}

template void classify(const runtime::Executor&, Mesh<2>&, std::vector<TaggedFacet<2>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);
template void classify(const runtime::Executor&, Mesh<3>&, std::vector<TaggedFacet<3>>,
                       const std::vector<ListedEdge>&, const MakeMeshOptions&);

}  // namespace ductile::meshadapt
