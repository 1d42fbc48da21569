/// @file
/// Wording: a message about entries of arrays, in two forms. Callers with arrays see names and
/// indices from 0, "triangles.vertices[6]"; users with files see entities from 1, "triangle 7".
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

struct Wording {
  std::string in_memory, in_file;

  Wording(const char* both) : Wording(std::string(both)) {}             // NOLINT: a text is one
  Wording(const std::string& both) : in_memory(both), in_file(both) {}  // NOLINT: as above
  Wording(std::string memory, std::string file)
      : in_memory(std::move(memory)), in_file(std::move(file)) {}

  friend Wording operator+(const Wording& a, const Wording& b) {
    return {a.in_memory + b.in_memory, a.in_file + b.in_file};
  }
};

/// An index: "6", and "7" in a file.
inline Wording index_word(std::size_t index) {
  return {std::to_string(index), std::to_string(index + 1)};
}

/// An entry of an array: "array[6]", and "kind 7" in a file.
inline Wording entry(const std::string& array, const std::string& kind, std::size_t index) {
  return {array + "[" + std::to_string(index) + "]", kind + " " + std::to_string(index + 1)};
}

/// The name of a mesh or a field: its origin, or its kind.
inline std::string name_of(const AnyMesh& mesh) { return mesh.name.empty() ? "mesh" : mesh.name; }
inline std::string name_of(const AnyField& field) {
  return field.name.empty() ? "field" : field.name;
}

/// The values of a field at a vertex: "values[18]", the first of them, and "vertex 7" in a file.
inline Wording value_at(const AnyField& field, std::size_t vertex) {
  return {
      "values[" + std::to_string(vertex * stride_of(field)) + "], vertex " + std::to_string(vertex),
      "vertex " + std::to_string(vertex + 1)};
}

/// The names of the arrays that hold elements and facets.
template <int Dim>
const char* elements_array() {
  return Dim == 2 ? "triangles.vertices" : "tetrahedra.vertices";
}
template <int Dim>
const char* facets_array() {
  return Dim == 2 ? "edges.vertices" : "triangles.vertices";
}

/// Throws InputError unless as many entries were found as there are vertices; `expected` says
/// which, as in "value_of: expected a value".
inline void expect_at_each_vertex(const std::string& expected, std::size_t vertices,
                                  std::size_t found) {
  if (found != vertices)
    throw InputError(expected + " for each of the " + std::to_string(vertices) +
                     " vertices, found " + std::to_string(found));
}

[[noreturn]] inline void refuse(const Wording& message) {
  throw InputError(message.in_memory, message.in_file);
}

}  // namespace ductile::meshadapt
