/// @file
/// Whether a mesh covers the domain of another, found while fields are carried between them. A few
/// more fields go along: the places of the old vertices, which outside of the old mesh arrive as
/// those of its closest points, and the sizes of its elements, because the facets of a curved
/// boundary are off by a part of that.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::cli {

/// Two meshes and what goes from one to the other.
struct Passage {
  const meshadapt::AnyMesh &from, &to;
};

/// Appends what is to be carried along to fields of this mesh.
void add_probes(const meshadapt::AnyMesh& mesh, std::vector<meshadapt::NamedField>& fields,
                std::vector<meshadapt::Carrying>& carrying);

/// Throws InputError if a vertex of the new mesh lies farther outside than a quarter of an element
/// of the old one, or more than a hundredth of the new mesh does. `first` is the index of what
/// add_probes() appended.
void expect_same_domain(const Passage& meshes, const meshadapt::TransferredFields& carried,
                        std::size_t first);

/// Warns if the new mesh is larger, where values are the closest ones, or the old one, of which
/// integrals lose a part.
void warn_of_extension(const Passage& meshes, const meshadapt::TransferReport& report,
                       meshadapt::Warnings& warnings);
void warn_of_loss(const Passage& meshes, const meshadapt::TransferReport& report,
                  meshadapt::Warnings& warnings);

}  // namespace ductile::cli
