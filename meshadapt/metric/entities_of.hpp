/// @file
/// Which entities of a mesh carry a reference, or one of a name.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/sizes.hpp"

namespace ductile::meshadapt {

/// Cells of 1 to 4 corners, as numbers of vertices.
struct EntityList {
  int dimension = 0;
  std::vector<std::array<std::uint32_t, 4>> corners;  // those beyond dimension + 1 are 0
};

inline const char* entities_word(int dimension) {
  constexpr std::array words{"vertices", "edges", "triangles", "tetrahedra"};
  return words[static_cast<std::size_t>(dimension)];
}

namespace detail {

template <int Corners>
void append(EntityList& list, const Cells<Corners>& cells, std::int32_t reference,
            std::size_t vertices) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.reference[i] != reference) continue;
    std::array<std::uint32_t, 4> corners{};
    for (std::size_t c = 0; c < Corners; ++c) {
      corners[c] = cells.vertices[i][c];
      if (corners[c] >= vertices)
        throw InputError(std::string(entities_word(Corners - 1)) + ".vertices[" +
                         std::to_string(i) + "]: expected vertices below " +
                         std::to_string(vertices) + ", found " + std::to_string(corners[c]));
    }
    list.corners.push_back(corners);
  }
}

}  // namespace detail

/// The entities of a dimension from 0 to 3 that carry a reference, in their order. Throws
/// InputError if they name vertices that there are not.
inline EntityList entities_of(const AnyMesh& mesh, int dimension, std::int32_t reference) {
  EntityList list{dimension, {}};
  const std::size_t vertices = mesh.vertex_count();
  if (dimension == 0)
    for (std::uint32_t v = 0; v < vertices; ++v)
      if (mesh.vertex_reference[v] == reference) list.corners.push_back({v, 0, 0, 0});
  if (dimension == 1) detail::append(list, mesh.edges, reference, vertices);
  if (dimension == 2) detail::append(list, mesh.triangles, reference, vertices);
  if (dimension == 3) detail::append(list, mesh.tetrahedra, reference, vertices);
  return list;
}

/// The dimensions and references that carry the name. Throws InputError, which lists the existing
/// names, if there are none.
inline std::set<std::pair<int, std::int32_t>> references_named(const AnyMesh& mesh,
                                                               const std::string& name) {
  std::set<std::pair<int, std::int32_t>> found;
  std::set<std::string> names;
  for (const ReferenceName& one : mesh.names) {
    names.insert(one.name);
    if (one.name == name && one.dimension >= 0 && one.dimension <= mesh.dimension)
      found.emplace(one.dimension, one.reference);
  }
  if (!found.empty()) return found;
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  throw InputError("expected " +
                   (known.empty() ? std::string("a number, because the mesh has no names")
                                  : "a name that the mesh has (" + known + ")") +
                   ", found '" + name + "'");
}

/// Calls take(source) for each source; an InputError that it throws then begins with the source.
template <class Take>
void each_source(const Sizes& sizes, Take&& take) {
  for (std::size_t i = 0; i < sizes.sources.size(); ++i) {
    const SizeSource& source = sizes.sources[i];
    try {
      take(source);
    } catch (const InputError& error) {
      const std::string index = "sources[" + std::to_string(i) + "]";
      throw InputError((source.name.empty() ? index : source.name) + ": " + error.what());
    }
  }
}

}  // namespace ductile::meshadapt
