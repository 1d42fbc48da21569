/// @file
/// Which field a picture shows, for a word such as "pressure", "2" or "velocity:1".
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::cli {

/// The field of this name, else the one of this number, from 1, as scalars: of vectors and tensors
/// the norm, or with ":K" after the name or number the component K, from 1. Throws UsageError if
/// there is none in `where`.
meshadapt::NamedField shown_field(const std::string& by,
                                  const std::vector<meshadapt::NamedField>& fields, int dimension,
                                  const std::string& where);

}  // namespace ductile::cli
