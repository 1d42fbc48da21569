/// @file
/// Paths<Dim>: where the vertices that have a displacement are at each share of the way. Connected
/// ones that move rigidly turn on the way; others go straight.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/move.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "move/rigid_motion.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Paths {
 public:
  /// Throws InputError for a reference of the options that nothing in the mesh has.
  Paths(const runtime::Executor& executor, const AnyMesh& mesh, const FixedMesh<Dim>& topology,
        const std::vector<Vector<Dim>>& displacement_of, const MoveOptions& options);

  /// [vertex of the input] The number of its path, or none.
  const std::vector<std::uint32_t>& path_of() const { return path_of_; }
  /// [element of the input] Does it belong to a body that moves rigidly?
  std::vector<std::uint8_t> rigid_elements(const FixedMesh<Dim>& topology) const;

  Vector<Dim> at(std::uint32_t path, double share) const;
  /// The rotation of a body between two shares of the way; none if it deforms.
  std::optional<Rotation<Dim>> rotation(std::uint32_t path, double share, double next) const;

  /// A share of the way on which nothing turns by more than 45 degrees.
  double first_stride() const;

  /// Is a vertex near enough to something that moves to follow it? `share` is the present one, and
  /// the one to go to.
  std::vector<std::uint8_t> within_reach(const runtime::Executor& executor,
                                         const std::vector<Vector<Dim>>& position_of, double share,
                                         double next) const;

 private:
  struct Body {  // connected vertices
    std::vector<std::uint32_t> paths;
    bool is_rigid = false, moves = false;
    double margin = 0;  // a few times its longest edge
    RigidMotion<Dim> motion;
  };

  /// Both mark the vertices that have a displacement, and elements in in_body_.
  std::vector<std::uint8_t> choose_named(const AnyMesh& mesh, const MoveOptions& options);
  std::vector<std::uint8_t> choose_displaced(const runtime::Executor& executor, const AnyMesh& mesh,
                                             const FixedMesh<Dim>& topology,
                                             const std::vector<Vector<Dim>>& displacement_of);
  void connect(const runtime::Executor& executor, const AnyMesh& mesh,
               const FixedMesh<Dim>& topology, const std::vector<std::uint8_t>& chosen);
  void fit(Body& body);

  std::vector<std::uint32_t> path_of_;
  std::vector<std::uint8_t> in_body_;     // [element]
  std::vector<Vector<Dim>> start_, end_;  // [path]
  std::vector<Vector<Dim>> rest_;         // [path], end minus where the rigid motion leads
  std::vector<std::uint32_t> body_of_;    // [path]
  std::vector<Body> bodies_;
};

extern template class Paths<2>;
extern template class Paths<3>;

}  // namespace ductile::meshadapt
