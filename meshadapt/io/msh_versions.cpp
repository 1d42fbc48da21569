#include "msh_reader.hpp"

#include <algorithm>
#include <array>

namespace ductile::meshadapt {

// ---- Version 2 ----

void MshReader::read_nodes_2(bool parametric) {
  const std::uint64_t count = size("the number of nodes");
  in_.line();
  begin_numbers();
  in_.expect_room(count, {4, 28}, "nodes");
  for (std::uint64_t i = 0; i < count; ++i) {
    node_numbers_.push_back(static_cast<std::uint64_t>(number("the number of a node")));
    read_point();
    if (!parametric) continue;
    const std::int32_t dimension = number("the dimension of an entity");
    number("an entity");
    for (int k = 0; k < dimension && dimension < 3; ++k) in_.real("a parameter");
  }
}

void MshReader::read_element_2(MshCells& cells, std::uint64_t number_of_it, int corners,
                               std::int32_t tags) {
  MshGroup group;
  for (std::int32_t i = 0; i < tags; ++i) {
    const std::int32_t tag = number("a tag of an element");
    if (i == 0 && tag != 0) group.physical.insert(tag);
    if (i == 1) group.elementary = tag;
    if (i == 2 && tag > 0) ++in_parts_;
  }
  std::array<std::uint64_t, 4> nodes{};
  for (int i = 0; i < corners; ++i)
    nodes[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(number("the number of a node"));
  cells.add(number_of_it, corners, nodes.data(), group);
}

void MshReader::read_elements_2(MshCells& cells) {
  std::uint64_t left = size("the number of elements");
  in_.line();
  begin_numbers();
  in_.expect_room(left, {2, 8}, "elements");
  while (left > 0) {
    std::uint64_t number_of_it = 0, together = 1;
    if (!binary_) number_of_it = static_cast<std::uint64_t>(number("the number of an element"));
    const int corners = msh_corners(in_, number("the type of an element"));
    if (binary_) {
      const std::int32_t count = number("a number of elements");
      if (count < 1 || static_cast<std::uint64_t>(count) > left)
        in_.fail("expected 1 to ", left, " elements of one type, found ", count,
                 "; the file is damaged, write or copy it again");
      together = static_cast<std::uint64_t>(count);
    }
    const std::int32_t tags = number("the number of tags");
    if (tags < 0 || tags > 1000000)
      in_.fail("expected a number of tags, found ", tags, "; correct it");
    for (std::uint64_t i = 0; i < together; ++i) {
      if (binary_) number_of_it = static_cast<std::uint64_t>(number("the number of an element"));
      read_element_2(cells, number_of_it, corners, tags);
    }
    left -= together;
  }
}

// ---- Version 4.1 ----

void MshReader::read_entities(bool partitioned) {
  begin_numbers();
  if (partitioned) {
    size("the number of partitions");
    const std::uint64_t ghosts = size("the number of ghost entities");
    in_.expect_room(ghosts, {2, 8}, "ghost entities");
    for (std::uint64_t i = 0; i < 2 * ghosts; ++i) number("a ghost entity");
  }
  std::array<std::uint64_t, 4> count;
  for (std::uint64_t& entities : count) entities = size("the number of entities");
  for (std::size_t dimension = 0; dimension < 4; ++dimension) {
    in_.expect_room(count[dimension], {5, 20}, "entities");
    for (std::uint64_t i = 0; i < count[dimension]; ++i)
      read_entity(static_cast<int>(dimension), partitioned);
  }
}

void MshReader::read_entity(int dimension, bool partitioned) {
  const std::int32_t tag = number("the number of an entity");
  Entity entity;
  if (partitioned) {
    entity.between_parts = number("the dimension of an entity") > dimension;
    number("an entity");
    const std::uint64_t parts = size("the number of partitions");
    for (std::uint64_t i = 0; i < parts; ++i) number("a partition");
  }
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) in_.real("a coordinate of an entity");
  const std::uint64_t groups = size("the number of physical groups");
  for (std::uint64_t i = 0; i < groups; ++i) {
    const std::int32_t group = number("a physical group");
    // Gmsh has entities that are turned round in a group under its negative number.
    const bool turned = dimension > 0 && group < 0 && group > -2147483647 && tag != group;
    if (group != 0) entity.physical.insert(turned ? -group : group);
  }
  if (dimension > 0) {
    const std::uint64_t around = size("the number of bounding entities");
    for (std::uint64_t i = 0; i < around; ++i) number("a bounding entity");
  }
  entity_of_[{dimension, tag}] = entity;
}

void MshReader::read_nodes_4() {
  begin_numbers();
  const std::uint64_t blocks = size("the number of blocks");
  for (int i = 0; i < 3; ++i) size("a number of nodes");
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::int32_t dimension = number("the dimension of an entity");
    number("an entity");
    const std::int32_t parametric = number("whether there are parameters, 0 or 1");
    const std::uint64_t count = size("a number of nodes");
    in_.expect_room(count, {4, 24 + size_bytes_}, "nodes");
    for (std::uint64_t i = 0; i < count; ++i) node_numbers_.push_back(size("the number of a node"));
    for (std::uint64_t i = 0; i < count; ++i) {
      read_point();
      for (int k = 0; parametric != 0 && k < std::clamp(dimension, 0, 3); ++k)
        in_.real("a parameter");
    }
  }
}

void MshReader::read_elements_4(MshCells& cells) {
  begin_numbers();
  const std::uint64_t blocks = size("the number of blocks");
  for (int i = 0; i < 3; ++i) size("a number of elements");
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::int32_t dimension = number("the dimension of an entity");
    const std::int32_t tag = number("an entity");
    const int corners = msh_corners(in_, number("the type of an element"));
    const std::uint64_t count = size("a number of elements");
    const auto numbers = static_cast<std::uint64_t>(1 + corners);
    in_.expect_room(count, {numbers, numbers * size_bytes_}, "elements");
    const auto found = entity_of_.find({dimension, tag});
    const Entity entity = found == entity_of_.end() ? Entity{} : found->second;
    if (entity.between_parts) between_parts_ += static_cast<std::size_t>(count);
    const MshGroup group{entity.physical, tag};
    std::array<std::uint64_t, 4> nodes{};
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t number_of_it = size("the number of an element");
      for (int k = 0; k < corners; ++k)
        nodes[static_cast<std::size_t>(k)] = size("the number of a node");
      if (!entity.between_parts) cells.add(number_of_it, corners, nodes.data(), group);
    }
  }
}

}  // namespace ductile::meshadapt
