#include "geometry/boundary_parts.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {
namespace {

CurveEdge edge_at(const BoundaryParts<3>& parts, SideKey key) {
  CurveEdge edge{
      static_cast<VertexId>(key >> 32U), static_cast<VertexId>(key), {}, parts.patches_at(key)};
  if (const auto found = parts.listed.find(key); found != parts.listed.end()) {
    const ListedEdge& listed = found->second;
    edge.data = {{}, listed.reference, true, listed.required, listed.ridge};
  }
  if (parts.reference != nullptr)
    edge.sheet = parts.reference->sheet_of_edge(
        {parts.mesh.site_of[edge.a].position, parts.mesh.site_of[edge.b].position},
        edge.data.reference);
  return edge;
}

class CurveGrower {
 public:
  CurveGrower(BoundaryParts<3>& parts, std::vector<CurveEdge>& edges)
      : parts_(parts), edges_(edges) {
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      for (const VertexId v : {edges[e].a, edges[e].b}) edges_at_[v].push_back(e);
  }

  void run() {
    parts_.mesh.curves.assign(1, {});
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (edges_[e].curve == 0) grow_curve(e);
    for (const CurveEdge& e : edges_) {
      parts_.mesh.links_of.insert(e.a, {e.b, e.curve});
      parts_.mesh.links_of.insert(e.b, {e.a, e.curve});
    }
  }

 private:
  void grow_curve(std::uint32_t seed) {
    const auto id = static_cast<CurveId>(parts_.mesh.curves.size());
    Curve curve = edges_[seed].data;
    curve.smooth = is_denoised(edges_[seed]);
    const auto [origin, direction, tolerance] = line_along(seed);
    edges_[seed].curve = id;
    for (const VertexId start : {edges_[seed].a, edges_[seed].b}) {
      const Vector<3> towards = (start == edges_[seed].a ? -1.0 : 1.0) * direction;
      Vector<3> heading = towards;
      VertexId v = start;
      for (std::uint32_t e = next_edge(seed, v); e != none; e = next_edge(e, v)) {
        CurveEdge& edge = edges_[e];
        const VertexId end = edge.a == v ? edge.b : edge.a;
        const Vector<3> d = parts_.place(end) - origin, step = parts_.place(end) - parts_.place(v);
        const bool straight =
            !is_denoised(edge) && norm(d - dot(d, direction) * direction) <= tolerance;
        const double along = dot(step, heading);
        if (!edge.agrees_with(edges_[seed])) break;
        const bool may_bend =
            parts_.reference == nullptr && parts_.within.surface > 0 && !edge.data.required;
        const bool turns_little = may_bend && along > parts_.within.least_turn * norm(step);
        // Also one that ends here, next to another of the same arc.
        curve.smooth = curve.smooth || (turns_little && !straight);
        if (edge.curve != 0) break;
        if (edge.sheet != none && !edge.data.required) {
          curve.smooth = true;
        } else if (may_bend) {
          // By no more than 60 degrees in all, so that a closed curve keeps three ends.
          if (!turns_little || !(dot(step, towards) > 0.5 * norm(step))) break;
          heading = (1 / norm(step)) * step;
        } else if (!straight || along <= 0) {
          break;
        }
        edge.curve = id;
        v = end;
      }
    }
    curve.direction = direction;
    if (edges_[seed].sheet != none && !curve.required) curve.smooth = true;
    curve.sheet = parts_.reference == nullptr ? id : edges_[seed].sheet;
    parts_.mesh.curves.push_back(curve);
  }

  /// A straight curve stays close to this line.
  struct Line {
    Vector<3> origin, direction;
    double tolerance;
  };

  /// Through an edge, or near what continues it, if only rounding makes that bend.
  Line line_along(std::uint32_t seed) {
    const CurveEdge& edge = edges_[seed];
    Vector<3> direction = parts_.place(edge.b) - parts_.place(edge.a);
    direction *= 1 / norm(direction);
    if (auto line = is_denoised(edge) ? std::nullopt : rough_line(seed)) {
      if (dot(line->direction, direction) < 0) line->direction *= -1;
      parts_.rounding->line_of.resize(parts_.mesh.curves.size() + 1);
      parts_.rounding->line_of.back() = line;
      return {line->origin, line->direction, parts_.rounding_tolerance()};
    }
    return {parts_.place(edge.a), direction, parts_.within.flat};
  }

  /// The line near a chain of edges that would lie on it without rounding.
  std::optional<Flat<3>> rough_line(std::uint32_t seed) {
    if (edges_[seed].bends) return {};
    std::vector<std::uint32_t> chain{seed};
    std::vector<Vector<3>> points;
    bool bends = false;
    for (const VertexId start : {edges_[seed].a, edges_[seed].b}) {
      VertexId v = start, before = edges_[seed].a + edges_[seed].b - start;
      points.push_back(parts_.mesh.site_of[v].position);
      for (std::uint32_t e = next_edge(seed, v); e != none && e != seed; e = next_edge(e, v)) {
        const CurveEdge& edge = edges_[e];
        const VertexId end = edge.a == v ? edge.b : edge.a;
        if (edge.curve != 0 || !edge.agrees_with(edges_[seed])) break;
        const Turn turn = turn_at(before, v, end);
        if (turn == Turn::much) break;
        bends = bends || turn == Turn::little;
        chain.push_back(e);
        points.push_back(parts_.mesh.site_of[end].position);
        before = std::exchange(v, end);
      }
    }
    if (!bends) return {};
    const auto line = line_near(points, parts_.rounding_tolerance());
    if (!line)
      for (const std::uint32_t e : chain) edges_[e].bends = true;
    return line;
  }

  /// The turn of a curve at a vertex: none, little if rounding explains it, or more.
  enum class Turn { none, little, much };
  Turn turn_at(VertexId before, VertexId v, VertexId after) {
    const auto at = [&](VertexId w) { return parts_.mesh.site_of[w].position; };
    const Vector<3> u = at(v) - at(before), w = at(after) - at(v);
    if (!(dot(u, w) > 0) || !turns_by_rounding(u, w)) return Turn::much;
    if (norm(w - dot(w, u) / dot(u, u) * u) <= parts_.within.flat) return Turn::none;
    if (!(parts_.rounding_tolerance() > 0)) return Turn::much;
    return explains_line(at(before), at(v), at(after), parts_.rounding_tolerance()) &&
                   explains_line(at(after), at(v), at(before), parts_.rounding_tolerance())
               ? Turn::little
               : Turn::much;
  }

  /// The other curve edge at a vertex where exactly two meet and nothing stops the curve.
  std::uint32_t next_edge(std::uint32_t edge, VertexId v) const {
    const auto& edges = edges_at_.at(v);
    if (edges.size() != 2 || parts_.mesh.kind_of[v].corner || parts_.mesh.kind_of[v].required)
      return none;
    return edges[0] == edge ? edges[1] : edges[0];
  }

  bool is_denoised(const CurveEdge& edge) const {
    return parts_.is_denoised(edge.a) || parts_.is_denoised(edge.b);
  }

  BoundaryParts<3>& parts_;
  std::vector<CurveEdge>& edges_;
  std::unordered_map<VertexId, std::vector<std::uint32_t>> edges_at_;
};

}  // namespace

std::vector<CurveEdge> find_curve_edges(const BoundaryParts<3>& parts) {
  auto keys = runtime::parallel_collect<SideKey>(
      parts.executor, parts.sides.size(), [&](std::size_t i, auto&& append) {
        if (!parts.sides.begins_run(i)) return;
        if (const auto run = parts.sides.run_at(i); parts.ends_patch(run)) append(run[0].key);
      });
  for (const auto& [key, edge] : parts.listed) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<CurveEdge> edges;
  edges.reserve(keys.size());
  for (const SideKey key : keys) edges.push_back(edge_at(parts, key));
  return edges;
}

void classify_curves(BoundaryParts<3>& parts, std::vector<CurveEdge>& edges) {
  CurveGrower(parts, edges).run();
}

}  // namespace ductile::meshadapt
