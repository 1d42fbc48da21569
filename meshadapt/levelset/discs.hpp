/// @file
/// Discs<Dim>: decides whether the surface may go through a vertex. It may if it is then one disc
/// (2D: one line) around the vertex in each split material there, and half a disc at the material's
/// border. Moving the surface from one side of the vertex onto it then deforms it without changing
/// its topology: before, it was a disc with the same rim.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// Counts how often the sign changes along a closed or open chain of vertices.
struct Turns {
  int changes = 0;          // steps from one sign to the other
  int minus = 0, plus = 0;  // steps between a zero and that sign
  bool flat = false;        // is there a step from zero to zero?

  void add(int a, int b) {
    if (a == 0 && b == 0)
      flat = true;
    else if (a * b != 0)
      changes += a * b < 0;
    else
      ++(a + b < 0 ? minus : plus);
  }

  /// Does the sign change so often, if 1 or 2? Each zero must lie between different signs.
  bool are(int expected) const { return !flat && minus == plus && changes + minus == expected; }
};

template <int Dim>
class Discs {
 public:
  /// sign_of[vertex] is -1, 1, or 0 on the surface. Both are referred to.
  Discs(const CutDomain<Dim>& domain, const std::vector<std::int8_t>& sign_of)
      : domain_(domain), sign_of_(sign_of), place_of_(sign_of.size()) {}

  /// May the surface go through this vertex?
  bool at(VertexId vertex) {
    std::vector<std::uint32_t> seen;
    for (const ElementId e : domain_.mesh.elements_of(vertex)) {
      const std::uint32_t material = domain_.material_of[e];
      if (!domain_.is_split(e) || std::ranges::find(seen, material) != seen.end()) continue;
      if (!at(vertex, material)) return false;
      seen.push_back(material);
    }
    return true;
  }

 private:
  /// A vertex of the link: the facets opposite `vertex` of the elements around it.
  struct LinkVertex {
    VertexId id;
    std::uint32_t parent;    // of those with the same sign
    bool on_border = false;  // of the material
    Turns around = {};       // along its own neighbours in the link
  };
  using Rim = std::array<VertexId, Dim - 1>;

  bool at(VertexId vertex, std::uint32_t material) {
    link_.clear();
    ring_ = {};
    has_border_ = false;
    for (const ElementId e : domain_.mesh.elements_of(vertex)) {
      if (domain_.material_of[e] != material) continue;
      const Corners<Dim>& corners = domain_.mesh.corners_of[e];
      add_link(facet_of<Dim>(corners, corner_of(corners, vertex)));
      for (std::size_t i = 0; i <= Dim; ++i) {
        if (corners[i] == vertex || !domain_.is_border(e, i)) continue;
        Rim rim;
        std::ranges::copy_if(corners, rim.begin(),
                             [&](VertexId v) { return v != vertex && v != corners[i]; });
        add_border(rim);
      }
    }
    return is_disc();
  }

  void add_link(const std::array<VertexId, 2>& edge) { ring_.add(sign(edge[0]), sign(edge[1])); }
  void add_link(const std::array<VertexId, 3>& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId here = triangle[i], next = triangle[(i + 1) % 3], last = triangle[(i + 2) % 3];
      link(here).around.add(sign(next), sign(last));
      link(next);
      if (sign(here) == 0 || sign(here) != sign(next)) continue;
      const std::uint32_t a = root(place_of_[here]), b = root(place_of_[next]);
      link_[std::max(a, b)].parent = std::min(a, b);
    }
  }

  void add_border(const std::array<VertexId, 1>&) { has_border_ = true; }
  void add_border(const std::array<VertexId, 2>& edge) {
    has_border_ = true;
    ring_.add(sign(edge[0]), sign(edge[1]));
    for (const VertexId v : edge) link(v).on_border = true;
  }

  /// Where the surface meets the link it must be one closed line, or a line from border to border:
  /// lines that do not branch, with one part of the link on either side. In 2D the surface meets
  /// the link twice, or once if there is a border.
  bool is_disc() const {
    if constexpr (Dim == 2) return ring_.are(has_border_ ? 1 : 2);
    if (has_border_ && !ring_.are(2)) return false;
    for (const LinkVertex& v : link_)
      if (sign(v.id) == 0 && !v.around.are(v.on_border ? 1 : 2)) return false;
    return parts(-1) == 1 && parts(1) == 1;
  }

  int sign(VertexId vertex) const { return sign_of_[vertex]; }

  LinkVertex& link(VertexId vertex) {
    std::uint32_t& place = place_of_[vertex];
    if (place < link_.size() && link_[place].id == vertex) return link_[place];
    place = static_cast<std::uint32_t>(link_.size());
    return link_.emplace_back(LinkVertex{vertex, place});
  }

  std::uint32_t root(std::uint32_t i) const {
    while (link_[i].parent != i) i = link_[i].parent;
    return i;
  }

  /// Connected parts of the link with a sign.
  int parts(int wanted) const {
    int count = 0;
    for (std::uint32_t i = 0; i < link_.size(); ++i)
      count += link_[i].parent == i && sign(link_[i].id) == wanted;
    return count;
  }

  const CutDomain<Dim>& domain_;
  const std::vector<std::int8_t>& sign_of_;
  std::vector<LinkVertex> link_;
  std::vector<std::uint32_t> place_of_;  // [vertex] in link_, if it is there
  Turns ring_;                           // 2D: along the link; 3D: along its border
  bool has_border_ = false;
};

}  // namespace ductile::meshadapt
