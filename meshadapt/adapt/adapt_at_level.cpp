/// @file
/// adapt_in() at a processor level, with all that it calls.
#include "adapt/outer_loop.hpp"
#include "adapt/processor_level.hpp"

#ifndef DUCTILE_LEVEL  // which is only given where this is compiled once more
#define DUCTILE_LEVEL as_built
#endif

namespace ductile::meshadapt {

template <ProcessorLevel level>
AdaptedMesh adapt_at_level(const runtime::Executor& executor, const AnyMesh& mesh,
                           MetricSource& source, const AdaptOptions& options) {
  AdaptedMesh result = mesh.dimension == 2 ? adapt_in<2>(executor, mesh, source, options)
                                           : adapt_in<3>(executor, mesh, source, options);
  result.report.instructions = name_of(level);
  return result;
}

template AdaptedMesh adapt_at_level<ProcessorLevel::DUCTILE_LEVEL>(const runtime::Executor&,
                                                                   const AnyMesh&, MetricSource&,
                                                                   const AdaptOptions&);

}  // namespace ductile::meshadapt
