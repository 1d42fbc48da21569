#include "geometry/smooth_model.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/curve_tangents.hpp"
#include "geometry/patch_normals.hpp"

namespace ductile::meshadapt {

namespace {

using Triangle = CurvedSimplex<3, 3>;

/// Curves facets of 3D by the normals at their corners (Vlachos, Peters, Boyd & Mitchell, "Curved
/// PN triangles", I3D 2001), and by the curves that they end at.
class FacetBender {
 public:
  FacetBender(const runtime::Executor& executor, const ModelInput<3>& input,
              const CurveTangents<3>& curves, SmoothModel<3>::Pieces<2>& edges)
      : input_(input), normals_(executor, input, curves), edges_(edges) {}

  /// Curves in the plane of a facet take up at most half of its height. Those at facets that are
  /// held are straight.
  void narrow_curves() {
    std::vector<double> share(edges_.size(), 1);
    for (std::size_t f = 0; f < input_.facets.size(); ++f)
      for (std::size_t i = 0; i < 3 && input_.facets[f].held; ++i)
        if (const std::uint32_t edge = normals_.edge_at(f, i); edge != no_edge)
          edges_[edge].reset();
    for (std::size_t f = 0; f < input_.facets.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t edge = normals_.edge_at(f, i);
        if (edge != no_edge && edges_[edge])
          share[edge] = std::min(share[edge], share_that_fits(f, i, *edges_[edge]));
      }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (share[e] >= 1) continue;
      auto& control = edges_[e]->control;
      const Vector<3> a = control[0][0], b = control[1][1];
      control[0][1] = share[e] * control[0][1] + (1 - share[e]) * Triangle::even(a, b);
      control[1][0] = share[e] * control[1][0] + (1 - share[e]) * Triangle::even(b, a);
    }
  }

  Samples<3, 3> samples() const { return normals_.samples(); }

  std::optional<Triangle> piece(std::size_t facet) const {
    Triangle piece{};
    bool bends = false;
    for (std::size_t i = 0; i < 3; ++i) piece.control[i][i] = at(facet, i);
    for (std::size_t i = 0; i < 3; ++i) bends = set_side(facet, i, piece) || bends;
    if (!bends) return {};
    set_middle(piece);
    return piece;
  }

 private:
  const Vector<3>& at(std::size_t facet, std::size_t i) const {
    return input_.points[input_.facets[facet].corner[i]];
  }

  double share_that_fits(std::size_t facet, std::size_t opposite,
                         const CurvedSimplex<3, 2>& edge) const {
    const Vector<3> a = edge.corner(0), b = edge.corner(1), along = b - a;
    Vector<3> inwards = at(facet, opposite) - a;
    inwards -= (dot(inwards, along) / dot(along, along)) * along;
    const double height2 = dot(inwards, inwards);
    double most = 0;
    for (const auto& [from, to] : {std::pair(0, 1), std::pair(1, 0)}) {
      const auto i = static_cast<std::size_t>(from), j = static_cast<std::size_t>(to);
      const Vector<3> off = edge.control[i][j] - Triangle::even(edge.corner(i), edge.corner(j));
      most = std::max(most, std::abs(dot(off, inwards)));
    }
    return most > 0 ? height2 / (1.5 * most) : 1;
  }

  /// Sets the control points of the side across from a corner. Is it bent?
  bool set_side(std::size_t facet, std::size_t opposite, Triangle& piece) const {
    const std::size_t i = (opposite + 1) % 3, j = (opposite + 2) % 3;
    const Vector<3>&a = at(facet, i), &b = at(facet, j);
    Vector<3>&from_a = piece.control[i][j], &from_b = piece.control[j][i];
    from_a = Triangle::even(a, b);
    from_b = Triangle::even(b, a);
    if (const std::uint32_t edge = normals_.edge_at(facet, opposite); edge != no_edge) {
      if (!edges_[edge]) return false;
      const bool same = input_.edges[edge].corner[0] == input_.facets[facet].corner[i];
      from_a = edges_[edge]->control[same ? 0 : 1][same ? 1 : 0];
      from_b = edges_[edge]->control[same ? 1 : 0][same ? 0 : 1];
      return true;
    }
    if (normals_.is_straight(facet, opposite)) return false;
    from_a = control_along(a, b, normals_.normal(facet, i));
    from_b = control_along(b, a, normals_.normal(facet, j));
    limit_bend(a, b, from_a, from_b, input_.tolerance);
    return true;
  }

  /// In the direction of the chord, as far as a normal allows it.
  static Vector<3> control_along(const Vector<3>& from, const Vector<3>& to,
                                 const Vector<3>& normal) {
    constexpr double steepest = 0.4;
    const Vector<3> chord = to - from;
    const double length = norm(chord);
    const double across = std::clamp(dot(chord, normal), -steepest * length, steepest * length);
    return control_towards(from, to, chord - across * normal);
  }

  /// So that what is of second degree is kept; not so far from the facet that its centre leaves the
  /// tolerance.
  void set_middle(Triangle& piece) const {
    Vector<3> corners, sides;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        (i == j ? corners : sides) += (i == j ? 1.0 / 3 : 1.0 / 6) * piece.control[i][j];
    piece.middle = sides + 0.5 * (sides - corners);
    const Vector<3> off = piece.at({1.0 / 3, 1.0 / 3, 1.0 / 3}) - corners;
    const double excess = norm(off) - input_.tolerance;
    if (excess > 0) piece.middle -= (4.5 * excess / norm(off)) * off;
  }

  const ModelInput<3>& input_;
  PatchNormals normals_;
  SmoothModel<3>::Pieces<2>& edges_;
};

}  // namespace

template <>
SmoothModel<2>::SmoothModel(const runtime::Executor& executor, const ModelInput<2>& input) {
  std::vector<ModelEdge> chain;
  chain.reserve(input.facets.size());
  for (const ModelFacet<2>& facet : input.facets) chain.push_back({facet.corner, facet.smooth});
  const CurveTangents<2> tangents(input, chain);
  facet_samples = tangents.samples();
  facets.resize(chain.size());
  runtime::parallel_for(executor, chain.size(), [&](std::size_t f) {
    if (!input.facets[f].held) facets[f] = tangents.piece(f);
  });
}

template <>
SmoothModel<3>::SmoothModel(const runtime::Executor& executor, const ModelInput<3>& input) {
  const CurveTangents<3> tangents(input, input.edges);
  edge_samples = tangents.samples();
  edges.resize(input.edges.size());
  runtime::parallel_for(executor, edges.size(),
                        [&](std::size_t e) { edges[e] = tangents.piece(e); });
  FacetBender bender(executor, input, tangents, edges);
  bender.narrow_curves();
  facet_samples = bender.samples();
  facets.resize(input.facets.size());
  runtime::parallel_for(executor, facets.size(),
                        [&](std::size_t f) { facets[f] = bender.piece(f); });
}

}  // namespace ductile::meshadapt
