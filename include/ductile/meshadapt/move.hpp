/// @file
/// move: moves bodies and boundaries of a mesh by displacements, and the rest of the mesh with
/// them. The mesh stays valid: where elements would become too bad it is adapted, near there only.
/// Fields and the metric go along.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Options of move(). It refers to the metric and the fields, so use it for passing arguments only.
struct MoveOptions {
  /// What has a displacement: all elements with these references, and all listed facets (2D: edges,
  /// 3D: triangles) with those. Displacements elsewhere are ignored. If both are empty,
  /// displacements decide: every vertex whose displacement is not zero moves by it, and so does
  /// every region (connected elements of one reference) that has such a vertex inside.
  std::vector<std::int32_t> bodies = {};
  std::vector<std::int32_t> boundaries = {};  ///< see bodies

  /// Elements that get worse than this are improved by adaptation; quality as in quality.hpp, in
  /// the metric. 0: 0.35 in 2D, 0.2 in 3D
  double remesh_below = 0;
  /// A step ends before an element gets worse than this, or than 0.6 times its quality at first, or
  /// when adaptation made it, if that is less. 0: 0.1 in 2D, 0.08 in 3D
  double keep_above = 0;
  bool remeshes = true;   ///< false: only moves vertices, as far as that goes
  bool insert = true;     ///< false: adaptations swap and smooth, but neither split nor collapse
  int most_steps = 1000;  ///< after which move() gives up
  /// Returns the mesh of the place where the motion had to stop, see MoveReport::stopped. False:
  /// throws Error.
  bool keep_partial = false;

  /// One symmetric tensor at each vertex: the sizes to adapt to. Vertices take them along: tensors
  /// turn with the mesh, so that thin elements stay along the body, and sizes do not change. Null:
  /// those that the mesh has, alike in all directions, see implied_metric()
  const AnyField* metric = nullptr;
  double smallest_size = 0, largest_size = 0, gradation = 0;  ///< see AdaptOptions
  bool complete_boundary = false;                             ///< see MakeMeshOptions

  /// Fields that go along, see move().
  std::span<const NamedField> fields = {};
  /// How: one entry for all fields, or one for each.
  std::vector<Carrying> carrying = {Carrying::by_value};
  /// Names of the vector and tensor fields that turn with the mesh, such as the direction of fibres
  /// in a material. All other fields, such as velocities, keep their values.
  std::vector<std::string> turned = {};
};

/// Statistics of a run of move().
struct MoveReport {
  double share = 0;  ///< of the path that was gone, from 0 to 1
  int steps = 0, adaptations = 0;
  std::size_t adapted_elements = 0;  ///< sum over all adaptations of the elements that came in
  double worst_quality = 0;          ///< of the moved mesh, in the metric
  double adapt_seconds = 0, total_seconds = 0;
  std::string stopped;  ///< why the end was not reached; empty if it was
  std::vector<std::string> warnings;
};

/// The moved mesh, and what went along.
struct MovedMesh {
  AnyMesh mesh;
  AnyField metric;  ///< one symmetric field
  std::vector<NamedField> fields;
  /// Where the entities come from in the input. A vertex that adaptations have made or moved has
  /// the place of the input that would be where it is now, by interpolation in each adaptation.
  Origins origins;
  MoveReport report;
};

/// Moves `mesh` by one vector at each vertex. Bodies are connected parts of what has a
/// displacement. A body whose displacement is a rigid motion, up to 1e-3 of its largest
/// displacement, turns on its way, by at most 180 degrees: about its centre of rotation if that is
/// within the body's radius, otherwise about its centroid, which goes straight. Vertices of other
/// bodies go straight. Vertices near moving bodies follow by a harmonic extension, in which small
/// elements are stiff; on flat boundaries and interfaces they slide. All others stay.
///
/// At the end, vertices of bodies on boundaries and interfaces are where the displacement takes
/// them, bit for bit, and their facets are the same; rigid bodies also keep their elements. Other
/// boundaries and interfaces stay as adapt() keeps them. Elements that were not adapted keep their
/// order, and vertices that do not move keep their bits. Interfaces that the mesh does not list get
/// reference 0.
///
/// Fields go with the mesh: where it is not adapted, vertices and elements keep their values, or,
/// with Carrying::conservatively, their content (value times volume); for adapted parts see
/// transfer_fields(). Integrals over the whole mesh are then kept to rounding.
///
/// The result does not depend on the number of threads. Throws InputError for an invalid mesh,
/// displacement, metric, field or option, and for references that nothing has; Error if the path
/// cannot be gone to its end. Thread safety: one caller; runs on the executor.
MovedMesh move(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& displacement,
               const MoveOptions& options = {});

}  // namespace ductile::meshadapt
