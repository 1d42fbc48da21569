/// @file
/// The metric of a mesh as a field, one symmetric tensor per vertex: from sizes or tensors of a
/// file, checked, or for users who have neither; and its tensors as those that the functions on
/// metrics work on, and back.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Sizes within these bounds can be squared, inverted and cubed without leaving the range of
/// double.
inline constexpr double smallest_size = 1e-75;
inline constexpr double largest_size = 1e75;

/// The longest size that a metric may ask for at a vertex, over the shortest.
inline constexpr double largest_anisotropy = 1e8;

/// Makes one symmetric tensor per vertex of a field that is either one scalar, the size h wanted,
/// which gives the metric 1/h^2 in every direction, or one symmetric tensor, as such or as a full
/// matrix, row by row, whose opposite components differ by at most 1e-6 of its trace. Of a field of
/// dimension 3 for a mesh that read_mesh found flat, the part in the plane is taken. Where a value
/// is no metric by itself, bounds hold before it is judged: with a largest size, one that is
/// infinite is that, and so is the size along an axis of eigenvalue 0. Other values stay as they
/// are. Throws InputError, naming the field and the vertex, unless there is a value for each
/// vertex, sizes are positive, tensors positive definite, and no size or anisotropy is beyond
/// reason. Whatever metrics this library returns or the program writes are taken. Thread safety:
/// any thread.
AnyField metric_of(const AnyField& field, const AnyMesh& mesh, const SizeBounds& bounds = {});

/// Throws InputError unless the field has the dimension of the mesh, a value for each vertex, and
/// as many components as its types say. Thread safety: any thread.
void expect_field_of(const AnyField& field, const AnyMesh& mesh);

/// The tensors [vertex] of a field of which the first component starts at `component`, by default
/// the only one. Throws InputError unless there are such, and as many values as there should be; of
/// what tensors are nothing is checked. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Metric<Dim>> tensors_of(const runtime::Executor& executor, const AnyField& field,
                                    std::size_t component = 0);

/// One symmetric field. Thread safety: one caller; runs on the executor.
template <int Dim>
AnyField symmetric_field(const runtime::Executor& executor,
                         const std::vector<Metric<Dim>>& tensor_of, const std::string& name);

extern template std::vector<Metric<2>> tensors_of<2>(const runtime::Executor&, const AnyField&,
                                                     std::size_t);
extern template std::vector<Metric<3>> tensors_of<3>(const runtime::Executor&, const AnyField&,
                                                     std::size_t);
extern template AnyField symmetric_field(const runtime::Executor&, const std::vector<Metric<2>>&,
                                         const std::string&);
extern template AnyField symmetric_field(const runtime::Executor&, const std::vector<Metric<3>>&,
                                         const std::string&);

// ---- For users without a metric ----

/// Asks for edges of this length everywhere. Throws InputError unless it is from 1e-75 to 1e75 and
/// vertices have coordinates and references. Thread safety: any thread.
AnyField constant_metric(const AnyMesh& mesh, double size);

/// Asks for edges as long as this, or as the diagonal of the box around the mesh if it is 0,
/// everywhere: for nothing but what limits on sizes ask for, see AdaptOptions::curved_sizes. Throws
/// InputError unless it is 0 or from 1e-75 to 1e75 and vertices have coordinates and references.
/// Thread safety: any thread.
AnyField coarsest_metric(const AnyMesh& mesh, double largest_size = 0);

/// What the program adapts a mesh to when no metric is given: the sizes that the mesh has, in the
/// directions in which it has them, so that stretched elements and layers stay and the number of
/// elements is about the same. At each vertex it has the shape of implied_tensors(), and in it the
/// geometric mean of the lengths of the vertex's edges is 1. Where sizes differ by less than a
/// factor of 2 between the directions, which is by chance in any isotropic mesh, it is isotropic;
/// up to a factor of 4 it is partly so. Elements need not have a volume: flat ones count for
/// nothing. A vertex without elements gets the mean size of the whole mesh. Throws InputError for
/// lengths beyond the sizes that a metric may ask for, for vertices without coordinates or
/// reference, and for elements that name others. Thread safety: one caller; runs on the executor.
AnyField default_metric(const runtime::Executor& executor, const AnyMesh& mesh);

/// Asks at each vertex for the geometric mean of the lengths of its edges, in every direction; a
/// vertex without any gets the mean of the whole mesh. Throws InputError for lengths beyond the
/// sizes that a metric may ask for, for vertices without coordinates or reference, and for elements
/// that name others. Thread safety: any thread.
AnyField implied_metric(const AnyMesh& mesh);

/// The metric that the mesh is adapted to already, stretched as it is: for each element there is
/// one in which all its edges have length 1; a vertex gets the mean of their logarithms around it,
/// weighted by volume. A vertex without elements asks for a size of 1. Throws InputError if the
/// mesh is not valid (see make_fixed_mesh). Thread safety: one caller; runs on the executor.
AnyField implied_tensors(const runtime::Executor& executor, const AnyMesh& mesh);

}  // namespace ductile::meshadapt
