/// @file
/// What `ductile adapt` and `ductile info` tell programs, as JSON: one object and a line end.
/// Numbers read back the same; null stands for what is not finite or was not measured. Bytes of
/// names that are no UTF-8 are told as files.hpp says.
#pragma once

#include <optional>
#include <string>

#include "adapt_report.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/statistics.hpp"

namespace ductile::cli {

std::string to_json(const AdaptSummary& summary);

/// Of one mesh. `valid`: whether it can be adapted.
std::string to_json(const meshadapt::AnyMesh& mesh, bool valid,
                    const std::optional<meshadapt::MeshStatistics>& statistics);

}  // namespace ductile::cli
