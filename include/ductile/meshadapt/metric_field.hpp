/// @file
/// A field of a file as the metric of a mesh: sizes or tensors at its vertices, checked; and the
/// tensors of a field as those that the functions on metrics work on, and back.
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

}  // namespace ductile::meshadapt
