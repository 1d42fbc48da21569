/// @file
/// A distributed mesh as one mesh on the first rank, or as files, a piece for each rank. Files
/// appear whole or not at all; their index, the .pvtu, appears last.
#pragma once

#include <filesystem>
#include <vector>

#include "distributed/adapt_parts.hpp"
#include "distributed/communicator.hpp"
#include "distributed/file_part.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// A mesh with the fields at its vertices and elements, in parts.
struct DistributedResult {
  AdaptedParts parts;
  std::vector<meshadapt::NamedField> fields;
  Kept kept;
};

/// A mesh on one rank with its target metric and fields.
struct GatheredResult {
  AnyMesh mesh;
  AnyField metric;
  std::vector<meshadapt::NamedField> fields;
};

/// The whole result on the first rank; an empty mesh on the others. Vertices are in the order of
/// their numbers, elements in that of the ranks. Throws Error, on all ranks. Collective.
GatheredResult gathered(const Communicator& comm, const runtime::Executor& executor,
                        const DistributedResult& result);

/// Writes PATH, a .pvtu, and PATH_RANK.vtu beside it from each rank that has elements. If that
/// fails, there is no PATH, rather than one that names pieces of two runs. Throws Error, on all
/// ranks. Collective.
void write_pieces(const Communicator& comm, const std::filesystem::path& path,
                  const DistributedResult& result);

}  // namespace ductile::distributed
