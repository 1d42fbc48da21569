/// @file
/// Checks that make_mesh() gets a mesh that can be adapted, before anything is made of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

/// Throws InputError unless the options are in range, each entity of the mesh names vertices that
/// there are, and none twice, and coordinates are finite and neither too large nor too small for
/// volumes. Thread safety: one caller; runs on the executor.
template <int Dim, int Space = Dim>
void check_input(const runtime::Executor& executor, const AnyMesh& mesh,
                 const MakeMeshOptions& options);

/// One flag for each of `count` entities: is it in this list of indices? Throws InputError if one
/// of them is out of range; `kind` is what such an entity is called.
std::vector<bool> marked(const AnyMesh& mesh, std::size_t count,
                         const std::vector<std::uint32_t>& list, const char* kind);

/// An entity: "triangles.vertices[6]", and "triangle 7" in a file.
Wording cell_word(const std::string& kind, std::size_t index);

/// Throws InputError with a message about the mesh.
[[noreturn]] void refuse_mesh(const AnyMesh& mesh, const Wording& what);

}  // namespace ductile::meshadapt
