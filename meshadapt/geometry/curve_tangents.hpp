/// @file
/// CurveTangents: directions at the ends of the edges of chains, and the cubic curves that follow
/// them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/unit.hpp"
#include "geometry/smooth_model.hpp"

namespace ductile::meshadapt {

constexpr std::uint32_t no_edge = ~std::uint32_t{0};

/// The control point of a side from one corner towards another, in a direction there: so far that
/// the curve is an arc of a circle, nearly, if it is turned by as much at the other end.
template <int Dim>
Vector<Dim> control_towards(const Vector<Dim>& from, const Vector<Dim>& to,
                            const Vector<Dim>& direction) {
  const Vector<Dim> chord = to - from;
  const double length = norm(chord), size = norm(direction);
  const double cosine = dot(chord, direction) / (length * size);
  if (!(cosine > 0.7)) return CurvedSimplex<Dim, 2>::even(from, to);
  return from + (2 * length / (3 * (1 + cosine) * size)) * direction;
}

/// Brings the control points of a side closer to where they are if it is straight, until the curve
/// is within a distance of that.
template <int Dim>
void limit_bend(const Vector<Dim>& a, const Vector<Dim>& b, Vector<Dim>& from_a,
                Vector<Dim>& from_b, double distance) {
  const Vector<Dim> even_a = CurvedSimplex<Dim, 2>::even(a, b);
  const Vector<Dim> even_b = CurvedSimplex<Dim, 2>::even(b, a);
  const Vector<Dim> off_a = from_a - even_a, off_b = from_b - even_b;
  double most = 0;
  for (int i = 1; i < 8; ++i) {
    const double t = i / 8.0, s = 1 - t;
    most = std::max(most, norm((3 * s * s * t) * off_a + (3 * s * t * t) * off_b));
  }
  if (most <= distance) return;
  from_a = even_a + (distance / most) * off_a;
  from_b = even_b + (distance / most) * off_b;
}

/// Edges that continue each other.
template <int Dim>
class CurveTangents {
 public:
  /// Edges that are not smooth are straight, and those that are collinear with the next one.
  CurveTangents(const ModelInput<Dim>& input, std::span<const ModelEdge> edges)
      : input_(input), edges_(edges), next_(edges.size(), {no_edge, no_edge}) {
    connect();
    straight_.resize(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
      straight_[e] = !edges[e].smooth || is_collinear(e, 0) || is_collinear(e, 1);
  }

  /// Does another edge continue this one at an end?
  bool is_continued(std::size_t edge, std::size_t end) const { return next_[edge][end] != no_edge; }

  /// From an end of an edge into it; as long as is convenient.
  Vector<Dim> tangent(std::size_t edge, std::size_t end) const {
    const Vector<Dim> chord = along(edge, end);
    if (straight_[edge]) return chord;
    if (is_continued(edge, end)) return through(edge, end, chord);
    if (!is_continued(edge, 1 - end)) return chord;
    // As much to one side of the chord as it is to the other side at the other end.
    const Vector<Dim> other = through(edge, 1 - end, -1.0 * chord);
    return other - (2 * dot(chord, other) / dot(chord, chord)) * chord;
  }

  /// Edges that continue each other share a sample. Where the circle is turned by more than 18
  /// degrees against both edges it is that of a needle, and their mean counts.
  Samples<Dim, 2> samples() const {
    constexpr double near = 0.95;
    Samples<Dim, 2> result;
    result.facets.resize(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      for (std::size_t end = 0; end < 2; ++end) {
        const std::uint32_t next = next_[e][end];
        const bool is_known = next != no_edge && next < e;
        const std::size_t beside = next == no_edge ? 0 : end_at(next, edges_[e].corner[end]);
        std::uint32_t& sample = result.facets[e][end];
        sample =
            is_known ? result.facets[next][beside] : static_cast<std::uint32_t>(result.all.size());
        if (!is_known) {
          const Vector<Dim> chord = along(e, end), tangent = unit(this->tangent(e, end));
          const Vector<Dim> mean = unit(next == no_edge ? chord : chord - along(next, beside));
          result.all.push_back({at(e, end), dot(tangent, mean) > near ? tangent : mean});
        }
        result.all[sample].area += norm(along(e, end)) / 2;
      }
    return result;
  }

  /// Nothing if it is straight.
  std::optional<CurvedSimplex<Dim, 2>> piece(std::size_t edge) const {
    if (straight_[edge]) return {};
    const Vector<Dim>&a = at(edge, 0), &b = at(edge, 1);
    Vector<Dim> from_a = control_towards(a, b, tangent(edge, 0));
    Vector<Dim> from_b = control_towards(b, a, tangent(edge, 1));
    limit_bend(a, b, from_a, from_b, input_.tolerance);
    return CurvedSimplex<Dim, 2>{{{{a, from_a}, {from_b, b}}}, {}};
  }

 private:
  const Vector<Dim>& at(std::size_t edge, std::size_t end) const {
    return input_.points[edges_[edge].corner[end]];
  }
  Vector<Dim> along(std::size_t edge, std::size_t end) const {
    return at(edge, 1 - end) - at(edge, end);
  }
  std::size_t end_at(std::uint32_t edge, std::uint32_t point) const {
    return edges_[edge].corner[0] == point ? 0 : 1;
  }

  void connect() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;  // point, edge
    ends.reserve(2 * edges_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      for (const std::uint32_t point : edges_[e].corner) ends.emplace_back(point, e);
    std::sort(ends.begin(), ends.end());
    for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
      const std::uint32_t point = ends[begin].first;
      while (end < ends.size() && ends[end].first == point) ++end;
      if (end - begin != 2 || input_.ends[point] != 0) continue;
      const std::uint32_t e = ends[begin].second, f = ends[begin + 1].second;
      const std::size_t i = end_at(e, point), j = end_at(f, point);
      const Vector<Dim> u = along(e, i), v = along(f, j);
      if (!(-dot(u, v) > input_.least_turn * norm(u) * norm(v))) continue;
      next_[e][i] = f;
      next_[f][j] = e;
    }
  }

  bool is_collinear(std::size_t edge, std::size_t end) const {
    if (!is_continued(edge, end)) return false;
    const std::uint32_t next = next_[edge][end];
    const Vector<Dim> u = along(edge, end);
    const Vector<Dim> v = along(next, end_at(next, edges_[edge].corner[end]));
    const double flat = input_.flat;
    return norm(v - (dot(u, v) / dot(u, u)) * u) <= flat &&
           norm(u - (dot(u, v) / dot(v, v)) * v) <= flat;
  }

  /// The tangent of the circle through both ends of an edge and the next point, or of a straight
  /// continuation.
  Vector<Dim> through(std::size_t edge, std::size_t end, const Vector<Dim>& chord) const {
    const std::uint32_t next = next_[edge][end];
    const Vector<Dim> before = -1.0 * along(next, end_at(next, edges_[edge].corner[end]));
    if (straight_[next]) return before;
    return (1 / dot(chord, chord)) * chord + (1 / dot(before, before)) * before;
  }

  const ModelInput<Dim>& input_;
  std::span<const ModelEdge> edges_;
  std::vector<std::array<std::uint32_t, 2>> next_;  // [edge][end]
  std::vector<std::uint8_t> straight_;              // [edge]
};

}  // namespace ductile::meshadapt
