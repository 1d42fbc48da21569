/// @file
/// Fields carried from one mesh to another: by value, or by a projection that keeps their integral;
/// fields at the vertices, which are linear in each element, and fields on the elements. All
/// components of all fields are carried, each for itself; what is linear on the whole
/// old mesh arrives exactly. Metrics are better carried by adapt(), which interpolates logarithms.
/// origins() tells what an adapted mesh still has of the mesh that it was made from.
/// Results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A field and the mesh that it lives on. It refers to both, so it is for passing them only.
struct FieldOnMesh {
  const AnyMesh& mesh;
  const AnyField& field;
};

/// How well the meshes cover each other. Volumes are areas in 2D.
struct TransferReport {
  std::size_t vertices_outside = 0;  ///< vertices of the new mesh that are not in the old one
  double volume_outside = 0;         ///< of the new mesh that is not in the old one
  double volume_left_out = 0;        ///< of the old mesh that is not in the new one
};

/// A field on the new mesh, and what was found on the way.
struct TransferredField {
  AnyField field;
  TransferReport report;  ///< of an interpolation, vertices only
};

/// The values that the old field, linear in each element, has at the new vertices. Keeps bounds,
/// not integrals. A vertex outside the old mesh gets the value at the point of it that is closest;
/// on a closed crack, that of its own side. Throws InputError if a mesh is not valid (see
/// make_fixed_mesh), a vertex of either is not within -1e150 to 1e150, or the field is not of the
/// old one. Thread safety: one caller; runs on the executor.
TransferredField interpolate_field(const runtime::Executor& executor, const FieldOnMesh& from,
                                   const AnyMesh& to);

/// The same at points of one's own choice, one after another: coordinates[point * dimension +
/// axis]. The field that is returned has them in place of vertices, and so does the report. Throws
/// InputError as well if coordinates are not within -1e150 to 1e150 or do not come in whole points.
/// Thread safety: one caller; runs on the executor.
TransferredField interpolate_at(const runtime::Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates);

/// How project_field() works.
struct ProjectionOptions {
  /// No value above or below those of the old elements that touch the new elements around the
  /// vertex, so no overshoot at a front, and 0 to 1 stays 0 to 1. False: the L2 projection as it
  /// is, a little closer to the old field.
  bool keep_bounds = true;
};

/// The linear elements on the new mesh that are closest to the old field in L2, with the integrals
/// over old and new elements cut by each other taken exactly (supermesh projection: Farrell,
/// Piggott, Pain, Gorman & Wilson, Comput. Methods Appl. Mech. Eng. 198, 2009). Bounds are kept by
/// flux correction (Zalesak, J. Comput. Phys. 31, 1979) towards the lumped projection. Where both
/// meshes cover the same domain, the integral of each component is kept to rounding, with or
/// without bounds. Where the new mesh reaches beyond the old one, as on curved boundaries, the
/// interpolated field counts there, and what lies beyond the new mesh is lost: the report says how
/// much volume that concerns. Throws as above, and if a value is not finite, because it would
/// spread. Thread safety: one caller; runs on the executor.
TransferredField project_field(const runtime::Executor& executor, const FieldOnMesh& from,
                               const AnyMesh& to, const ProjectionOptions& options = {});

/// How a field gets to another mesh.
enum class Carrying : std::uint8_t {
  /// At the vertices: interpolate_field(). On the elements: a new element gets the value of the old
  /// one in which its centroid lies, or which is closest to it. Values of any kind stay what they
  /// are: numbers of materials, flags.
  by_value,
  /// At the vertices: project_field(). On the elements: a new element gets the mean of the old
  /// values over its volume, by the exact volumes that it shares with old elements. Where both
  /// meshes cover the same domain, the integral of each component is kept to rounding, and no value
  /// is beyond those of the old elements that it overlaps. The part of a new element that no old
  /// one
  /// covers counts with the value at its centroid as above.
  conservatively
};

/// Fields by name, at the vertices or on the elements of the mesh that they live on. It refers to
/// both, so it is for passing them only.
struct NamedFieldsOnMesh {
  const AnyMesh& mesh;
  std::span<const NamedField> fields;
};

/// Fields on the new mesh, and what was found on the way.
struct TransferredFields {
  std::vector<NamedField> fields;  ///< in the order in which they were given
  TransferReport report;  ///< vertices if there are fields on them, volumes if some are carried
                          ///< conservatively
};

/// How values that several parts of a mesh have for one vertex become one.
enum class Joining : std::uint8_t { sum, least, first };

/// Gives vertices that a part of a mesh shares with other parts, on other machines it may be, the
/// same values in all of them: values[vertex * stride + component] of this part come in. Sums must
/// not depend on which part asks, so that all have the same bits.
using JoinParts = std::function<void(std::span<double> values, std::size_t stride, Joining how)>;

/// Carries fields to another mesh: all in the same way, if `carrying` has one entry, or each in its
/// own. Throws InputError, naming the field, unless it has a value for each entity of its mesh, and
/// conservatively only finite ones; and as interpolate_field() does.
/// With `join`, the new mesh is one part of many, each of which calls this; the old one has all
/// that this part overlaps. Then integrals are kept over all parts, join() is called as many times,
/// on the calling thread, in each of them, and what the report says was left out means nothing.
/// Thread safety: one caller; runs on the executor.
TransferredFields transfer_fields(const runtime::Executor& executor, const NamedFieldsOnMesh& from,
                                  const AnyMesh& to,
                                  const std::vector<Carrying>& carrying = {Carrying::by_value},
                                  const JoinParts& join = {});

// ---- What is still there ----

/// Indices into the arrays of the mesh that was adapted, or `none`.
struct Origins {
  /// [vertex] The vertex that is at exactly the same place. One that has moved is a new one. Of
  /// several at one place, as on both sides of a closed crack, the one on the same side.
  std::vector<VertexId> vertex;
  /// [facet] The listed facet, of edges in 2D, of triangles in 3D, that has the same vertices. All
  /// required facets have one.
  std::vector<std::uint32_t> facet;
  /// [element] The element that has the same vertices and the same reference.
  std::vector<ElementId> element;
  /// [vertex] The element in which it lies; of one outside, as on a curved boundary that has moved,
  /// the closest. Never none.
  std::vector<ElementId> host;
  /// [vertex * (dimension + 1) + corner] Its barycentric weights in there, of the corners in their
  /// order in the arrays: none below 0, and they add up to 1. Outside, those of the closest point.
  std::vector<double> weight;

  friend bool operator==(const Origins&, const Origins&) = default;
};

/// To copy what belongs to vertices or elements that are as they were, such as unknowns, boundary
/// data or history, and to evaluate any kind of field at the others. Where `after`, which adapt()
/// made of `before`, comes from. It is found by looking at both meshes, which takes one or two
/// percent of the time of the adaptation. Does not depend on threads. Throws InputError unless both
/// are meshes of one dimension, the first with elements that have a volume (see make_fixed_mesh()),
/// with coordinates from -1e150 to 1e150. Thread safety: one caller; runs on the executor.
Origins origins(const runtime::Executor& executor, const AnyMesh& before, const AnyMesh& after);

}  // namespace ductile::meshadapt
