/// @file
/// Checks, while fields are carried between two meshes, that both cover the same domain. More
/// fields are carried for that: the positions of the old vertices, which arrive as the closest
/// points of the old mesh, and the sizes of its elements, because facets of a curved boundary are
/// off by a fraction of that.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::cli {

/// The meshes from and to which fields are carried.
struct Passage {
  const meshadapt::AnyMesh &from, &to;
};

/// Appends the additional fields to those of this mesh.
void add_probes(const meshadapt::AnyMesh& mesh, std::vector<meshadapt::NamedField>& fields,
                std::vector<meshadapt::Carrying>& carrying);

/// Throws InputError if a vertex of the new mesh lies farther outside than a quarter of an element
/// of the old one, or more than a hundredth of the new mesh does. `first` is the index of what
/// add_probes() appended.
void expect_same_domain(const Passage& meshes, const meshadapt::TransferredFields& carried,
                        std::size_t first);

/// Warn if the new mesh is larger, where values are the closest ones, or the old one, which costs
/// integrals a part.
void warn_of_extension(const Passage& meshes, const meshadapt::TransferReport& report,
                       meshadapt::Warnings& warnings);
void warn_of_loss(const Passage& meshes, const meshadapt::TransferReport& report,
                  meshadapt::Warnings& warnings);

}  // namespace ductile::cli
