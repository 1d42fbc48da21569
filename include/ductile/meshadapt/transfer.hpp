/// @file
/// Transfer of fields between meshes, by value or by a projection that keeps their integral: fields
/// at the vertices, which are linear in each element, and fields on the elements. All components of
/// all fields are transferred independently; functions that are linear on the whole old mesh are
/// reproduced exactly. Use adapt() for metrics, because it interpolates logarithms. origins() tells
/// which entities of an adapted mesh existed in the mesh it was made from. Results do not depend on
/// the number of threads.
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

/// A field and its mesh. It refers to both, so use it for passing arguments only.
struct FieldOnMesh {
  const AnyMesh& mesh;
  const AnyField& field;
};

/// How well the meshes cover each other. Volumes are areas in 2D.
struct TransferReport {
  std::size_t vertices_outside = 0;  ///< vertices of the new mesh that are not in the old one
  double volume_outside = 0;         ///< of the new mesh outside the old one
  double volume_left_out = 0;        ///< of the old mesh outside the new one
};

/// A field on the new mesh, and how well the meshes cover each other.
struct TransferredField {
  AnyField field;
  TransferReport report;  ///< after an interpolation, vertices only
};

/// The values of the old field, linear in each element, at the new vertices. Keeps bounds, not
/// integrals. A vertex outside the old mesh, or off a surface alone, gets the value at the closest
/// point of it; on a closed crack, that of its own side. Throws InputError if a mesh is not valid
/// (see make_fixed_mesh), a vertex of either is not within -1e150 to 1e150, or the field is not of
/// the old one. Thread safety: one caller; runs on the executor.
TransferredField interpolate_field(const runtime::Executor& executor, const FieldOnMesh& from,
                                   const AnyMesh& to);

/// The same at given points: coordinates[point * dimension + axis]. The returned field and report
/// have them in place of vertices. Also throws InputError if coordinates are not within -1e150 to
/// 1e150 or their number is no multiple of the dimension. Thread safety: one caller; runs on the
/// executor.
TransferredField interpolate_at(const runtime::Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates);

/// Options of project_field().
struct ProjectionOptions {
  /// Keeps values within those of the old elements that touch the new elements around the vertex:
  /// no overshoot at a front, and 0 to 1 stays 0 to 1. False: the plain L2 projection, a little
  /// closer to the old field.
  bool keep_bounds = true;
};

/// The piecewise linear field on the new mesh that is closest to the old one in L2, with exact
/// integrals over the intersections of old and new elements (supermesh projection: Farrell,
/// Piggott, Pain, Gorman & Wilson, Comput. Methods Appl. Mech. Eng. 198, 2009). Bounds are kept by
/// flux correction (Zalesak, J. Comput. Phys. 31, 1979) towards the lumped projection. If both
/// meshes cover the same domain, the integral of each component is kept to rounding, with or
/// without bounds. Where the new mesh extends beyond the old one, as on curved boundaries, the
/// interpolated field is used, and parts of the old mesh outside the new one are lost: the report
/// has these volumes. Throws as above, and if a value is not finite, because it would spread.
/// Thread safety: one caller; runs on the executor.
TransferredField project_field(const runtime::Executor& executor, const FieldOnMesh& from,
                               const AnyMesh& to, const ProjectionOptions& options = {});

/// How a field is transferred to another mesh.
enum class Carrying : std::uint8_t {
  /// At the vertices: interpolate_field(). On the elements: a new element gets the value of the old
  /// one that contains its centroid or is closest to it. Values of any kind stay unchanged: numbers
  /// of materials, flags.
  by_value,
  /// At the vertices: project_field(). On the elements: a new element gets the mean of the old
  /// values over its volume, by its exact overlaps with old elements. If both meshes cover the same
  /// domain, the integral of each component is kept to rounding, and no value exceeds those of the
  /// overlapped elements. The uncovered part of a new element counts with the value at its centroid
  /// as above.
  conservatively
};

/// Named fields at the vertices or on the elements of a mesh. It refers to both, so use it for
/// passing arguments only.
struct NamedFieldsOnMesh {
  const AnyMesh& mesh;
  std::span<const NamedField> fields;
};

/// Fields on the new mesh, and how well the meshes cover each other.
struct TransferredFields {
  std::vector<NamedField> fields;  ///< in the order in which they were given
  TransferReport report;  ///< vertices if there are fields on them, volumes if some are carried
                          ///< conservatively
};

/// How the values that several parts of a mesh have for one vertex are combined.
enum class Joining : std::uint8_t { sum, least, first };

/// Gives vertices that a part of a mesh shares with other parts, possibly on other machines, the
/// same values in all of them: values[vertex * stride + component] of this part come in. Sums must
/// not depend on the calling part, so that all get the same bits.
using JoinParts = std::function<void(std::span<double> values, std::size_t stride, Joining how)>;

/// Transfers fields to another mesh: all in the same way if `carrying` has one entry, otherwise
/// each in its own. Throws InputError, naming the field, unless it has a value for each entity of
/// its mesh, and finite ones if conservative; and as interpolate_field() does. With `join`, the new
/// mesh is one part of many, each of which calls this; the old one includes all that this part
/// overlaps. Integrals are then kept over all parts; each part calls join() equally often, on the
/// calling thread; and the volume left out in the report is meaningless. Thread safety: one caller;
/// runs on the executor.
TransferredFields transfer_fields(const runtime::Executor& executor, const NamedFieldsOnMesh& from,
                                  const AnyMesh& to,
                                  const std::vector<Carrying>& carrying = {Carrying::by_value},
                                  const JoinParts& join = {});

// ---- Origins ----

/// Indices into the arrays of the mesh that was adapted, or `none`.
struct Origins {
  /// [vertex] The old vertex at exactly the same position; a moved vertex is new. Among several at
  /// one position, as on a closed crack, the one on the same side.
  std::vector<VertexId> vertex;
  /// [facet] The listed facet (2D and surfaces: edge, 3D: triangle) with the same vertices. All
  /// required facets have one.
  std::vector<std::uint32_t> facet;
  /// [element] The element with the same vertices and the same reference.
  std::vector<ElementId> element;
  /// [vertex] The old element that contains it, or the closest one for a vertex outside, as on a
  /// moved curved boundary. Never none.
  std::vector<ElementId> host;
  /// [vertex * corners of an element + corner] Its barycentric weights in that element, in the
  /// order of its corners: none below 0, sum 1. Outside, those of the closest point.
  std::vector<double> weight;

  friend bool operator==(const Origins&, const Origins&) = default;
};

/// Finds where the entities of `after`, which adapt() made from `before`, come from: to copy data
/// of unchanged vertices or elements, such as unknowns, boundary data or history, and to evaluate
/// any field at the others. It compares both meshes, in one or two per cent of the time of the
/// adaptation. Does not depend on threads. Throws InputError unless both have the same dimension,
/// the first has elements with a volume (see make_fixed_mesh()), and coordinates are from -1e150 to
/// 1e150. Thread safety: one caller; runs on the executor.
Origins origins(const runtime::Executor& executor, const AnyMesh& before, const AnyMesh& after);

}  // namespace ductile::meshadapt
