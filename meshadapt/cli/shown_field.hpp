/// @file
/// Finds the field that a picture shows by a word such as "pressure", "2" or "velocity:1".
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::cli {

/// The field with this name, otherwise the one with this number, from 1, as scalars: the norm of
/// vectors and tensors or, with ":K" after the name or number, their component K, from 1. Throws
/// UsageError if `where` has no such field.
NamedField shown_field(const std::string& by, const std::vector<NamedField>& fields, int dimension,
                       const std::string& where);

}  // namespace ductile::cli
