/// @file
/// Extension<Dim>: displacements of free vertices from those of others: a harmonic problem in which
/// small elements are stiff, solved by preconditioned conjugate gradients.
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
  using Field = std::vector<Vector<Dim>>;  // [vertex]

  /// The problem on the mesh with its vertices at these positions. `walls` is referred to.
  Extension(const runtime::Executor& executor, const FixedMesh<Dim>& mesh, const Field& position_of,
            const std::vector<std::uint8_t>& is_free, const Walls<Dim>& walls);

  /// Changes the displacements of free vertices, which are a first guess.
  void solve(Field& displacement_of) const;

 private:
  struct Entry {
    VertexId vertex;
    double weight;  // negative
  };

  void add_row(const FixedMesh<Dim>& mesh, const Field& position_of, VertexId v,
               std::vector<Entry>& row) const;
  void factorise();
  /// Row i of the matrix times x.
  Vector<Dim> product(std::size_t i, const Field& x) const;
  void precondition(const Field& rest, Field& result) const;
  /// Calls term(i, free_[i]) for all rows i and sums the results in a fixed order.
  double sum(auto&& term) const;

  const runtime::Executor& executor_;
  const Walls<Dim>& walls_;
  std::vector<VertexId> free_;         // [row]
  std::vector<std::size_t> first_;     // [row], and the end
  runtime::UnsetVector<Entry> entry_;  // off the diagonal; ascending in each row
  std::vector<double> diagonal_;       // [row]
  std::vector<double> pivot_of_;       // [vertex], inverse; 0 if it is not free
};

extern template class Extension<2>;
extern template class Extension<3>;

}  // namespace ductile::meshadapt
