/// @file
/// The metric of a mesh as a field, one symmetric tensor per vertex: made from sizes or tensors of
/// a file, with checks, or without any; and conversion to and from the tensors that functions on
/// metrics use.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Sizes within these bounds can be squared, inverted and cubed within the range of double.
inline constexpr double smallest_size = 1e-75;
inline constexpr double largest_size = 1e75;

/// Largest ratio of the sizes that a metric may ask for at a vertex.
inline constexpr double largest_anisotropy = 1e8;

/// Makes one symmetric tensor per vertex from a field of one scalar, the wanted size h, which gives
/// the metric 1/h^2 in every direction; of one symmetric tensor; or of one full matrix, row by row,
/// whose opposite components differ by at most 1e-6 of its trace. For a mesh that read_mesh found
/// flat, takes the in-plane part of a field of dimension 3. Where a value is not a metric by
/// itself, bounds are applied before it is validated: a largest size replaces infinite sizes, and
/// the size along an axis of eigenvalue 0. Other values stay unchanged. Throws InputError, naming
/// the field and the vertex, unless there is a value for each vertex, sizes are positive, tensors
/// positive definite, and sizes and anisotropy within the limits above. Accepts every metric that
/// this library returns or the program writes. Thread safety: any thread.
AnyField metric_of(const AnyField& field, const AnyMesh& mesh, const SizeBounds& bounds = {});

/// Throws InputError unless the field has the dimension of the mesh, a value for each vertex, and
/// as many components as its types say. Thread safety: any thread.
void expect_field_of(const AnyField& field, const AnyMesh& mesh);

/// The tensors [vertex] of a field, from the component with index `component` on; by default its
/// only field. Throws InputError unless they and the right number of values exist; the tensors
/// themselves are not checked. Thread safety: one caller; runs on the executor.
template <int Dim>
std::vector<Metric<Dim>> tensors_of(const runtime::Executor& executor, const AnyField& field,
                                    std::size_t component = 0);

/// Makes a field of one symmetric tensor. Thread safety: one caller; runs on the executor.
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

// ---- Without a metric from the user ----

/// Asks for edges of this length everywhere. Throws InputError unless it is from 1e-75 to 1e75 and
/// vertices have coordinates and references. Thread safety: any thread.
AnyField constant_metric(const AnyMesh& mesh, double size);

/// Asks everywhere for edges of this length, or of the diagonal of the mesh's bounding box if it is
/// 0: only limits on sizes then matter, see AdaptOptions::curved_sizes. Throws InputError unless it
/// is 0 or from 1e-75 to 1e75 and vertices have coordinates and references. Thread safety: any
/// thread.
AnyField coarsest_metric(const AnyMesh& mesh, double largest_size = 0);

/// The program's metric if none is given: the sizes that the mesh has, by direction, so that
/// stretched elements and layers stay and the number of elements is about the same. At each vertex
/// it has the shape of implied_tensors(), scaled so that the geometric mean of the lengths of the
/// vertex's edges is 1. A stretch below a factor of 2, as occurs by chance in isotropic meshes, is
/// removed; up to a factor of 4 it is faded in. Flat elements are allowed and ignored. A vertex
/// without elements gets the mean size of the mesh. Throws InputError for lengths beyond the sizes
/// that a metric may ask for, for vertices without coordinates or reference, and for elements that
/// name others. Thread safety: one caller; runs on the executor.
AnyField default_metric(const runtime::Executor& executor, const AnyMesh& mesh);

/// Asks at each vertex for the geometric mean of the lengths of its edges, in every direction; a
/// vertex without any gets the mean of the whole mesh. Throws InputError for lengths beyond the
/// sizes that a metric may ask for, for vertices without coordinates or reference, and for elements
/// that name others. Thread safety: any thread.
AnyField implied_metric(const AnyMesh& mesh);

/// The metric that the mesh already has, including its stretch: for each element there is one in
/// which all its edges have length 1; a vertex gets the mean of their logarithms around it,
/// weighted by volume. A vertex without elements asks for a size of 1. Throws InputError if the
/// mesh is not valid (see make_fixed_mesh). Thread safety: one caller; runs on the executor.
AnyField implied_tensors(const runtime::Executor& executor, const AnyMesh& mesh);

}  // namespace ductile::meshadapt
