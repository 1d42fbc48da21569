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
    VertexId vertex;
    double weight;
  };

  void add_row(const FixedMesh<Dim>& mesh, const Field& position_of, VertexId v,
               std::vector<Entry>& row) const;
  /// K x at free vertex i, without what walls take.
  Vector<Dim> product(std::size_t i, const Field& x) const;
  double sum(auto&& term) const;

  const runtime::Executor& executor_;
  const Walls<Dim>& walls_;
  std::vector<VertexId> free_;
  std::vector<std::size_t> first_;     // [free], and the end
  runtime::UnsetVector<Entry> entry_;  // neighbours, with negative weights off the diagonal
  std::vector<double> diagonal_;       // [free]
};

extern template class Extension<2>;
extern template class Extension<3>;

}  // namespace ductile::meshadapt
