/// @file
/// joined_names: what a reference is called. Any thread.
#pragma once

#include <cstdint>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The names of a reference, joined by '+'; empty if it has none.
inline std::string joined_names(const AnyMesh& mesh, int dimension, std::int32_t reference) {
  std::string names;
  for (const ReferenceName& name : mesh.names)
    if (name.dimension == dimension && name.reference == reference && !name.name.empty())
      names += (names.empty() ? "" : "+") + name.name;
  return names;
}

}  // namespace ductile::meshadapt
