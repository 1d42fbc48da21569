/// @file
/// Place and Shape: where a section's records lie in a GMF file and what one is made of. They let
/// counts be checked against the file's size and lead back to a number once it proves wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gmf_keywords.hpp"

namespace ductile::meshadapt::gmf {

/// One record: so many reals, then so many integers.
struct Shape {
  std::uint64_t reals = 0;
  std::uint64_t integers = 0;

  std::uint64_t numbers() const { return reals + integers; }
};

struct Place {
  Keyword keyword = Keyword::none;
  std::uint64_t count = 0;  ///< records
  std::size_t begin = 0;    ///< byte of the first record
  Shape shape;
};

/// "Triangles 3 of 7", counted from 1 as in the file.
inline std::string record_name(const Place& place, std::size_t record) {
  return std::string(name_of(place.keyword)) + " " + std::to_string(record + 1) + " of " +
         std::to_string(place.count);
}

}  // namespace ductile::meshadapt::gmf
