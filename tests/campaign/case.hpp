/// @file
/// Case: one random adaptation, made from a seed alone: a mesh, perhaps a metric, the options of
/// `ductile adapt`, and the properties that the outcome must have.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "check.hpp"
#include "mesh.hpp"

namespace ductile::campaign {

struct Case {
  std::string kind;
  Mesh mesh;
  std::optional<Field> metric;
  std::vector<std::string> options;  ///< of `ductile adapt`, without files and --threads
  Promise promise;
  /// A message that contains one of these words is accepted instead of a mesh.
  std::vector<std::string> refusals;
  /// The mesh before rounding; it must lead to about the same number of elements.
  std::optional<Mesh> unrounded;
  bool deterministic = true;  ///< the result must have the same bytes at any number of threads
  bool rests = true;          ///< adapting the result again must change little
};

/// The names of all kinds of cases.
std::vector<std::string> kind_names();

/// Makes the case of this number; consecutive numbers go through all kinds. If `kind` is given, all
/// cases are of that kind.
Case make_case(std::uint64_t seed, std::uint64_t number, const std::string& kind = "");

}  // namespace ductile::campaign
