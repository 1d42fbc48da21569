/// @file
/// Paths<Dim>: where the vertices that have a displacement are at each share of the way. Connected
/// ones that move rigidly turn on the way; others go straight.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/move.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// A turn by `angle` about an axis through `pivot`, which moves by `shift`.
template <int Dim>
struct RigidMotion {
  Vector<Dim> pivot, shift;
  double angle = 0;
  Vector<3> axis{{0, 0, 1}};

  Vector<Dim> moved(const Vector<Dim>& point, double share) const;
};

/// The rigid motion that takes `from` to `to` best in the sense of least squares, chosen as move()
/// says. There is at least one point, and as many of both.
template <int Dim>
RigidMotion<Dim> closest_motion(const std::vector<Vector<Dim>>& from,
                                const std::vector<Vector<Dim>>& to);

template <int Dim>
class Paths {
 public:
  /// Throws InputError for a reference of the options that nothing in the mesh has.
  Paths(const runtime::Executor& executor, const AnyMesh& mesh, const FixedMesh<Dim>& topology,
        const std::vector<Vector<Dim>>& displacement_of, const MoveOptions& options);

  /// [vertex of the input] The number of its path, or none.
  const std::vector<std::uint32_t>& path_of() const { return path_of_; }
  /// [element of the input] The number of its body from 1 on, or 0.
  const std::vector<std::uint32_t>& body_of() const { return body_of_; }

  bool is_rigid(std::uint32_t body) const { return parts_[body - 1].is_rigid; }
  Vector<Dim> at(std::uint32_t path, double share) const;

  /// A share of the way on which nothing turns by more than 45 degrees.
  double first_stride() const;

  /// Is a vertex near enough to something that moves to follow it? `share` is the present one, and
  /// the one to go to.
  std::vector<std::uint8_t> within_reach(const runtime::Executor& executor,
                                         const std::vector<Vector<Dim>>& position_of, double share,
                                         double next) const;

 private:
  struct Part {  // connected vertices
    std::vector<std::uint32_t> paths;
    bool is_rigid = false, moves = false;
    double margin = 0;  // a few times its longest edge
    RigidMotion<Dim> motion;
  };

  /// Marks the vertices that have a displacement, and sets body_of_ to 1 in bodies.
  std::vector<std::uint8_t> choose_named(const AnyMesh& mesh, const MoveOptions& options);
  std::vector<std::uint8_t> choose_displaced(const runtime::Executor& executor, const AnyMesh& mesh,
                                             const FixedMesh<Dim>& topology,
                                             const std::vector<Vector<Dim>>& displacement_of);
  void connect(const runtime::Executor& executor, const AnyMesh& mesh,
               const FixedMesh<Dim>& topology, const std::vector<std::uint8_t>& chosen);
  void fit(Part& part);

  std::vector<std::uint32_t> path_of_, body_of_;
  std::vector<Vector<Dim>> start_, end_;  // [path]
  std::vector<Vector<Dim>> rest_;         // [path], end minus where the rigid motion leads
  std::vector<std::uint32_t> part_of_;    // [path]
  std::vector<Part> parts_;               // [body - 1]
};

extern template struct RigidMotion<2>;
extern template struct RigidMotion<3>;
extern template RigidMotion<2> closest_motion(const std::vector<Vector<2>>&,
                                              const std::vector<Vector<2>>&);
extern template RigidMotion<3> closest_motion(const std::vector<Vector<3>>&,
                                              const std::vector<Vector<3>>&);
extern template class Paths<2>;
extern template class Paths<3>;

}  // namespace ductile::meshadapt
