/// @file
/// Discs<Dim>: decides whether the surface may go through a vertex. It may if it is then one disc
/// (2D: one line) around the vertex, in each split material around it, and half a disc at the
/// material's border. Moving the surface from one side of the vertex onto it then deforms it
/// without changing its topology: before, it was a disc with the same rim.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
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
  Discs(const CutDomain<Dim>& domain, const std::vector<std::int8_t>& sign_of);

  /// May the surface go through this vertex?
  bool at(VertexId vertex);

 private:
  /// A vertex of the link: the facets opposite `vertex` of the elements around it.
  struct LinkVertex {
    VertexId id;
    std::uint32_t parent;  // of those with the same sign
    bool on_border;
    Turns around;  // 3D: along its own neighbours in the link
  };

  bool in_material(VertexId vertex, std::uint32_t material);
  void add_link(const std::array<VertexId, 2>& edge);
  void add_link(const std::array<VertexId, 3>& triangle);
  void add_border(const std::array<VertexId, 1>& end);
  void add_border(const std::array<VertexId, 2>& edge);
  bool is_disc() const;

  int sign(VertexId vertex) const { return sign_of_[vertex]; }
  LinkVertex& link(VertexId vertex);
  std::uint32_t root(std::uint32_t i) const;
  int parts(int sign) const;

  const CutDomain<Dim>& domain_;
  const std::vector<std::int8_t>& sign_of_;
  std::vector<std::uint32_t> materials_;  // around the vertex
  std::vector<LinkVertex> link_;
  std::vector<std::uint32_t> place_of_;  // [vertex] in link_, if it is there
  Turns ring_;                           // 2D: along the link; 3D: along its border
  bool has_border_ = false;
};

extern template class Discs<2>;
extern template class Discs<3>;

}  // namespace ductile::meshadapt
