/// @file
/// QuadraticBlend<Dim>: evaluates a LevelSetFunction, and finds the closest points of its zero.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/box.hpp"
#include "transfer/locator.hpp"

namespace ductile::meshadapt {

template <int Dim>
class QuadraticBlend {
 public:
  /// Takes the mesh, and a finite value for each vertex. Runs on the executor.
  QuadraticBlend(const runtime::Executor& executor, FixedMesh<Dim> mesh,
                 std::vector<double> value_of);
  QuadraticBlend(const QuadraticBlend&) = delete;
  QuadraticBlend& operator=(const QuadraticBlend&) = delete;

  struct Sample {
    double value;
    Vector<Dim> gradient;
    ElementId element;  ///< that contains the point, or is the closest
  };
  /// The search starts at element `near`, or at one that only depends on the point if that is none.
  /// Thread safety of all: any thread.
  Sample at(const Vector<Dim>& point, ElementId near) const;

  /// The closest point of the zero, nearly; nothing if none is found within a distance.
  std::optional<Vector<Dim>> closest(const Vector<Dim>& point, double within) const;

  /// The tensor that asks for chords of the level set through a point no farther than a distance
  /// from it: k h^2 / 8 for one of length h, k its curvature in that direction; across it as in the
  /// direction that bends most. Not shorter than four distances; 0 where the function has a kink.
  Metric<Dim> chords(const Vector<Dim>& point, double distance) const;

 private:
  bool is_near_zero(VertexId vertex) const;
  void set_starts(const runtime::Executor& executor);
  ElementId start_near(const Vector<Dim>& point) const;

  FixedMesh<Dim> mesh_;
  std::vector<double> value_of_;          // [vertex]
  std::vector<Vector<Dim>> gradient_of_;  // [vertex]
  Locator<Dim> locator_;
  // ---- A grid over the mesh, so that walks to points are short ----
  Box<Dim> box_;
  std::array<std::size_t, Dim> cells_;  // along each axis
  std::vector<ElementId> start_of_;     // [cell], the element at its centre
};

extern template class QuadraticBlend<2>;
extern template class QuadraticBlend<3>;

}  // namespace ductile::meshadapt
