/// @file
/// What fuzzers try bytes as: a mesh file of a format, a file of fields, numbers of a metric.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ductile::fuzz {

// Each aborts if a requirement is broken. There is at least one byte.
void try_mesh(std::string_view format, const std::uint8_t* bytes, std::size_t size);
void try_field(std::string_view, const std::uint8_t* bytes, std::size_t size);
void try_metric(std::string_view, const std::uint8_t* bytes, std::size_t size);

}  // namespace ductile::fuzz
