#include "msh_groups.hpp"

#include <algorithm>

namespace ductile::meshadapt {
namespace {

/// The smallest number from 1 on that is not taken, which then is.
std::int32_t take_free(std::set<std::int32_t>& taken) {
  std::int32_t number = 1;
  for (auto at = taken.lower_bound(1); at != taken.end() && *at == number; ++at) ++number;
  taken.insert(number);
  return number;
}

}  // namespace

// ---- Reading ----

std::int32_t GroupReferences::number_of(const GroupSet& groups) {
  const auto [at, is_new] = number_of_.try_emplace(groups, static_cast<std::int32_t>(sets_.size()));
  if (is_new) sets_.push_back(groups);
  return at->second;
}

std::vector<std::int32_t> GroupReferences::references(int dimension,
                                                      std::vector<ReferenceName>& names) const {
  GroupSet taken, none;
  std::map<std::int32_t, std::string> name_of;
  for (const ReferenceName& name : names) {
    if (name.dimension != dimension) continue;
    taken.insert(name.reference);
    name_of.emplace(name.reference, name.name);
    if (name.name == no_group_name) none.insert(name.reference);
  }
  std::erase_if(names, [&](const ReferenceName& name) {
    return name.dimension == dimension && name.name == no_group_name;
  });
  for (const GroupSet& groups : sets_) taken.insert(groups.begin(), groups.end());
  std::vector<std::int32_t> references;
  for (GroupSet groups : sets_) {
    std::erase_if(groups, [&](std::int32_t group) { return group == 0 || none.contains(group); });
    if (groups.size() < 2) {
      references.push_back(groups.empty() ? 0 : *groups.begin());
      continue;
    }
    references.push_back(take_free(taken));
    for (const std::int32_t group : groups) {
      const auto [name, is_new] = name_of.try_emplace(group, std::to_string(group));
      if (is_new) names.push_back({dimension, group, name->second});
      names.push_back({dimension, references.back(), name->second});
    }
  }
  return references;
}

// ---- Writing ----

std::map<std::pair<int, std::int32_t>, std::vector<std::int32_t>> joint_groups(
    const std::vector<ReferenceName>& names) {
  using Key = std::pair<int, std::int32_t>;
  std::map<Key, std::set<std::string>> names_of;
  for (const ReferenceName& name : names)
    names_of[{name.dimension, name.reference}].insert(name.name);
  std::map<std::pair<int, std::string>, std::int32_t> group_called;  // those with one name
  for (const auto& [key, called] : names_of)
    if (called.size() == 1) group_called.emplace(std::pair(key.first, *called.begin()), key.second);
  std::map<Key, std::vector<std::int32_t>> groups_of;
  for (const auto& [key, called] : names_of) {
    if (called.size() < 2) continue;
    std::vector<std::int32_t> groups;
    for (const std::string& name : called)
      if (const auto group = group_called.find({key.first, name}); group != group_called.end())
        groups.push_back(group->second);
    if (groups.size() != called.size()) continue;
    std::sort(groups.begin(), groups.end());
    groups_of[key] = std::move(groups);
  }
  return groups_of;
}

GroupsOfReferences::GroupsOfReferences(const AnyMesh& mesh) : groups_of_(joint_groups(mesh.names)) {
  for (const ReferenceName& name : mesh.names)
    if (!groups_of_.contains({name.dimension, name.reference}) &&
        name.name != std::to_string(name.reference))
      names_.push_back(name);
  add_cells(0, mesh.vertex_reference);
  add_cells(1, mesh.edges.reference);
  add_cells(2, mesh.triangles.reference);
  add_cells(3, mesh.tetrahedra.reference);
}

void GroupsOfReferences::add_cells(int dimension, const std::vector<std::int32_t>& references) {
  std::set<std::int32_t> taken(references.begin(), references.end());
  const bool some_in_none = taken.contains(0);
  for (const std::int32_t reference : taken)
    if (reference != 0) groups_of_.try_emplace({dimension, reference}, std::vector{reference});
  if (dimension == 0) groups_of_[{0, 0}] = {};
  if (dimension == 0 || !some_in_none) return;
  for (const ReferenceName& name : names_)
    if (name.dimension == dimension) taken.insert(name.reference);
  for (const auto& [key, groups] : groups_of_)
    if (key.first == dimension) taken.insert(groups.begin(), groups.end());
  groups_of_[{dimension, 0}] = {take_free(taken)};
  names_.push_back({dimension, groups_of_.at({dimension, 0}).front(), no_group_name});
}

const std::vector<std::int32_t>& GroupsOfReferences::of(int dimension,
                                                        std::int32_t reference) const {
  return groups_of_.at({dimension, reference});
}

}  // namespace ductile::meshadapt
