/// @file
/// adapt_in: the one loop that starts phases again: for the next metric of a source, with less
/// effort where the input was better, or to keep more of the boundary where the result is not
/// right.
#pragma once

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

/// adapt() with options and an input of valid coordinates, and a source that gives valid metrics.
template <int Dim, int Space = Dim>
AdaptedMesh adapt_in(const runtime::Executor& executor, const AnyMesh& input, MetricSource& source,
                     const AdaptOptions& options);

extern template AdaptedMesh adapt_in<2>(const runtime::Executor&, const AnyMesh&, MetricSource&,
                                        const AdaptOptions&);
extern template AdaptedMesh adapt_in<2, 3>(const runtime::Executor&, const AnyMesh&, MetricSource&,
                                           const AdaptOptions&);
extern template AdaptedMesh adapt_in<3>(const runtime::Executor&, const AnyMesh&, MetricSource&,
                                        const AdaptOptions&);

}  // namespace ductile::meshadapt
