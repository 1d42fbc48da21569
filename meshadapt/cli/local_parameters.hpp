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

/// The file, if there is one.
std::optional<std::filesystem::path> parameter_file(
    const std::optional<std::filesystem::path>& given, const meshadapt::AnyMesh& mesh);

/// The sizes in the file, if there is one. Warns of a file that was found without -f, and of
/// parameters without effect. Throws InputError. Thread safety: any thread.
std::vector<meshadapt::LocalSize> local_parameters(
    const std::optional<std::filesystem::path>& given, const meshadapt::AnyMesh& mesh,
    const meshadapt::AdaptOptions& adapt, meshadapt::Warnings& warnings);

/// Bounds the metric by local bounds and elsewhere by those in `adapt`, which are then widened to
/// include all. Without local bounds nothing changes.
void bound_locally(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                   const std::vector<meshadapt::LocalSize>& local_sizes,
                   meshadapt::AnyField& metric, meshadapt::AdaptOptions& adapt);

}  // namespace ductile::cli
