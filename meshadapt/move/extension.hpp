/// @file
/// Extension<Dim>: displacements of free vertices from those of others: a harmonic problem in which
/// small elements are stiff, solved by conjugate gradients.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "move/walls.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Extension {
 public:
  using Field = std::vector<Vector<Dim>>;

  /// Of the mesh as it lies at these positions. `walls` is referred to.
  Extension(const runtime::Executor& executor, const FixedMesh<Dim>& mesh, const Field& position_of,
            const std::vector<std::uint8_t>& is_free, const Walls<Dim>& walls);

  /// Changes the displacements [vertex] of free vertices, which are a first guess.
  void solve(Field& displacement_of) const;

 private:
  struct Entry {
    std::uint32_t place;  // a free vertex by its place among them, or a vertex given
    double weight;
  };
  /// Of conjugate gradients, [place].
  struct Iterate {
    Field value, rest, direction, product;
  };

  void add_row(const FixedMesh<Dim>& mesh, const Field& position_of, VertexId v,
               std::vector<Entry>& row) const;
  /// What displacements of others ask for, [place].
  Field demands(const Field& displacement_of) const;
  /// Row i of the matrix times x, without what walls take.
  Vector<Dim> product(std::size_t i, const Field& x) const;
  /// The sum of a[i] . b[i] / diagonal[i].
  double weighted(const Field& a, const Field& b) const;
  /// Returns the new size of the rest.
  double iterate(Iterate& now, double size) const;

  const runtime::Executor& executor_;
  const Walls<Dim>& walls_;
  std::vector<VertexId> free_;                            // [place]
  std::vector<std::size_t> first_, first_given_;          // [place], and the end
  runtime::UnsetVector<Entry> free_entry_, given_entry_;  // negative weights, by row
  std::vector<double> diagonal_, inverse_;                // [place]
};

extern template class Extension<2>;
extern template class Extension<3>;

}  // namespace ductile::meshadapt
