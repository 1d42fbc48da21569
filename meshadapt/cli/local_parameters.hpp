/// @file
/// Mmg's files of local parameters on the command line: the one given with -f or, as Mmg does,
/// NAME.mmg2d or NAME.mmg3d beside the mesh, else DEFAULT.mmg2d or DEFAULT.mmg3d.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::cli {

/// What the file says, if there is one. Warns of one that was found without being asked for, and of
/// what in it has no effect. Throws InputError. Thread safety: any thread.
std::vector<meshadapt::LocalSize> local_parameters(
    const std::optional<std::filesystem::path>& given, const meshadapt::AnyMesh& mesh,
    const meshadapt::AdaptOptions& adapt, meshadapt::Warnings& warnings);

/// Bounds the metric by local bounds and, where there are none, by those in `adapt`, which then
/// become wide enough for all. Nothing changes without local ones.
void bound_locally(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                   const std::vector<meshadapt::LocalSize>& local_sizes,
                   meshadapt::AnyField& metric, meshadapt::AdaptOptions& adapt);

}  // namespace ductile::cli
