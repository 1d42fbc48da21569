/// @file
/// ProcessorLevel: which instructions adapt() may use. The library may hold it several times, see
/// cmake/DuctileLevels.cmake: as it is built, for all processors of its kind, and once for each
/// level of those that can do more. All give the same bytes: what differs is how many numbers an
/// instruction takes, never how they are rounded.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"

namespace ductile::meshadapt {

/// v3 and v4 are those of x86-64, as its psABI numbers them: with AVX2, and with AVX-512.
enum class ProcessorLevel : std::uint8_t { as_built, v3, v4 };

std::string_view name_of(ProcessorLevel level);

/// The levels that the library has and this processor can run, best first; as_built is the last.
/// Thread safety: any thread.
std::vector<ProcessorLevel> usable_levels();

/// adapt_in() at one of the usable levels.
AdaptedMesh adapt_at(ProcessorLevel level, const runtime::Executor& executor, const AnyMesh& mesh,
                     MetricSource& source, const AdaptOptions& options);

/// The same, where all that it calls is compiled for the level.
template <ProcessorLevel level>
AdaptedMesh adapt_at_level(const runtime::Executor& executor, const AnyMesh& mesh,
                           MetricSource& source, const AdaptOptions& options);

}  // namespace ductile::meshadapt
