/// @file
/// Physical groups of Gmsh and references (private to io). An entity of Gmsh is in any number of
/// groups, one of a mesh has one reference. Each set of several groups gets a reference of its own
/// with the names of all its groups; a group without a name is called by its number. The names of
/// a reference therefore tell its groups, whatever happens to the mesh.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The name of the group in which elements without a group are written, because meshio and MFEM
/// refuse files where some have none. When read, they are in no group.
inline constexpr const char* no_group_name = "no group";

using GroupSet = std::set<std::int32_t>;

/// Gives references to sets of groups, and their names to the mesh. Thread safety: one thread.
class GroupReferences {
 public:
  /// Numbers the set; its reference replaces the number in the end. 0 is the empty set.
  std::int32_t number_of(const GroupSet& groups);
  const GroupSet& set_of(std::int32_t number) const {
    return sets_[static_cast<std::size_t>(number)];
  }
  /// [number of a set] its reference: that of its only group, 0 without groups, otherwise a new
  /// one. Adds names for entities of the dimension.
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
  /// The names of groups.
  const std::vector<ReferenceName>& names() const { return names_; }

 private:
  void add_cells(int dimension, const std::vector<std::int32_t>& references);

  std::map<std::pair<int, std::int32_t>, std::vector<std::int32_t>> groups_of_;
  std::vector<ReferenceName> names_;
};

/// [dimension, reference] the groups of references with several names, if each name is that of a
/// group.
std::map<std::pair<int, std::int32_t>, std::vector<std::int32_t>> joint_groups(
    const std::vector<ReferenceName>& names);

}  // namespace ductile::meshadapt
