/// @file
/// Physical groups of Gmsh and references (private to io). An entity of Gmsh is in any number of
/// groups, one of a mesh has one reference. Each set of several groups gets a reference of its own,
/// which has the names of all groups in it; a group without a name is called by its number. So the
/// names tell what groups a reference stands for, in whatever way the mesh went.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The name of the group that elements without a group are written in, because meshio and MFEM
/// refuse those; read again, they are in none.
inline constexpr const char* no_group_name = "no group";

using GroupSet = std::set<std::int32_t>;

/// Gives references to sets of groups, and their names to the mesh. Thread safety: one thread.
class GroupReferences {
 public:
  /// A number for the set, to be replaced by its reference in the end; 0 is the empty set.
  std::int32_t number_of(const GroupSet& groups);
  const GroupSet& set_of(std::int32_t number) const {
    return sets_[static_cast<std::size_t>(number)];
  }
  /// [number of a set] the reference: that of the only group, 0 of none, or a new one. Adds names
  /// for entities of the dimension.
  std::vector<std::int32_t> references(int dimension, std::vector<ReferenceName>& names) const;

 private:
  std::vector<GroupSet> sets_{GroupSet{}};
  std::map<GroupSet, std::int32_t> number_of_{{GroupSet{}, 0}};
};

/// The groups that a mesh's references stand for when it is written.
class GroupsOfReferences {
 public:
  explicit GroupsOfReferences(const AnyMesh& mesh);
  /// At least one, except for vertices with reference 0.
  const std::vector<std::int32_t>& of(int dimension, std::int32_t reference) const;
  /// Those of groups.
  const std::vector<ReferenceName>& names() const { return names_; }

 private:
  void add_cells(int dimension, const std::vector<std::int32_t>& references);

  std::map<std::pair<int, std::int32_t>, std::vector<std::int32_t>> groups_of_;
  std::vector<ReferenceName> names_;
};

/// The groups of a reference as the names tell them: itself, or several.
std::map<std::pair<int, std::int32_t>, std::vector<std::int32_t>> joint_groups(
    const std::vector<ReferenceName>& names);

}  // namespace ductile::meshadapt
