/// @file
/// Sections of GMF files, and the lists of a mesh that are sections, for the reader and the writer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "gmf_keywords.hpp"

namespace ductile::meshadapt::gmf {

/// Records of a section, each of so many reals, then so many integers.
struct Section {
  Keyword keyword = Keyword::none;
  std::uint64_t count = 0;  ///< records
  std::uint64_t reals = 0, integers = 0;
  std::size_t begin = 0;  ///< byte of the first record, when it is read

  std::uint64_t numbers() const { return reals + integers; }
};

/// Sizes of numbers in a binary file of one version.
struct BinarySizes {
  int version = 2;

  std::size_t real() const { return version == 1 ? 4 : 8; }
  std::size_t integer() const { return version == 4 ? 8 : 4; }
  std::size_t position() const { return version >= 3 ? 8 : 4; }
  /// Count, head numbers and records.
  std::size_t contents(const Section& section, std::size_t head_numbers) const {
    return integer() + 4 * head_numbers +
           section.count * (section.reals * real() + section.integers * integer());
  }
  /// Keyword and position of the next section.
  std::size_t head() const { return 4 + position(); }
  /// First and last bytes: two numbers, the section Dimension, the section End.
  std::size_t frame() const { return 8 + (head() + 4) + head(); }
};

/// "Triangles 3 of 7", counted from 1 as in the file.
inline std::string record_name(const Section& section, std::size_t record) {
  return std::string(name_of(section.keyword)) + " " + std::to_string(record + 1) + " of " +
         std::to_string(section.count);
}

/// A list of indices that marks entities of one kind.
struct MarkedList {
  Keyword keyword;
  std::vector<std::uint32_t> AnyMesh::*indices;
  Keyword marked;  ///< the section of the entities
};
inline constexpr std::array<MarkedList, 6> marked_lists{
    {{Keyword::corners, &AnyMesh::corners, Keyword::vertices},
     {Keyword::ridges, &AnyMesh::ridges, Keyword::edges},
     {Keyword::required_vertices, &AnyMesh::required_vertices, Keyword::vertices},
     {Keyword::required_edges, &AnyMesh::required_edges, Keyword::edges},
     {Keyword::required_triangles, &AnyMesh::required_triangles, Keyword::triangles},
     {Keyword::required_tetrahedra, &AnyMesh::required_tetrahedra, Keyword::tetrahedra}}};

/// The number of entities of a section in a mesh.
inline std::size_t entity_count(const AnyMesh& mesh, Keyword keyword) {
  return keyword == Keyword::vertices    ? mesh.vertex_count()
         : keyword == Keyword::edges     ? mesh.edges.size()
         : keyword == Keyword::triangles ? mesh.triangles.size()
                                         : mesh.tetrahedra.size();
}

}  // namespace ductile::meshadapt::gmf
