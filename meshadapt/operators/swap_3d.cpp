#include <algorithm>
#include <limits>
#include <span>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/worklist.hpp"
#include "operators/base.hpp"
#include "operators/boundary_shape.hpp"
#include "operators/cut_off.hpp"
#include "operators/ring.hpp"
#include "operators/star.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

namespace {

constexpr std::size_t largest_ring = 7;

/// May this edge go? Not if it is on a curve, on an interface or between different regions; on a
/// boundary patch it may, if the patch is flat and free. Returns false or sets `patch`.
bool removable(const Mesh<3>& mesh, const Shell& shell, VertexId a, VertexId b, PatchId& patch) {
  if (mesh.curve_of(a, b) != 0) return false;
  patch = 0;
  int tagged = 0;
  for (const ElementId e : shell) {
    if (mesh.region_of[e] != mesh.region_of[shell[0]] || mesh.required_element(e)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = mesh.corners_of[e][i];
      const PatchId p = mesh.patches_of[e][i];
      if (v == a || v == b || p == 0) continue;
      if (mesh.patches[p].required || (patch != 0 && p != patch)) return false;
      patch = p;
      ++tagged;
    }
  }
  return tagged == 0 || tagged == 2;
}

/// The triangulation of a ring whose worst element, with both ends of the edge, is best: dynamic
/// programming over sub-polygons (Shewchuk, "Two discrete optimization algorithms for the
/// topological improvement of tetrahedral meshes", 2002).
class RingTriangulation {
 public:
  RingTriangulation(const Mesh<3>& mesh, const Ring& ring, VertexId a, VertexId b, double bar)
      : ring_(ring),
        a_(a),
        b_(b),
        site_a_(&mesh.site_of[a]),
        site_b_(&mesh.site_of[b]),
        bar_(bar > 0 ? bar * bar : 0) {
    for (std::size_t i = 0; i < ring.vertices.size(); ++i)
      site_[i] = &mesh.site_of[ring.vertices[i]];
  }

  /// Fills the plan's new elements; false if no triangulation beats the bar.
  bool find(Replacement<3>& plan) {
    const std::size_t n = ring_.vertices.size();
    for (std::size_t length = 2; length < n; ++length)
      for (std::size_t i = 0; i + length < n; ++i) best_between(i, i + length);
    if (!(worst_[0][n - 1] > bar_)) return false;
    collect(0, n - 1, plan);
    return true;
  }

 private:
  void best_between(std::size_t i, std::size_t j) {
    double best = -1;
    for (std::size_t k = i + 1; k < j; ++k) {
      const double sides = std::min(j - k > 1 ? worst_[k][j] : 1.0, k - i > 1 ? worst_[i][k] : 1.0);
      if (!(sides > std::max(best, bar_))) continue;
      const double here = std::min(sides, triangle(i, k, j));
      if (here > best) {
        best = here;
        apex_[i][j] = static_cast<std::uint8_t>(k);
      }
    }
    worst_[i][j] = best;
  }

  /// The squared quality of the worse of a ring triangle's two elements.
  double triangle(std::size_t i, std::size_t k, std::size_t j) const {
    const Base base = make_base({site_[i], site_[j], site_[k]});
    return std::min(squared_quality_over(base, *site_b_, 1),
                    squared_quality_over(base, *site_a_, -1));
  }

  void collect(std::size_t i, std::size_t j, Replacement<3>& plan) const {
    if (j - i < 2) return;
    const std::size_t k = apex_[i][j];
    const VertexId p = ring_.vertices[i], q = ring_.vertices[k], r = ring_.vertices[j];
    plan.new_elements.push_back({p, q, r, b_});
    plan.new_elements.push_back({p, r, q, a_});
    collect(i, k, plan);
    collect(k, j, plan);
  }

  const Ring& ring_;
  VertexId a_, b_;
  std::array<const Site<3>*, largest_ring> site_{};
  const Site<3>* site_a_;
  const Site<3>* site_b_;
  double bar_;                                                          // as worst_, squared
  std::array<std::array<double, largest_ring>, largest_ring> worst_{};  // quality, squared
  std::array<std::array<std::uint8_t, largest_ring>, largest_ring> apex_{};
};

/// An edge's removal by the best triangulation of its ring, if its worst element beats the bar and
/// the ring is not too large.
std::optional<Replacement<3>> triangulate(const Mesh<3>& mesh, const Swappable& edge,
                                          const Ring& ring, double bar) {
  if (ring.vertices.size() > largest_ring) return {};
  std::optional<Replacement<3>> result(std::in_place);
  if (!RingTriangulation(mesh, ring, edge.a, edge.b, bar).find(*result)) return {};
  return result;
}

/// May this be an edge of a patch? Not if it is there already, on the other side of a boundary that
/// touches itself, nor if both sides of a closed crack could get it at the same time.
bool stays_apart(const Mesh<3>& mesh, VertexId a, VertexId b, PatchId patch) {
  if (mesh.patches[patch].crack_side && mesh.kind_of[a].class_dimension < 2 &&
      mesh.kind_of[b].class_dimension < 2)
    return false;
  bool found = false;
  visit_shell(mesh, a, b, [&](ElementId) { found = true; });
  return !found;
}

/// May the edge give way to the elements found? If so, adds what goes with them.
bool accept_edge_removal(const Mesh<3>& mesh, const Swappable& edge, const Shell& shell,
                         const Ring& ring, Replacement<3>& result) {
  PatchId patch = 0;
  if (!removable(mesh, shell, edge.a, edge.b, patch)) return false;
  // A patch on a closed ring is an interface or a sheet inside a region: its edges stay.
  if (ring.open != (patch != 0)) return false;
  for (const Corners<3>& corners : result.new_elements)
    if (!(mesh.quality_at(corners) > 0)) return false;
  result.old_elements.assign(shell.begin(), shell.end());
  if (ring.open) {
    const VertexId first = ring.vertices.front(), last = ring.vertices.back();
    if (!convex_in_patch(mesh, {edge.a, first, edge.b, last}, patch)) return false;
    if (!stays_apart(mesh, first, last, patch)) return false;
    result.new_facets = {{edge.a, first, last}, {edge.b, first, last}};
    result.new_patch = patch;
  }
  return true;
}

/// The face a-b-c gives way to the edge from p to q, where (a, b, p, c) and (a, b, c, q) are the
/// elements on its two sides; empty if one of the new elements is not above the bar.
std::array<Corners<3>, 3> elements_around(const Swappable& face, VertexId p, VertexId q) {
  return {{{p, q, face.a, face.b}, {p, q, face.b, face.c}, {p, q, face.c, face.a}}};
}

bool worth_piercing(const Mesh<3>& mesh, const Swappable& face, VertexId p, VertexId q,
                    double bar) {
  const auto elements = elements_around(face, p, q);
  return std::all_of(elements.begin(), elements.end(), [&](const Corners<3>& corners) {
    return quality_above<3>(mesh.sites(corners), bar);
  });
}

std::optional<Replacement<3>> plan_face_swap(const Mesh<3>& mesh, const Swappable& face,
                                             const Shell& shell, double bar,
                                             const EdgeRange& range) {
  ElementId e = shell[0], f = shell[1];
  auto [p, c] = others(mesh.corners_of[e], face.a, face.b);
  if (c != face.c) {
    std::swap(e, f);
    p = others(mesh.corners_of[e], face.a, face.b)[0];
  }
  const VertexId q = others(mesh.corners_of[f], face.a, face.b)[1];
  const auto at_p = static_cast<std::size_t>(corner_of(mesh.corners_of[e], p));
  if (mesh.region_of[e] != mesh.region_of[f] || mesh.required_element(e) ||
      mesh.patches_of[e][at_p] != 0 || !worth_piercing(mesh, face, p, q, bar))
    return {};
  Replacement<3> result;
  for (const Corners<3>& corners : elements_around(face, p, q))
    result.new_elements.push_back(corners);
  result.old_elements = {e, f};
  if (!keeps_lengths(mesh, result, {p, p}, range)) return {};
  return result;
}

}  // namespace

template <>
bool Swap<3>::decide(const Swappable& item, const Shell& shell, Plan& plan) const {
  const auto take = [&](const std::optional<Replacement<3>>& found) {
    if (found) plan = *found;
    return found.has_value();
  };
  float worst = 1;
  for (const ElementId e : shell) worst = std::min(worst, mesh_.quality_of[e]);
  if (item.c != none)
    return shell.size() == 2 && take(plan_face_swap(mesh_, item, shell, bar(worst), range_));
  Ring ring;
  if (!ring.close(shell.size(), item.a, item.b,
                  [&](std::size_t i) { return mesh_.corners_of[shell[i]]; }))
    return false;
  auto result = triangulate(mesh_, item, ring, bar(worst));
  if (result && accept_edge_removal(mesh_, item, shell, ring, *result) &&
      keeps_lengths(mesh_, *result, {item.a, item.b}, range_))
    return take(result);
  return mesh_.surface && take(plan_cut_off(mesh_, item.a, item.b, shell, ring));
}

namespace {

/// Lengths at a poor element are compared with these. Edges that are short for the worst element
/// around them are hardly ever worth removing, and faces are hardly ever worth piercing by an edge
/// that is long for the worse element (docs/notebook/tried-in-adaptation.md).
struct Gauge {
  Metric<3> metric;        // that the element is judged by
  double mean_square = 0;  // of its edges, in that metric

  Gauge() = default;
  Gauge(const Mesh<3>& mesh, const Corners<3>& corners) {
    const auto corner = mesh.sites(corners);
    metric = mean_metric<3>(corner).metric;
    mean_square = sum_of_squared_lengths<3>(metric, corner) / 6;
  }
  double relative_square(const Vector<3>& edge) const {
    return squared_length(metric, edge) / mean_square;
  }
};

/// Looks for edges from one vertex whose removal is worth it, or an element's next to them.
class EdgeSearch {
 public:
  EdgeSearch(const Mesh<3>& mesh, VertexId vertex, std::uint32_t after, float good_enough,
             const EdgeRange& range)
      : mesh_(mesh),
        vertex_(vertex),
        range_(range),
        good_enough_(good_enough),
        ball_(mesh.elements_of.of(vertex)),
        star_(mesh, vertex, after) {
    gauge_of_.resize(ball_.size());
  }

  void run(auto&& append) {
    for (std::size_t i = 0; i < star_.size(); ++i)
      if ((worth_a_look(star_.edge(i)) && worth_removing(i)) || worth_cutting_off(star_.edge(i)))
        append(Swappable{vertex_, star_.edge(i).to, none, star_.edge(i).worst_quality});
  }

 private:
  static constexpr double longest = 3;  ///< of an element's edges, by Gauge::relative_square()

  /// The square of the length, as Gauge has it, above which an edge may be worth removing. The more
  /// elements are around it, and the better the worst of them is, the longer it is; elements at the
  /// boundary count twice, as if mirrored there. Fitted to what was found
  /// (docs/notebook/tried-in-adaptation.md).
  static double long_edge(const Star::Edge& edge) {
    constexpr double never = std::numeric_limits<double>::infinity();
    constexpr std::array slope = {never, never, never, 1.0, 2.2, 3.2, 4.6, 9.0, 9.0};
    static_assert(slope.size() == Star::most_around + 1);
    const std::size_t around = edge.count * (edge.ends == 0 ? 1U : 2U);
    if (around >= slope.size()) return never;
    const double quality = std::max(0.0F, edge.worst_quality);
    return 0.4 + slope[around] * (quality * quality);
  }

  bool worth_a_look(const Star::Edge& edge) {
    if (!edge.changed || !(edge.worst_quality < good_enough_)) return false;
    const double limit = long_edge(edge);
    if (limit > longest) return false;
    Gauge& gauge = gauge_of_[edge.worst];
    if (gauge.mean_square == 0) gauge = Gauge(mesh_, mesh_.corners_of[ball_[edge.worst]]);
    const Vector<3> along = mesh_.site_of[edge.to].position - mesh_.site_of[vertex_].position;
    return gauge.relative_square(along) > limit;
  }

  /// Is it worth cutting off the worst element around the edge?
  bool worth_cutting_off(const Star::Edge& edge) const {
    return mesh_.surface && edge.changed && edge.ends == 0 &&
           patch_above(mesh_, ball_[edge.worst], vertex_, edge.to) != 0;
  }

  bool worth_removing(std::size_t i) const {
    const Star::Edge& edge = star_.edge(i);
    const auto element = [&](std::size_t k) { return ball_[star_.around(i)[k]]; };
    const auto corners = [&](std::size_t k) { return mesh_.corners_of[element(k)]; };
    Ring ring;
    if (!ring.close(edge.count, vertex_, edge.to, corners)) return false;
    const double bar = Swap<3>::bar(edge.worst_quality);
    auto result = triangulate(mesh_, {vertex_, edge.to}, ring, bar);
    if (!result) return false;
    Shell shell;
    for (std::size_t k = 0; k < edge.count; ++k) shell.push_back(element(k));
    return accept_edge_removal(mesh_, {vertex_, edge.to}, shell, ring, *result) &&
           keeps_lengths(mesh_, *result, {vertex_, edge.to}, range_);
  }

  const Mesh<3>& mesh_;
  VertexId vertex_;
  EdgeRange range_;
  float good_enough_;
  std::span<const ElementId> ball_;
  Star star_;
  Buffer<Gauge, 64> gauge_of_;  // [place in ball_], made when first needed
};

/// Has the lists and elements of vertices soon after one brought into the cache, not the sites:
/// where those are there already, to ask for so many takes longer than it spares elsewhere.
[[gnu::always_inline]] inline void prefetch_stars_after(
    const Mesh<3>& mesh, const runtime::UnsetVector<std::uint8_t>& wanted, std::size_t vertex) {
  constexpr std::size_t step = 3;
  if (vertex + 2 * step < wanted.size() && wanted[vertex + 2 * step] != 0)
    mesh.elements_of.prefetch(static_cast<VertexId>(vertex + 2 * step));
  if (vertex + step < wanted.size() && wanted[vertex + step] != 0)
    for (const ElementId e : mesh.elements_of.of(static_cast<VertexId>(vertex + step))) {
      __builtin_prefetch(&mesh.corners_of[e]);
      __builtin_prefetch(&mesh.quality_of[e]);
      __builtin_prefetch(&mesh.changed_at[e]);
    }
}

/// The facet whose opposite corner is the lowest over it: the largest, by Heron's formula in
/// squared lengths.
int lowest_corner(const Mesh<3>& mesh, const Corners<3>& corners, const Metric<3>& metric) {
  const auto corner = mesh.sites(corners);
  const auto square = [&](std::size_t i, std::size_t j) {
    return squared_length(metric, corner[j]->position - corner[i]->position);
  };
  const auto area = [](double a, double b, double c) {
    return 2 * (a * b + b * c + c * a) - (a * a + b * b + c * c);
  };
  const double a = square(0, 1), b = square(0, 2), c = square(0, 3), d = square(1, 2),
               e = square(1, 3), f = square(2, 3);
  const std::array areas = {area(d, e, f), area(b, c, f), area(a, c, e), area(a, b, d)};
  return static_cast<int>(std::max_element(areas.begin(), areas.end()) - areas.begin());
}

/// Is the largest facet of a poor element worth piercing? Found from the worse of its two elements.
std::optional<Swappable> face_to_pierce(const Mesh<3>& mesh, ElementId element, std::uint32_t after,
                                        const EdgeRange& range) {
  constexpr double short_edge = 1.4;
  const Corners<3>& corners = mesh.corners_of[element];
  const Gauge gauge(mesh, corners);
  const int apex = lowest_corner(mesh, corners, gauge.metric);
  const ElementId other = neighbour(mesh, element, apex);
  const float worst = mesh.quality_of[element];
  if (other == none || (mesh.changed_at[element] <= after && mesh.changed_at[other] <= after) ||
      std::pair(mesh.quality_of[other], other) < std::pair(worst, element))
    return {};
  Facet<3> face = facet_of<3>(corners, apex);
  std::sort(face.begin(), face.end());
  const auto beyond = std::find_if(mesh.corners_of[other].begin(), mesh.corners_of[other].end(),
                                   [&](VertexId v) { return !contains(face, v); });
  const VertexId p = corners[static_cast<std::size_t>(apex)];
  if (gauge.relative_square(mesh.site_of[*beyond].position - mesh.site_of[p].position) > short_edge)
    return {};
  const Swappable item{face[0], face[1], face[2], worst};
  const Shell shell{std::min(element, other), std::max(element, other)};
  if (!plan_face_swap(mesh, item, shell, Swap<3>::bar(worst), range)) return {};
  return item;
}

}  // namespace

template <>
runtime::UnsetVector<Swappable> Swap<3>::improvements(const runtime::Executor& executor,
                                                      Mesh<3>& mesh, std::uint32_t after,
                                                      double below, const EdgeRange& range) {
  const auto good_enough = static_cast<float>(quality_of_mean_ratio<3>(below));
  const auto poor = [&](ElementId e) { return mesh.quality_of[e] < good_enough; };
  const double flat = std::min<double>(good_enough, quality_of_mean_ratio<3>(0.5));
  const auto near_change = mark_changed(executor, mesh, after);
  const auto find_edges = [&](std::size_t v, auto&& append) {
    prefetch_stars_after(mesh, near_change, v);
    if (!near_change[v]) return;
    const auto vertex = static_cast<VertexId>(v);
    const auto ball = mesh.elements_of.of(vertex);
    if (std::any_of(ball.begin(), ball.end(), poor))
      EdgeSearch(mesh, vertex, after, good_enough, range).run(append);
  };
  const auto find_faces = [&](std::size_t e, auto&& append) {
    const auto element = static_cast<ElementId>(e);
    if (!(mesh.quality_of[e] < flat) || !mesh.alive(element)) return;
    const auto is_near = [&](VertexId v) { return near_change[v] != 0; };
    const Corners<3>& corners = mesh.corners_of[e];
    if (std::count_if(corners.begin(), corners.end(), is_near) < 3) return;
    if (const auto face = face_to_pierce(mesh, element, after, range)) append(*face);
  };
  const std::size_t vertices = mesh.vertex_slots();
  const auto find = [&](std::size_t i, auto&& append) {
    if (i < vertices) {
      find_edges(i, append);
    } else {
      find_faces(i - vertices, append);
    }
  };
  return runtime::parallel_collect<Swappable>(executor, vertices + mesh.element_slots(), find);
}

template class Swap<3>;

}  // namespace ductile::meshadapt
