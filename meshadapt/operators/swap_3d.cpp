#include <algorithm>

#include "ductile/runtime/collect.hpp"
#include "operators/star.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

namespace {

constexpr std::size_t largest_ring = 7;

/// The vertices around an edge a-b in order, counter-clockwise seen from b. `open` if the edge is
/// on the boundary; the ring then starts and ends there.
struct Ring {
  boost::container::static_vector<VertexId, largest_ring> vertices;
  bool open = false;
};

/// The two other corners p, q of an element on a-b, such that (a, b, p, q) is positive.
std::array<VertexId, 2> others(const Corners<3>& corners, VertexId a, VertexId b) {
  // Even permutations of the four corners, by the positions of a and b.
  static constexpr int rest[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                        {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                        {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                        {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
  const auto& r = rest[corner_of(corners, a)][corner_of(corners, b)];
  return {corners[static_cast<std::size_t>(r[0])], corners[static_cast<std::size_t>(r[1])]};
}

std::optional<Ring> ring_around(const Mesh<3>& mesh, const Shell& shell, VertexId a, VertexId b) {
  if (shell.size() > largest_ring) return {};
  boost::container::static_vector<std::array<VertexId, 2>, largest_ring> sides;
  for (const ElementId e : shell) sides.push_back(others(mesh.corners_of[e], a, b));
  Ring ring;
  VertexId start = sides[0][0];
  for (const auto& side : sides)
    if (std::none_of(sides.begin(), sides.end(), [&](const auto& s) { return s[1] == side[0]; })) {
      start = side[0];
      ring.open = true;
    }
  if (ring.open && shell.size() + 1 > largest_ring) return {};
  VertexId at = start;
  ring.vertices.push_back(at);
  for (std::size_t step = 0; step < sides.size(); ++step) {
    const auto next =
        std::find_if(sides.begin(), sides.end(), [&](const auto& s) { return s[0] == at; });
    if (next == sides.end()) return {};
    at = (*next)[1];
    if (at != start) ring.vertices.push_back(at);
    if (ring.vertices.size() > sides.size() + 1) return {};
  }
  const std::size_t expected = shell.size() + (ring.open ? 1 : 0);
  if (ring.vertices.size() != expected || expected < 3) return {};
  return ring;
}

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
      : mesh_(mesh), ring_(ring), a_(a), b_(b), bar_(bar) {}

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

  Corners<3> upper(std::size_t i, std::size_t k, std::size_t j) const {
    return {ring_.vertices[i], ring_.vertices[k], ring_.vertices[j], b_};
  }
  Corners<3> lower(std::size_t i, std::size_t k, std::size_t j) const {
    return {ring_.vertices[i], ring_.vertices[j], ring_.vertices[k], a_};
  }

  /// The worse of a ring triangle's two elements; the second is not looked at if the first is bad.
  double triangle(std::size_t i, std::size_t k, std::size_t j, double give_up_below) const {
    const double up = mesh_.shape_at(upper(i, k, j));
    if (!(up > give_up_below)) return -1;
    return std::min(up, mesh_.shape_at(lower(i, k, j)));
  }

  void collect(std::size_t i, std::size_t j, Replacement<3>& plan) const {
    if (j - i < 2) return;
    const std::size_t k = apex_[i][j];
    plan.new_elements.push_back(upper(i, k, j));
    plan.new_elements.push_back(lower(i, k, j));
    collect(i, k, plan);
    collect(k, j, plan);
  }

  const Mesh<3>& mesh_;
  const Ring& ring_;
  VertexId a_, b_;
  double bar_;
  double worst_[largest_ring][largest_ring] = {};
  std::uint8_t apex_[largest_ring][largest_ring] = {};
};

/// Does the quadrilateral of two facets on a patch remain unfolded when its diagonal is swapped?
bool convex_in_patch(const Mesh<3>& mesh, const std::array<VertexId, 4>& corners, PatchId patch) {
  const auto at = [&](std::size_t i) { return mesh.site_of[corners[i]].position; };
  const Vector<3>& normal = mesh.patches[patch].normal;
  return dot(facet_normal({at(0), at(1), at(3)}), normal) *
             dot(facet_normal({at(1), at(2), at(3)}), normal) >
         0;
}

std::optional<Replacement<3>> plan_edge_removal(const Mesh<3>& mesh, VertexId a, VertexId b,
                                                const Shell& shell, double worst_allowed) {
  PatchId patch = 0;
  if (shell.empty() || shell.size() > largest_ring || !removable(mesh, shell, a, b, patch))
    return {};
  const auto ring = ring_around(mesh, shell, a, b);
  // A patch on a closed ring is an interface or a sheet inside a region: its edges stay.
  if (!ring || ring->open != (patch != 0)) return {};
  Replacement<3> result;
  if (!RingTriangulation(mesh, *ring, a, b, worst_allowed).find(result)) return {};
  result.old_elements.assign(shell.begin(), shell.end());
  if (ring->open) {
    const VertexId first = ring->vertices.front(), last = ring->vertices.back();
    if (!convex_in_patch(mesh, {a, first, b, last}, patch)) return {};
    result.new_facets = {{a, first, last}, {b, first, last}};
    result.new_patch = patch;
  }
  return result;
}

/// Elements e and f share a face, which gives way to the edge between their other corners.
std::optional<Replacement<3>> plan_face_swap(const Mesh<3>& mesh, ElementId e, ElementId f,
                                             double worst_allowed) {
  if (mesh.region_of[e] != mesh.region_of[f] || mesh.required_element(e)) return {};
  const auto apex = [&](ElementId element, ElementId other) {
    std::size_t i = 0;
    while (contains(mesh.corners_of[other], mesh.corners_of[element][i])) ++i;
    return i;
  };
  const std::size_t i = apex(e, f);
  if (mesh.patches_of[e][i] != 0) return {};
  const VertexId low = mesh.corners_of[e][i], high = mesh.corners_of[f][apex(f, e)];
  // Counter-clockwise seen from `high`.
  const Facet<3> around = facet_of<3>(mesh.corners_of[e], static_cast<int>(i));
  Replacement<3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corners<3> corners{low, high, around[k], around[(k + 1) % 3]};
    if (!(mesh.shape_at(corners) > worst_allowed)) return {};
    result.new_elements.push_back(corners);
  }
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
  if (item.c == none) return plan_edge_removal(mesh_, item.a, item.b, shell, bar(worst));
  if (shell.size() != 2) return {};
  return plan_face_swap(mesh_, shell[0], shell[1], bar(worst));
}

template <>
void Swap<3>::apply(const Replacement<3>& plan, runtime::Commit<Swap>& commit) {
  replace(mesh_, plan, commit);
}

namespace {

/// Looks for swaps of the edges from one vertex, and of their faces, that are worth it.
class SwapSearch {
 public:
  SwapSearch(const Mesh<3>& mesh, VertexId vertex, const Star& star, float good_enough)
      : mesh_(mesh), vertex_(vertex), star_(star), good_enough_(good_enough) {}

  void try_edge(const Star::Edge& edge, auto&& append) const {
    if (edge.count > largest_ring) return;
    Shell shell;
    float worst = 1;
    bool changed = false;
    for (std::uint32_t k = 0; k < edge.count; ++k) {
      const Star::Entry& entry = star_.entries[edge.around[k]];
      shell.push_back(entry.element);
      worst = std::min(worst, entry.shape);
      changed = changed || entry.changed;
    }
    if (changed && worst < good_enough_ &&
        plan_edge_removal(mesh_, vertex_, edge.to, shell, Swap<3>::bar(worst)))
      append(Swappable{vertex_, edge.to, none, worst});
  }

  /// The faces on an edge whose third corner has a higher number still.
  void try_faces(const Star::Edge& edge, auto&& append) const {
    if (edge.count > Star::most_around) return;
    for (std::uint32_t i = 0; i < edge.count; ++i)
      for (std::uint32_t j = i + 1; j < edge.count; ++j)
        try_face(edge.to, star_.entries[edge.around[i]], star_.entries[edge.around[j]], append);
  }

 private:
  void try_face(VertexId b, const Star::Entry& e, const Star::Entry& f, auto&& append) const {
    const float worst = std::min(e.shape, f.shape);
    if ((!e.changed && !f.changed) || worst >= good_enough_) return;
    for (const VertexId c : e.corners)
      if (c > b && contains(f.corners, c) &&
          plan_face_swap(mesh_, e.element, f.element, Swap<3>::bar(worst)))
        append(Swappable{vertex_, b, c, worst});
  }

  const Mesh<3>& mesh_;
  VertexId vertex_;
  const Star& star_;
  float good_enough_;
};

}  // namespace

template <>
std::vector<Swappable> Swap<3>::improvements(const runtime::Executor& executor, Mesh<3>& mesh,
                                             std::uint32_t after, double below) {
  const auto good_enough = static_cast<float>(shape_of_mean_ratio<3>(below));
  const auto find = [&](std::size_t v, auto&& append) {
    const auto a = static_cast<VertexId>(v);
    const Star star(mesh, a, after);
    const SwapSearch search(mesh, a, star, good_enough);
    for (const Star::Edge& edge : star.edges) {
      search.try_edge(edge, append);
      search.try_faces(edge, append);
    }
  };
  return runtime::parallel_collect<Swappable>(executor, mesh.vertex_slots(), find);
}

template class Swap<3>;

}  // namespace ductile::meshadapt
