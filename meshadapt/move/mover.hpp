/// @file
/// Mover<Dim>: goes the way of move() in steps as large as elements allow, and adapts the mesh
/// where they have become bad.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/move.hpp"
#include "move/cargo.hpp"
#include "move/moving_mesh.hpp"
#include "move/paths.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Mover {
 public:
  Mover(const runtime::Executor& executor, AnyMesh mesh, const AnyField& displacement,
        const MoveOptions& options);
  MovedMesh run();
  /// The places of the input that the vertices of the moved mesh were at, as AnyMesh::coordinates.
  std::vector<double> starts() const;

 private:
  using Marks = std::vector<std::uint8_t>;  // [element]
  using Field = std::vector<Vector<Dim>>;   // [vertex]

  bool is_done() const { return share_ == 1; }
  /// Finds the neighbours anew, and measures.
  void connect();
  FixedMesh<Dim> topology_now();

  /// Goes on as far as possible, at most by stride_. Marks the elements that prevented more; there
  /// are none of them if nothing did. Returns false if it could not go at all.
  bool step(Marks& blocking);
  /// Moves by these displacements to this share; marks elements that get too bad, and returns their
  /// number.
  std::size_t attempt(double share, const Field& move_of, Marks& blocking);
  void go_to(double share, const Field& move_of);
  LinearMap<Dim> deformation_of(std::span<const ElementId> elements) const;
  std::optional<Rotation<Dim>> rotation_of_body(VertexId v, double share) const;
  void turn_fields(double share);

  void mark_bad(Marks& marks) const;
  /// Adds so many layers of elements around marked ones, and takes out what may not change.
  void grow(Marks& marks, int layers) const;
  /// Adapts what is marked, and so many layers around. Returns false, and changes nothing, if that
  /// is nothing, or the worst quality does not become more than `least_gain` times as good.
  bool adapt_part(Marks marks, int layers, double least_gain);
  std::string place_of_first(const Marks& marks) const;
  MovedMesh finish();

  const runtime::Executor& executor_;
  const MoveOptions& options_;
  const double remesh_below_, keep_above_;
  MovingMesh<Dim> mesh_;
  FixedMesh<Dim> topology_;  // with positions and volumes as of the last connect()
  Paths<Dim> paths_;
  Cargo<Dim> cargo_;
  std::vector<Site<Dim>> next_site_of_;  // [vertex], of the last attempt
  std::vector<double> next_quality_of_;  // [element], likewise
  double share_ = 0, stride_ = 1;
  MoveReport report_;
};

extern template class Mover<2>;
extern template class Mover<3>;

}  // namespace ductile::meshadapt
