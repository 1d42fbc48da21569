/// @file
/// Statistics as text for people and as JSON for programs.
#pragma once

#include <string>

#include "ductile/meshadapt/statistics.hpp"

namespace ductile::cli {

/// Several lines: figures and a histogram, each line indented by two blanks.
std::string to_text(const meshadapt::MeshStatistics& statistics);

/// A JSON object.
std::string to_json(const meshadapt::MeshStatistics& statistics);

/// A JSON string with its quotes.
std::string json_string(const std::string& text);

/// A number as JSON has it, the shortest that reads back the same; null if it is not finite.
std::string json_number(double number);

}  // namespace ductile::cli
