/// @file
/// The keywords of GMF: their names in text, their numbers in binary files, and the role of their
/// sections. Any thread.
#pragma once

#include <string_view>

namespace ductile::meshadapt::gmf {

/// The keywords that are read and written, numbered as in binary files.
enum class Keyword : int {
  none = 0,
  version = 1,
  dimension = 3,
  vertices = 4,
  edges = 5,
  triangles = 6,
  tetrahedra = 8,
  required_tetrahedra = 12,
  corners = 13,
  ridges = 14,
  required_vertices = 15,
  required_edges = 16,
  required_triangles = 17,
  end = 54,
  field_at_vertices = 62
};

/// The role of a section for a reader.
enum class Role {
  frame,        ///< version, dimension, end
  mesh,         ///< data of AnyMesh
  field,        ///< data of AnyField
  other_cells,  ///< cells that a simplex mesh cannot hold
  other         ///< everything else: left out with a warning
};

/// "Triangles" for 6; empty if no keyword has that number.
std::string_view name_of(Keyword keyword);

/// The keyword of that name, in the same case; Keyword::none if there is none.
Keyword keyword_named(std::string_view name);

/// The name of a section that is read, or refused, and one letter away from this one; empty if
/// there is none.
std::string_view similar_name(std::string_view name);

Role role_of(Keyword keyword);

/// A number of lines follows the keyword.
bool has_count(Keyword keyword);

/// The section holds text beside numbers.
bool has_text(Keyword keyword);

}  // namespace ductile::meshadapt::gmf
