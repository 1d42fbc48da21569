#include "levelset/slides.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace ductile::meshadapt {
namespace {

/// Sine of an angle that rounding may explain.
constexpr double flat = 1e-9;

/// An edge from the vertex, on facets that it must stay on.
struct Spoke {
  VertexId end;
  std::int64_t kind;  // of the facets: listed ones differ by reference, and in 2D by ridge
  int facets = 1;
  bool is_curve = false;  // must the vertex stay on it?
};

template <int Dim>
struct Surroundings {
  std::vector<Spoke> spokes;
  bool has_facets = false, all_flat = true;  // towards the other vertex

  void add(VertexId end, std::int64_t kind) {
    const auto at = std::ranges::find(spokes, end, &Spoke::end);
    if (at == spokes.end()) {
      spokes.push_back({end, kind});
    } else {
      ++at->facets;
      at->is_curve |= at->kind != kind;
    }
  }
};

template <int Dim>
std::int64_t kind_of(const CutDomain<Dim>& domain, std::uint32_t listed) {
  constexpr std::int64_t unlisted = std::int64_t{1} << 40;
  if (listed == 0) return unlisted;
  const bool ridge = Dim == 2 && domain.is_ridge[listed - 1] != 0;
  return 2 * std::int64_t{facets_in<Dim>(domain.any).reference[listed - 1]} + ridge;
}

bool is_flat(const Vector<2>&, const std::array<Vector<2>, 1>&) { return true; }
bool is_flat(const Vector<3>& along, const std::array<Vector<3>, 2>& sides) {
  const Vector<3> normal = cross(sides[0], sides[1]);
  return std::abs(dot(along, normal)) <= flat * norm(along) * norm(normal);
}

/// Visits each facet once that the vertex must stay on.
template <int Dim>
Surroundings<Dim> survey(const CutDomain<Dim>& domain, VertexId vertex, VertexId towards) {
  Surroundings<Dim> found;
  const auto& position_of = domain.mesh.position_of;
  const Vector<Dim> here = position_of[vertex], along = position_of[towards] - here;
  for (const ElementId e : domain.mesh.elements_of(vertex)) {
    const Corners<Dim>& corners = domain.mesh.corners_of[e];
    for (std::size_t i = 0; i <= Dim; ++i) {
      const ElementId other = domain.mesh.neighbour_of[e][i];
      const std::uint32_t listed = domain.listed_of[e][i];
      if (corners[i] == vertex || (other != none && other < e)) continue;
      if (listed == 0 && !domain.is_border(e, i)) continue;
      found.has_facets = true;
      std::array<Vector<Dim>, Dim - 1> sides;
      std::size_t n = 0;
      for (const VertexId v : facet_of<Dim>(corners, static_cast<int>(i))) {
        if (v == vertex) continue;
        found.add(v, kind_of(domain, listed));
        sides[n++] = position_of[v] - here;
      }
      found.all_flat = found.all_flat && is_flat(along, sides);
    }
  }
  return found;
}

/// Where facets of one kind do not continue from one side of an edge to the other, or the edge is
/// listed, it belongs to a curve. In 2D all facets do.
template <int Dim>
void find_curves(const CutDomain<Dim>& domain, VertexId vertex, Surroundings<Dim>& found) {
  for (Spoke& spoke : found.spokes) {
    spoke.is_curve |= Dim == 2 || spoke.facets != 2;
    if (Dim == 3) spoke.kind = -1;
  }
  for (const auto& [from, to, edge] : domain.spokes_of(vertex)) {
    found.add(to, 0);
    Spoke& spoke = *std::ranges::find(found.spokes, to, &Spoke::end);
    spoke.is_curve = true;
    spoke.kind = 2 * std::int64_t{domain.any.edges.reference[edge]} + domain.is_ridge[edge];
  }
}

}  // namespace

template <int Dim>
bool may_slide(const CutDomain<Dim>& domain, VertexId vertex, VertexId towards) {
  if (domain.is_fixed[vertex] != 0) return false;
  auto found = survey(domain, vertex, towards);
  find_curves(domain, vertex, found);
  if (found.spokes.empty()) return true;
  if (!found.all_flat) return false;
  const auto ahead = std::ranges::find(found.spokes, towards, &Spoke::end);
  if (ahead == found.spokes.end()) return false;
  const auto curves = std::ranges::count(found.spokes, true, &Spoke::is_curve);
  if (curves == 0) return true;
  const auto back = std::ranges::find_if(
      found.spokes, [&](const Spoke& s) { return s.is_curve && s.end != towards; });
  if (curves != 2 || !ahead->is_curve || back->kind != ahead->kind) return false;
  const auto& position_of = domain.mesh.position_of;
  const Vector<Dim> u = position_of[towards] - position_of[vertex];
  const Vector<Dim> w = position_of[back->end] - position_of[vertex];
  const double cosine = dot(u, w) / (norm(u) * norm(w));
  return norm(w - (dot(u, w) / dot(u, u)) * u) <= flat * norm(w) && cosine < 0;
}

template bool may_slide(const CutDomain<2>&, VertexId, VertexId);
template bool may_slide(const CutDomain<3>&, VertexId, VertexId);

}  // namespace ductile::meshadapt
