#include <algorithm>

#include "ductile/runtime/collect.hpp"
#include "operators/base.hpp"
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
      : ring_(ring), a_(a), b_(b), site_a_(&mesh.site_of[a]), site_b_(&mesh.site_of[b]), bar_(bar) {
    for (std::size_t i = 0; i < ring.vertices.size(); ++i)
      site_[i] = &mesh.site_of[ring.vertices[i]];
  }

  /// Fills `elements`; false if no triangulation beats the bar.
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
      const double here = std::min(sides, triangle(i, k, j, std::max(best, bar_)));
      if (here > best) {
        best = here;
        apex_[i][j] = static_cast<std::uint8_t>(k);
      }
    }
    worst_[i][j] = best;
  }

  /// The worse of a ring triangle's two elements; the second is not looked at if the first is bad.
  double triangle(std::size_t i, std::size_t k, std::size_t j, double bar) const {
    Base<3> base = make_base<3>({site_[i], site_[j], site_[k]});
    if (!(volume_over(base, site_b_->position) > 0 && volume_over(base, site_a_->position) < 0))
      return -1;
    weigh(base);
    const double up = shape_over(base, *site_b_);
    return up > bar ? std::min(up, shape_over(base, *site_a_, true)) : -1;
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
  double bar_;
  std::array<std::array<double, largest_ring>, largest_ring> worst_{};
  std::array<std::array<std::uint8_t, largest_ring>, largest_ring> apex_{};
};

/// Does the quadrilateral of two facets on a patch remain unfolded when its diagonal is swapped?
bool convex_in_patch(const Mesh<3>& mesh, const std::array<VertexId, 4>& corners, PatchId patch) {
  const auto at = [&](std::size_t i) { return mesh.site_of[corners[i]].position; };
  const Vector<3>& normal = mesh.patches[patch].normal;
  return dot(facet_normal({at(0), at(1), at(3)}), normal) *
             dot(facet_normal({at(1), at(2), at(3)}), normal) >
         0;
}

/// An edge's removal by the best triangulation of its ring, if its worst element beats the bar.
std::optional<Replacement<3>> triangulate(const Mesh<3>& mesh, const Swappable& edge,
                                          const Ring& ring, double bar) {
  std::optional<Replacement<3>> result(std::in_place);
  if (!RingTriangulation(mesh, ring, edge.a, edge.b, bar).find(*result)) return {};
  return result;
}

std::optional<Replacement<3>> plan_edge_removal(const Mesh<3>& mesh, const Swappable& edge,
                                                const Shell& shell, const Ring& ring, double bar) {
  PatchId patch = 0;
  if (!removable(mesh, shell, edge.a, edge.b, patch)) return {};
  // A patch on a closed ring is an interface or a sheet inside a region: its edges stay.
  if (ring.open != (patch != 0)) return {};
  auto result = triangulate(mesh, edge, ring, bar);
  if (!result) return {};
  for (const Corners<3>& corners : result->new_elements)
    if (!(mesh.shape_at(corners) > 0)) return {};
  result->old_elements.assign(shell.begin(), shell.end());
  if (ring.open) {
    const VertexId first = ring.vertices.front(), last = ring.vertices.back();
    if (!convex_in_patch(mesh, {edge.a, first, edge.b, last}, patch)) return {};
    result->new_facets = {{edge.a, first, last}, {edge.b, first, last}};
    result->new_patch = patch;
  }
  return result;
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
    return shape_above<3>(mesh.sites(corners), bar);
  });
}

std::optional<Replacement<3>> plan_face_swap(const Mesh<3>& mesh, const Swappable& face,
                                             const Shell& shell, double bar) {
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
  return result;
}

}  // namespace

template <>
std::optional<Replacement<3>> Swap<3>::plan(const Swappable& item) const {
  Shell shell;
  float worst = 1;
  footprint(item, [&](ElementId e) {
    shell.push_back(e);
    worst = std::min(worst, mesh_.shape_of[e]);
  });
  if (item.c != none)
    return shell.size() == 2 ? plan_face_swap(mesh_, item, shell, bar(worst)) : std::nullopt;
  Ring ring;
  if (!ring.close(shell.size(), item.a, item.b,
                  [&](std::size_t i) { return mesh_.corners_of[shell[i]]; }) ||
      ring.vertices.size() > largest_ring)
    return {};
  return plan_edge_removal(mesh_, item, shell, ring, bar(worst));
}

template <>
void Swap<3>::apply(const Replacement<3>& plan, runtime::Commit<Swap>& commit) {
  replace(mesh_, plan, commit);
}

namespace {

/// What lengths are compared with at a poor element. Edges that are short for the worst element
/// around them are hardly ever worth removing, and faces are hardly ever worth piercing by an edge
/// that is long for the worse element (docs/performance.md).
struct Gauge {
  const Metric<3>* metric = nullptr;  // that the element is judged by
  double mean_square = 0;             // of its edges, in that metric

  Gauge() = default;
  Gauge(const Mesh<3>& mesh, const Corners<3>& corners) {
    const auto corner = mesh.sites(corners);
    metric = &densest<3>(corner).metric;
    mean_square = sum_of_squared_lengths<3>(*metric, corner) / 6;
  }
  double relative_square(const Vector<3>& edge) const {
    return squared_length(*metric, edge) / mean_square;
  }
};

/// Looks for edges from one vertex whose removal is worth it.
class EdgeSearch {
 public:
  EdgeSearch(const Mesh<3>& mesh, VertexId vertex, std::uint32_t after, float good_enough)
      : mesh_(mesh), vertex_(vertex), good_enough_(good_enough), star_(mesh, vertex, after) {
    gauge_of_.resize(star_.entries.size());
  }

  void run(auto&& append) {
    for (const Star::Edge& edge : star_.edges)
      if (edge.count <= Star::most_around && worth_a_look(edge)) try_edge(edge, append);
  }

 private:
  /// The more elements are around an edge, the longer are those worth removing.
  static double long_edge(std::size_t elements) {
    return elements < 5 ? 0.9 : elements == 5 ? 1.1 : 1.3;
  }

  bool worth_a_look(const Star::Edge& edge) {
    bool changed = false;
    std::size_t worst = edge.around[0];
    for (std::uint32_t i = 0; i < edge.count; ++i) {
      const std::size_t entry = edge.around[i];
      changed = changed || star_.entries[entry].changed;
      if (star_.entries[entry].shape < star_.entries[worst].shape) worst = entry;
    }
    if (!changed || !(star_.entries[worst].shape < good_enough_)) return false;
    Gauge& gauge = gauge_of_[worst];
    if (gauge.metric == nullptr) gauge = Gauge(mesh_, star_.entries[worst].corners);
    const Vector<3> along = mesh_.site_of[edge.to].position - mesh_.site_of[vertex_].position;
    return gauge.relative_square(along) > long_edge(edge.count);
  }

  void try_edge(const Star::Edge& edge, auto&& append) const {
    Ring ring;
    if (!ring.close(edge.count, vertex_, edge.to,
                    [&](std::size_t i) { return star_.entries[edge.around[i]].corners; }) ||
        ring.vertices.size() > largest_ring)
      return;
    Shell shell;
    Swappable item{vertex_, edge.to, none, 1};
    for (std::uint32_t i = 0; i < edge.count; ++i) {
      const Star::Entry& entry = star_.entries[edge.around[i]];
      shell.push_back(entry.element);
      item.worst = std::min(item.worst, entry.shape);
    }
    if (plan_edge_removal(mesh_, item, shell, ring, Swap<3>::bar(item.worst))) append(item);
  }

  const Mesh<3>& mesh_;
  VertexId vertex_;
  float good_enough_;
  Star star_;
  Buffer<Gauge, 64> gauge_of_;  // [entry], made when first needed
};

/// The facet whose opposite corner is the lowest over it: the largest, by Heron's formula in
/// squared lengths.
int lowest_corner(const Mesh<3>& mesh, const Corners<3>& corners, const Metric<3>& metric) {
  const auto corner = mesh.sites(corners);
  std::array<double, 4> area;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector<3>& p = corner[(i + 1) % 4]->position;
    const Vector<3> u = corner[(i + 2) % 4]->position - p, v = corner[(i + 3) % 4]->position - p;
    const double a = squared_length(metric, u), b = squared_length(metric, v),
                 c = squared_length(metric, v - u);
    area[i] = 2 * (a * b + b * c + c * a) - (a * a + b * b + c * c);
  }
  return static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
}

/// Is the largest facet of a poor element worth piercing? Found from the worse of its two elements.
std::optional<Swappable> face_to_pierce(const Mesh<3>& mesh, ElementId element,
                                        std::uint32_t after) {
  constexpr double short_edge = 1.4;
  const Corners<3>& corners = mesh.corners_of[element];
  const Gauge gauge(mesh, corners);
  const int apex = lowest_corner(mesh, corners, *gauge.metric);
  const ElementId other = neighbour(mesh, element, apex);
  const float worst = mesh.shape_of[element];
  if (other == none || (mesh.changed_at[element] <= after && mesh.changed_at[other] <= after) ||
      std::pair(mesh.shape_of[other], other) < std::pair(worst, element))
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
  if (!plan_face_swap(mesh, item, shell, Swap<3>::bar(worst))) return {};
  return item;
}

}  // namespace

template <>
std::vector<Swappable> Swap<3>::improvements(const runtime::Executor& executor, Mesh<3>& mesh,
                                             std::uint32_t after, double below) {
  const auto good_enough = static_cast<float>(shape_of_mean_ratio<3>(below));
  const auto poor = [&](ElementId e) { return mesh.shape_of[e] < good_enough; };
  const double flat = std::min<double>(good_enough, shape_of_mean_ratio<3>(0.5));
  const auto near_change = mark_changed(executor, mesh, after);
  auto found = runtime::parallel_collect<Swappable>(
      executor, mesh.vertex_slots(), [&](std::size_t v, auto&& append) {
        if (!near_change[v]) return;
        const auto vertex = static_cast<VertexId>(v);
        const auto ball = mesh.elements_of.of(vertex);
        if (std::any_of(ball.begin(), ball.end(), poor))
          EdgeSearch(mesh, vertex, after, good_enough).run(append);
      });
  const auto faces = runtime::parallel_collect<Swappable>(
      executor, mesh.element_slots(), [&](std::size_t e, auto&& append) {
        const auto element = static_cast<ElementId>(e);
        if (!(mesh.shape_of[e] < flat) || !mesh.alive(element)) return;
        const auto is_near = [&](VertexId v) { return near_change[v] != 0; };
        const Corners<3>& corners = mesh.corners_of[e];
        if (std::count_if(corners.begin(), corners.end(), is_near) < 3) return;
        if (const auto face = face_to_pierce(mesh, element, after)) append(*face);
      });
  found.insert(found.end(), faces.begin(), faces.end());
  return found;
}

template class Swap<3>;

}  // namespace ductile::meshadapt
