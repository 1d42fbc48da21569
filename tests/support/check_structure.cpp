#include "support/check_structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "checks/problems.hpp"
#include "core/orientation.hpp"
#include "geometry/rounding.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

template <int Dim>
class StructureChecker {
 public:
  StructureChecker(const Executor& executor, const Mesh<Dim>& mesh)
      : mesh_(mesh), problems_(executor) {}

  std::vector<std::string> run() {
    if (!check_corners() || !check_lists()) return problems_.take();
    check_qualities();
    check_facets();
    if (!check_numbers()) return problems_.take();
    check_flatness();
    check_folds();
    if constexpr (Dim == 3) check_curves();
    check_kinds();
    return problems_.take();
  }

 private:
  using Ids = std::vector<std::uint32_t>;

  template <class Bad>
  bool no_element(Bad&& bad, const char* what) {
    return problems_.expect_none(
        mesh_.element_slots(),
        [&](std::size_t e) {
          return mesh_.alive(static_cast<ElementId>(e)) && bad(static_cast<ElementId>(e));
        },
        [&](std::size_t e) { return "element " + std::to_string(e) + what; });
  }
  template <class Bad>
  bool no_facet(Bad&& bad, const char* what) {
    return no_element(
        [&](ElementId e) {
          for (int i = 0; i <= Dim; ++i)
            if (bad(e, i)) return true;
          return false;
        },
        what);
  }
  template <class Bad>
  bool no_vertex(Bad&& bad, const char* what) {
    return problems_.expect_none(
        mesh_.vertex_slots(), [&](std::size_t v) { return bad(static_cast<VertexId>(v)); },
        [&](std::size_t v) { return "vertex " + std::to_string(v) + what; });
  }

  // ---- Elements and lists ----

  bool check_corners() {
    return no_element(
        [&](ElementId e) {
          const Corners<Dim>& corners = mesh_.corners_of[e];
          for (std::size_t a = 0; a < corners.size(); ++a) {
            if (corners[a] >= mesh_.vertex_slots()) return true;
            for (std::size_t b = 0; b < a; ++b)
              if (corners[a] == corners[b]) return true;
          }
          return false;
        },
        " names a vertex twice or one that does not exist");
  }

  bool check_lists() {
    bool good = no_vertex(
        [&](VertexId v) {
          const auto list = mesh_.elements_of.of(v);
          for (std::size_t i = 0; i < list.size(); ++i) {
            if (i > 0 && list[i] <= list[i - 1]) return true;
            if (list[i] >= mesh_.element_slots() || !mesh_.alive(list[i])) return true;
            if (!contains(mesh_.corners_of[list[i]], v)) return true;
          }
          return false;
        },
        "'s list of elements is not sorted, or has one that is not its own");
    return no_element(
               [&](ElementId e) {
                 for (const VertexId v : mesh_.corners_of[e]) {
                   const auto list = mesh_.elements_of.of(v);
                   if (!std::binary_search(list.begin(), list.end(), e)) return true;
                 }
                 return false;
               },
               " is missing in the list of one of its vertices") &&
           good;
  }

  void check_qualities() {
    no_element(
        [&](ElementId e) {
          std::array<Vector<Dim>, Dim + 1> p;
          for (std::size_t i = 0; i < p.size(); ++i)
            p[i] = mesh_.site_of[mesh_.corners_of[e][i]].position;
          return orientation<Dim>(p) <= 0;
        },
        " has no positive volume");
    no_element(
        [&](ElementId e) {
          const auto now = static_cast<float>(mesh_.quality_at(mesh_.corners_of[e]));
          return std::isfinite(now) &&
                 !(std::abs(mesh_.quality_of[e] - now) <= 1e-5F * std::abs(now));
        },
        "'s quality is not up to date");
  }

  // ---- Facets ----

  PatchId patch(ElementId e, int i) const {
    return mesh_.patches_of[e][static_cast<std::size_t>(i)];
  }

  /// Elements that share a facet with e, besides e.
  Ids across(ElementId e, int i) const {
    const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], i);
    Ids found;
    for (const ElementId other : mesh_.elements_of.of(facet[0]))
      if (other != e && std::all_of(facet.begin(), facet.end(), [&](VertexId v) {
            return contains(mesh_.corners_of[other], v);
          }))
        found.push_back(other);
    return found;
  }

  int facet_number(ElementId element, const Facet<Dim>& facet) const {
    for (std::size_t i = 0; i <= Dim; ++i)
      if (!contains(facet, mesh_.corners_of[element][i])) return static_cast<int>(i);
    return 0;  // impossible, because the corners are different
  }

  /// Are the two orders of a facet's corners of different parity?
  static bool opposite(const Facet<Dim>& a, const Facet<Dim>& b) {
    if constexpr (Dim == 2)
      return a[0] == b[1];
    else
      return b[static_cast<std::size_t>(corner_of(b, a[0]) + 1) % Dim] == a[2];
  }

  void check_facets() {
    no_facet([&](ElementId e, int i) { return across(e, i).size() > 1; },
             " has a facet with more than two elements");
    no_facet(
        [&](ElementId e, int i) {
          const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], i);
          for (const ElementId f : across(e, i))
            if (!opposite(facet, facet_of<Dim>(mesh_.corners_of[f], facet_number(f, facet))))
              return true;
          return false;
        },
        " has a facet with another element on the same side");
    no_facet([&](ElementId e, int i) { return patch(e, i) == 0 && across(e, i).empty(); },
             " has a boundary facet without a patch");
    no_facet(
        [&](ElementId e, int i) {
          for (const ElementId f : across(e, i)) {
            if (patch(e, i) == 0 && mesh_.region_of[e] != mesh_.region_of[f]) return true;
            const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], i);
            if (patch(f, facet_number(f, facet)) != patch(e, i)) return true;
          }
          return false;
        },
        " has a facet whose two sides differ in patch, or in region though it has no patch");
  }

  // ---- Patches and curves ----

  bool check_numbers() {
    bool good = no_facet([&](ElementId e, int i) { return patch(e, i) >= mesh_.patches.size(); },
                         " has a facet on a patch that does not exist");
    good = no_element([&](ElementId e) { return mesh_.region_of[e] >= mesh_.regions.size(); },
                      " is in a region that does not exist") &&
           good;
    if constexpr (Dim == 3)
      good = no_vertex(
                 [&](VertexId v) {
                   for (const CurveLink& link : mesh_.links_of.of(v))
                     if (link.curve == 0 || link.curve >= mesh_.curves.size() ||
                         link.to >= mesh_.vertex_slots())
                       return true;
                   return false;
                 },
                 " is linked along a curve, or to a vertex, that does not exist") &&
             good;
    return good;
  }

  /// Allowed distance from flat or straight: twice what classification allows, plus rounding.
  double tolerance() const {
    if (mesh_.rounding) return 4 * mesh_.rounding->tolerance;
    double extent = 0, largest = 0;
    const Vector<Dim>* first = nullptr;
    for (VertexId v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.vertex_alive(v)) continue;
      if (first == nullptr) first = &mesh_.site_of[v].position;
      extent = std::max(extent, norm(mesh_.site_of[v].position - *first));
      largest = std::max(largest, norm(mesh_.site_of[v].position));
    }
    return 1e-9 * extent + 64 * std::numeric_limits<double>::epsilon() * largest;
  }

  bool is_flat(PatchId id) const { return id != 0 && !mesh_.patches[id].smooth; }

  void check_flatness() {
    const double allowed = tolerance();
    std::vector<const Vector<Dim>*> origin(mesh_.patches.size(), nullptr);
    for (ElementId e = 0; e < mesh_.element_slots(); ++e)
      for (int i = 0; mesh_.alive(e) && i <= Dim; ++i)
        origin[patch(e, i)] = &mesh_.site_of[facet_of<Dim>(mesh_.corners_of[e], i)[0]].position;
    no_facet(
        [&](ElementId e, int i) {
          const PatchId id = patch(e, i);
          if (!is_flat(id)) return false;
          for (const VertexId v : facet_of<Dim>(mesh_.corners_of[e], i))
            if (!(std::abs(dot(mesh_.site_of[v].position - *origin[id],
                               mesh_.patches[id].normal)) <= allowed))
              return true;
          return false;
        },
        " has a facet that does not lie in the plane of its patch");
  }

  /// Area of a facet projected along the normal of its patch; negative if seen from behind.
  double projection(ElementId e, int i) const {
    const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], i);
    const auto side = [&](std::size_t k) {
      return mesh_.site_of[facet[k]].position - mesh_.site_of[facet[0]].position;
    };
    const Vector<Dim>& normal = mesh_.patches[patch(e, i)].normal;
    if constexpr (Dim == 2)
      return side(1)[1] * normal[0] - side(1)[0] * normal[1];
    else
      return dot(cross(side(1), side(2)), normal);
  }

  /// Checks that all elements of a region lie on one side of a patch, unless it is inside that
  /// region.
  void check_folds() {
    const auto inside_region = [&](ElementId e, int i) {
      const Ids others = across(e, i);
      return !others.empty() && mesh_.region_of[others[0]] == mesh_.region_of[e];
    };
    std::map<std::pair<PatchId, std::uint32_t>, double> largest;
    const auto key = [&](ElementId e, int i) { return std::pair(patch(e, i), mesh_.region_of[e]); };
    for (ElementId e = 0; e < mesh_.element_slots(); ++e)
      for (int i = 0; mesh_.alive(e) && i <= Dim; ++i) {
        if (!is_flat(patch(e, i)) || inside_region(e, i)) continue;
        double& most = largest[key(e, i)];
        if (std::abs(projection(e, i)) > std::abs(most)) most = projection(e, i);
      }
    const double allowed = std::pow(tolerance(), Dim - 1);
    no_facet(
        [&](ElementId e, int i) {
          if (!is_flat(patch(e, i)) || inside_region(e, i)) return false;
          return projection(e, i) * std::copysign(1.0, largest.at(key(e, i))) < -allowed;
        },
        " has a facet that is folded over in its patch");
  }

  Ids shell(VertexId a, VertexId b) const {
    Ids elements;
    shell_of(mesh_, a, b, elements);
    return elements;
  }

  /// The patches of the facets at an edge, one entry for each facet, sorted.
  Ids patches_at(VertexId a, VertexId b) const {
    std::vector<std::pair<VertexId, PatchId>> facets;  // third corner, patch
    for (const ElementId e : shell(a, b))
      for (int i = 0; i <= Dim; ++i) {
        const Facet<Dim> facet = facet_of<Dim>(mesh_.corners_of[e], i);
        if (patch(e, i) == 0 || !contains(facet, a) || !contains(facet, b)) continue;
        for (const VertexId v : facet)
          if (v != a && v != b) facets.emplace_back(v, patch(e, i));
      }
    std::sort(facets.begin(), facets.end());
    facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
    Ids patches;
    for (const auto& [vertex, id] : facets) patches.push_back(id);
    std::sort(patches.begin(), patches.end());
    return patches;
  }

  void check_curves() {
    const double allowed = tolerance();
    no_vertex(
        [&](VertexId v) {
          const auto links = mesh_.links_of.of(v);
          for (std::size_t i = 0; i < links.size(); ++i) {
            if (i > 0 && links[i] <= links[i - 1]) return true;
            const auto back = mesh_.links_of.of(links[i].to);
            if (!std::binary_search(back.begin(), back.end(), CurveLink{v, links[i].curve}))
              return true;
            if (shell(v, links[i].to).empty()) return true;
          }
          return false;
        },
        "'s links are not sorted, not mutual, or not along edges");
    no_vertex(
        [&](VertexId v) {
          for (const CurveLink& link : mesh_.links_of.of(v)) {
            if (mesh_.curves[link.curve].smooth) continue;
            const Vector<Dim> d = mesh_.site_of[link.to].position - mesh_.site_of[v].position;
            const Vector<3>& along = mesh_.curves[link.curve].direction;
            Vector<Dim> aside = d;
            for (int k = 0; k < Dim; ++k) aside[k] -= dot(d, axis(along)) * along[k];
            if (!(norm(aside) <= allowed)) return true;
          }
          return false;
        },
        " is linked along a curve that is not straight");
    no_element(
        [&](ElementId e) {
          for (const auto& [i, j] : Simplex<Dim>::edge) {
            const VertexId a = mesh_.corners_of[e][static_cast<std::size_t>(i)];
            const VertexId b = mesh_.corners_of[e][static_cast<std::size_t>(j)];
            const Ids patches = patches_at(a, b);
            const bool plain = patches.empty() || (patches.size() == 2 && patches[0] == patches[1]);
            if (!plain && mesh_.curve_of(a, b) == 0) return true;
          }
          return false;
        },
        " has an edge between patches that is on no curve");
  }

  static Vector<Dim> axis(const Vector<3>& direction) {
    Vector<Dim> result;
    for (int k = 0; k < Dim; ++k) result[k] = direction[k];
    return result;
  }

  // ---- Vertices ----

  struct Surroundings {
    Ids patches;  // sorted, each once
    bool required = false;
  };

  Surroundings surroundings(VertexId v) const {
    Surroundings result;
    for (const ElementId e : mesh_.elements_of.of(v)) {
      result.required = result.required || mesh_.required_element(e);
      for (int i = 0; i <= Dim; ++i)
        if (patch(e, i) != 0 && mesh_.corners_of[e][static_cast<std::size_t>(i)] != v)
          result.patches.push_back(patch(e, i));
    }
    std::sort(result.patches.begin(), result.patches.end());
    result.patches.erase(std::unique(result.patches.begin(), result.patches.end()),
                         result.patches.end());
    for (const PatchId p : result.patches)
      result.required = result.required || mesh_.patches[p].required;
    if constexpr (Dim == 3)
      for (const CurveLink& link : mesh_.links_of.of(v))
        result.required = result.required || mesh_.curves[link.curve].required;
    return result;
  }

  void check_kinds() {
    no_vertex([&](VertexId v) { return mesh_.vertex_alive(v) && misjudged(v); },
              " may move or go in a way that does not fit what it lies on");
    if constexpr (Dim == 3)
      no_vertex([&](VertexId v) { return !mesh_.vertex_alive(v) && !mesh_.links_of.of(v).empty(); },
                " is gone but still linked along a curve");
  }

  bool misjudged(VertexId v) const {
    const VertexKind& kind = mesh_.kind_of[v];
    if (kind.class_dimension == 0) return false;
    const Surroundings around = surroundings(v);
    if (kind.corner || kind.required || around.required) return true;
    std::size_t links = 0;
    if constexpr (Dim == 3) links = mesh_.links_of.of(v).size();
    if (kind.class_dimension == Dim) return !around.patches.empty() || links != 0;
    if (kind.class_dimension == Dim - 1)
      return around.patches != Ids{mesh_.entity_of[v]} || links != 0;
    return kind.class_dimension != 1 || misjudged_on_curve(v, around.patches);
  }

  /// Is a vertex of a curve classified wrongly? The curve must continue straight, between the same
  /// patches.
  bool misjudged_on_curve(VertexId v, const Ids& patches) const {
    if constexpr (Dim == 3) {
      const auto links = mesh_.links_of.of(v);
      if (links.size() != 2) return true;
      for (const CurveLink& link : links) {
        Ids along = patches_at(v, link.to);
        along.erase(std::unique(along.begin(), along.end()), along.end());
        if (link.curve != mesh_.entity_of[v] || along != patches) return true;
      }
    }
    return false;
  }

  const Mesh<Dim>& mesh_;
  Problems problems_;
};

}  // namespace

template <int Dim>
std::vector<std::string> check_mesh(const Executor& executor, const Mesh<Dim>& mesh) {
  return StructureChecker<Dim>(executor, mesh).run();
}

template std::vector<std::string> check_mesh(const Executor&, const Mesh<2>&);
template std::vector<std::string> check_mesh(const Executor&, const Mesh<3>&);

}  // namespace ductile::meshadapt
