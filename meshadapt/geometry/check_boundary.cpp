/// @file
/// The check that the boundary of a mesh does not cross itself.
#include <algorithm>
#include <array>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/box_index.hpp"
#include "mesh/first_bad.hpp"
#include "mesh/problems.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
class CrossingFacets {
 public:
  explicit CrossingFacets(const AnyMesh& mesh)
      : mesh_(mesh),
        index_(facets().size(), [&](std::size_t f) { return box_around(points(f)); }) {}

  std::size_t size() const { return facets().size(); }

  /// The first of the facets behind this one that crosses it, or no_index.
  std::size_t partner_of(std::size_t f) const {
    std::size_t first = no_index;
    const std::array<Vector<Dim>, Dim> here = points(f);
    index_.each_meeting(box_around(here), [&](std::size_t g) {
      if (g <= f || g >= first) return;
      const std::array<Vector<Dim>, Dim> there = points(g);
      if (crosses(f, here, g, there) || (Dim == 3 && crosses(g, there, f, here))) first = g;
    });
    return first;
  }

 private:
  using Points = std::array<Vector<Dim>, Dim>;

  const Cells<Dim>& facets() const { return facets_in<Dim>(mesh_); }

  Points points(std::size_t f) const {
    Points result;
    for (std::size_t i = 0; i < Dim; ++i)
      result[i] = position_in<Dim>(mesh_, facets().vertices[f][i]);
    return result;
  }

  bool has_vertex(std::size_t f, std::uint32_t v) const {
    const auto& corners = facets().vertices[f];
    return std::find(corners.begin(), corners.end(), v) != corners.end();
  }

  /// Does an edge of facet g go through facet f?
  bool crosses(std::size_t f, const Points& at_f, std::size_t g, const Points& at_g) const {
    std::array<int, Dim> side{};  // of f that each corner of g is on; 0 in its plane
    for (std::size_t i = 0; i < Dim; ++i)
      if (!has_vertex(f, facets().vertices[g][i])) side[i] = side_of(at_f, at_g[i]);
    for (std::size_t i = 0; i < Dim; ++i) {
      const std::size_t j = (i + 1) % Dim;
      if (side[i] * side[j] < 0 && goes_inside(at_f, at_g[i], at_g[j])) return true;
    }
    return false;
  }

  static int side_of(const Points& facet, const Vector<Dim>& point) {
    std::array<Vector<Dim>, Dim + 1> corners;
    std::copy(facet.begin(), facet.end(), corners.begin());
    corners[Dim] = point;
    return turn(corners);
  }

  /// The sign of a determinant, 0 if it is not certain.
  static int turn(const std::array<Vector<Dim>, Dim + 1>& corners) {
    const double determinant = certain_determinant<Dim>(corners);
    return (determinant > 0 ? 1 : 0) - (determinant < 0 ? 1 : 0);
  }

  /// Where the line through p and q, on either side of a facet, meets its plane: is that inside?
  static bool goes_inside(const Points& facet, const Vector<Dim>& p, const Vector<Dim>& q) {
    std::array<int, Dim> side;
    for (std::size_t i = 0; i < Dim; ++i) {
      if constexpr (Dim == 2)
        side[i] = (i == 0 ? 1 : -1) * turn({p, q, facet[i]});
      else
        side[i] = turn({p, q, facet[i], facet[(i + 1) % 3]});
    }
    return side[0] != 0 &&
           std::all_of(side.begin(), side.end(), [&](int s) { return s == side[0]; });
  }

  const AnyMesh& mesh_;
  BoxIndex<Dim> index_;
};

template <int Dim>
std::vector<std::string> check(const runtime::Executor& executor, const AnyMesh& mesh) {
  const CrossingFacets<Dim> crossing(mesh);
  Problems problems(executor);
  problems.expect_none(
      crossing.size(), [&](std::size_t f) { return crossing.partner_of(f) != no_index; },
      [&](std::size_t f) {
        return entity(facet_name<Dim>(), f) + " crosses " +
               entity(facet_name<Dim>(), crossing.partner_of(f));
      });
  return problems.take();
}

}  // namespace

std::vector<std::string> check_boundary(const runtime::Executor& executor, const AnyMesh& mesh) {
  return mesh.dimension == 2 ? check<2>(executor, mesh) : check<3>(executor, mesh);
}

}  // namespace ductile::meshadapt
