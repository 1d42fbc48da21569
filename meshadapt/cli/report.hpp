/// @file
/// Statistics as text for people.
#pragma once

#include <string>

#include "ductile/meshadapt/statistics.hpp"

namespace ductile::cli {

/// Several lines: figures and a histogram, each line indented by two blanks.
std::string to_text(const meshadapt::MeshStatistics& statistics);

}  // namespace ductile::cli
