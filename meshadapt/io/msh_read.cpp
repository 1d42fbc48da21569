#include "msh_read.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "gmf_left_out.hpp"
#include "msh_cells.hpp"
#include "number_cursor.hpp"
#include "number_index.hpp"

namespace ductile::meshadapt {
namespace {

using Place = NamedField::Place;

class MshReader {
 public:
  MshReader(const FileBytes& bytes, Warnings* warnings) : in_(bytes), warnings_(warnings) {
    to_.mesh.dimension = 3;
    to_.mesh.name = bytes.name;
  }

  SpatialMesh read() {
    for (;;) {
      const std::string_view word = in_.word();
      if (word.empty()) break;
      if (word[0] != '$' || word.size() < 2)
        in_.fail("expected the beginning of a section, such as $Nodes, found " + quoted(word) +
                 "; correct it, or the count of the section before");
      const std::string name(word.substr(1, 40));
      const std::string where = in_.where();
      in_.line();
      if (version_ == 0 && name != "MeshFormat" && name != "Comments")
        in_.fail("expected $MeshFormat first, found " + quoted(word) +
                 "; write the file in version 4.1 or 2.2");
      read_section(name, where);
    }
    expect_sections();
    say_what_is_left_out();
    return std::move(to_);
  }

 private:
  // ---- Sections ----
  void read_section(const std::string& name, const std::string& where);
  void skip_section(const std::string& name);
  void end_section(const std::string& name);
  void read_format();
  void read_names();
  void read_nodes(bool parametric);
  void read_elements();
  void expect_sections() const;
  void say_what_is_left_out();

  // ---- Version 2 ----
  void read_nodes_2(bool parametric);
  void read_elements_2(MshCells& cells);
  void read_element_2(MshCells& cells, std::uint64_t number, int corners, std::int32_t tags);

  // ---- Version 4.1 ----
  struct Entity {
    std::int32_t physical = 0;
    bool between_parts = false;
  };
  void read_entities(bool partitioned);
  void read_entity(int dimension, bool partitioned);
  void read_nodes_4();
  void read_elements_4(MshCells& cells);

  // ---- Fields ----
  struct DataHead {
    std::string name;
    std::int64_t components = 0;
    std::uint64_t count = 0;
  };
  DataHead read_data_head();
  void read_data(Place place, const std::string& section);

  // ---- Numbers ----
  void begin_numbers() {
    if (binary_) in_.set_binary(swapped_);
  }
  std::int32_t number(const char* what) { return in_.integer<std::int32_t>(what); }
  /// What the format calls a size_t.
  std::uint64_t size(const char* what) {
    if (in_.is_binary())
      return size_bytes_ == 4 ? in_.integer<std::uint32_t>(what) : in_.integer<std::uint64_t>(what);
    const auto value = in_.integer<std::int64_t>(what);
    if (value < 0)
      in_.fail(std::string("expected ") + what + " from 0, found " + std::to_string(value) +
               "; correct it");
    return static_cast<std::uint64_t>(value);
  }
  void read_point() {
    for (int axis = 0; axis < 3; ++axis) to_.mesh.coordinates.push_back(in_.real("a coordinate"));
  }

  NumberCursor in_;
  Warnings* warnings_;
  SpatialMesh to_;
  int version_ = 0;  ///< 2 or 4; 0: not known yet
  bool binary_ = false, swapped_ = false;
  std::uint64_t size_bytes_ = 8;
  bool has_nodes_ = false, has_elements_ = false;
  std::vector<std::uint64_t> node_numbers_;
  NumberIndex node_index_;
  std::vector<std::uint64_t> element_numbers_;
  std::optional<NumberIndex> element_index_;  ///< made when it is wanted
  std::map<std::pair<int, std::int32_t>, Entity> entity_of_;
  std::map<std::pair<bool, std::string>, std::size_t> field_of_;  ///< [in cells, name]
  gmf::LeftOut left_out_;
  std::size_t several_groups_ = 0, between_parts_ = 0, in_parts_ = 0;
};

// ---- Sections ----

void MshReader::read_section(const std::string& name, const std::string& where) {
  if (name == "MeshFormat")
    read_format();
  else if (name == "PhysicalNames")
    read_names();
  else if (name == "Entities" && version_ == 4)
    read_entities(false);
  else if (name == "PartitionedEntities" && version_ == 4)
    read_entities(true);
  else if (name == "Nodes" || (name == "ParametricNodes" && version_ == 2))
    read_nodes(name != "Nodes");
  else if (name == "Elements")
    read_elements();
  else if (name == "NodeData")
    return read_data(Place::vertices, name);
  else if (name == "ElementData")
    return read_data(Place::elements, name);
  else {
    if (name != "Comments") left_out_.add(where, name);
    return skip_section(name);
  }
  end_section(name);
}

void MshReader::skip_section(const std::string& name) {
  in_.set_text();
  if (!in_.skip_behind("$End" + name)) in_.fail_end(("$End" + name).c_str());
}

void MshReader::end_section(const std::string& name) {
  in_.set_text();
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_end(("$End" + name).c_str());
  if (word != "$End" + name)
    in_.fail("expected $End" + name + ", found " + quoted(word) +
             "; correct the counts of the section");
}

void MshReader::read_format() {
  if (version_ != 0) in_.fail("expected one $MeshFormat, found a second; remove one");
  const std::string_view version = in_.word();
  if (version == "4.1")
    version_ = 4;
  else if (version == "2" || version == "2.0" || version == "2.1" || version == "2.2")
    version_ = 2;
  else
    in_.fail("expected version 2.2 or 4.1, found " + quoted(version) +
             "; write the file in one of them, as with gmsh -format msh41");
  binary_ = in_.integer<int>("whether the file is binary, 0 or 1") != 0;
  const int bytes = in_.integer<int>("the size of numbers, 8");
  if (bytes != 8 && (version_ == 2 || bytes != 4))
    in_.fail("expected numbers of 8 bytes, found " + std::to_string(bytes) +
             "; write the file again");
  size_bytes_ = static_cast<std::uint64_t>(bytes);
  if (!binary_) return;
  in_.line();
  in_.set_binary(false);
  const std::int32_t one = number("the number 1, which tells the byte order");
  swapped_ = one == 0x01000000;
  if (one != 1 && !swapped_)
    in_.fail("expected the number 1, which tells the byte order, found " + std::to_string(one) +
             "; copy the file again");
}

void MshReader::read_names() {
  const std::uint64_t count = size("the number of names");
  in_.expect_room(count, 3, 4, "names");
  for (std::uint64_t i = 0; i < count; ++i) {
    ReferenceName name;
    name.dimension = in_.integer<int>("the dimension of a group");
    if (name.dimension < 0 || name.dimension > 3)
      in_.fail("expected a dimension from 0 to 3, found " + std::to_string(name.dimension) +
               "; correct it");
    name.reference = number("the number of a group");
    name.name = in_.quoted_text();
    to_.mesh.names.push_back(std::move(name));
  }
}

void MshReader::read_nodes(bool parametric) {
  if (has_nodes_) in_.fail("expected one section of nodes, found a second; remove one");
  has_nodes_ = true;
  version_ == 2 ? read_nodes_2(parametric) : read_nodes_4();
  if (node_numbers_.size() >= std::numeric_limits<std::uint32_t>::max())
    in_.fail("expected fewer than 4294967295 nodes, found more; take a smaller mesh");
  to_.mesh.vertex_reference.assign(node_numbers_.size(), 0);
  node_index_ = NumberIndex(node_numbers_);
  if (node_index_.repeated() != NumberIndex::none)
    in_.fail("expected each node once, found node " +
             std::to_string(node_numbers_[node_index_.repeated()]) + " twice; remove one");
}

void MshReader::read_elements() {
  if (!has_nodes_) in_.fail("expected $Nodes before $Elements, found none; put it first");
  if (has_elements_) in_.fail("expected one section $Elements, found a second; join them");
  has_elements_ = true;
  MshCells cells(in_, to_, node_index_);
  version_ == 2 ? read_elements_2(cells) : read_elements_4(cells);
  cells.finish();
  element_numbers_ = cells.numbers();
}

void MshReader::expect_sections() const {
  if (node_numbers_.empty())
    in_.fail(std::string("expected the section $Nodes, found ") +
             (has_nodes_ ? "it empty" : "none") + "; give a mesh file");
}

void MshReader::say_what_is_left_out() {
  const auto warn = [&](std::size_t count, const std::string& text) {
    if (warnings_ && count > 0)
      warnings_->push_back(printable(in_.name() + ": " + std::to_string(count) + text));
  };
  if (const std::string text = left_out_.warning(); warnings_ && !text.empty())
    warnings_->push_back(printable(text));
  warn(several_groups_,
       " entities are in several physical groups; their elements have the reference of the first");
  warn(between_parts_, " elements between partitions are left out");
  warn(in_parts_, " elements say which partition they are in, which is left out");
}

// ---- Version 2 ----

void MshReader::read_nodes_2(bool parametric) {
  const std::uint64_t count = size("the number of nodes");
  in_.line();
  begin_numbers();
  in_.expect_room(count, 4, 7, "nodes");  // 28 bytes in binary
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
    if (i == 0) group.physical = tag;
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
  in_.expect_room(left, 2, 4, "elements");
  while (left > 0) {
    std::uint64_t number_of_it = 0, together = 1;
    if (!binary_) number_of_it = static_cast<std::uint64_t>(number("the number of an element"));
    const int corners = msh_corners(in_, number("the type of an element"));
    if (binary_) {
      const std::int32_t count = number("a number of elements");
      if (count < 1 || static_cast<std::uint64_t>(count) > left)
        in_.fail("expected 1 to " + std::to_string(left) + " elements of one type, found " +
                 std::to_string(count) + "; the file is damaged, write or copy it again");
      together = static_cast<std::uint64_t>(count);
    }
    const std::int32_t tags = number("the number of tags");
    if (tags < 0 || tags > 1000000)
      in_.fail("expected a number of tags, found " + std::to_string(tags) + "; correct it");
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
    in_.expect_room(ghosts, 2, 4, "ghost entities");
    for (std::uint64_t i = 0; i < 2 * ghosts; ++i) number("a ghost entity");
  }
  std::array<std::uint64_t, 4> count;
  for (std::uint64_t& entities : count) entities = size("the number of entities");
  for (std::size_t dimension = 0; dimension < 4; ++dimension) {
    in_.expect_room(count[dimension], 5, 4, "entities");
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
    if (i == 0) entity.physical = turned ? -group : group;
  }
  several_groups_ += groups > 1;
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
    in_.expect_room(count, 4, 7, "nodes");
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
    in_.expect_room(count, static_cast<std::uint64_t>(1 + corners), size_bytes_, "elements");
    const auto found = entity_of_.find({dimension, tag});
    const Entity entity = found == entity_of_.end() ? Entity{} : found->second;
    if (entity.between_parts) between_parts_ += static_cast<std::size_t>(count);
    std::array<std::uint64_t, 4> nodes{};
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t number_of_it = size("the number of an element");
      for (int k = 0; k < corners; ++k)
        nodes[static_cast<std::size_t>(k)] = size("the number of a node");
      if (!entity.between_parts)
        cells.add(number_of_it, corners, nodes.data(), {entity.physical, tag});
    }
  }
}

// ---- Fields ----

MshReader::DataHead MshReader::read_data_head() {
  DataHead head;
  const std::uint64_t texts = size("the number of texts");
  in_.line();
  for (std::uint64_t i = 0; i < texts && in_.left() > 0; ++i) {
    const std::string text = in_.quoted_text();
    if (i == 0) head.name = text;
  }
  const std::uint64_t reals = size("the number of real numbers");
  for (std::uint64_t i = 0; i < reals; ++i) in_.real("a real number");
  const std::uint64_t integers = size("the number of whole numbers");
  for (std::uint64_t i = 0; i < integers; ++i) {
    const auto value = in_.integer<std::int64_t>("a whole number");
    if (i == 1) head.components = value;
    if (i == 2) head.count = value < 0 ? 0 : static_cast<std::uint64_t>(value);
  }
  in_.line();
  return head;
}

void MshReader::read_data(Place place, const std::string& section) {
  const std::string where = in_.where();
  if (!has_nodes_ || (place == Place::elements && !has_elements_))
    in_.fail("expected $Nodes and $Elements before $" + section + ", found none; put them first");
  const DataHead head = read_data_head();
  const bool at_vertices = place == Place::vertices;
  const std::size_t wanted = (at_vertices ? node_numbers_ : element_numbers_).size();
  const bool usable = head.components == 1 || head.components == 3 || head.components == 9;
  if (!usable || head.count < wanted || wanted == 0) {
    left_out_.add(where, section,
                  " '" + head.name + "' (" + std::to_string(head.components) + " components, " +
                      std::to_string(head.count) + " of " + std::to_string(wanted) + " values)");
    return skip_section(section);
  }
  const auto components = static_cast<std::size_t>(head.components);
  if (!at_vertices && !element_index_) element_index_ = NumberIndex(element_numbers_);
  SpatialField field{head.name, place, components, {}};
  begin_numbers();
  in_.expect_room(head.count, 1 + components, 4, "values");
  field.values.assign(wanted * components, std::numeric_limits<double>::quiet_NaN());
  for (std::uint64_t i = 0; i < head.count; ++i) {
    const auto number_of_it = static_cast<std::uint64_t>(number("the number of a node or element"));
    const std::size_t at = (at_vertices ? node_index_ : *element_index_).find(number_of_it);
    for (std::size_t k = 0; k < components; ++k) {
      const double value = in_.real("a value");
      if (at != NumberIndex::none) field.values[at * components + k] = value;
    }
  }
  end_section(section);
  // Of several steps, the last one is taken.
  const auto [known, is_new] = field_of_.try_emplace({!at_vertices, head.name}, to_.fields.size());
  if (is_new)
    to_.fields.push_back(std::move(field));
  else
    to_.fields[known->second] = std::move(field);
}

}  // namespace

bool is_msh(std::string_view bytes) {
  return bytes.starts_with("$MeshFormat") || bytes.starts_with("$Comments") ||
         bytes.starts_with("$NOD");
}

SpatialMesh read_msh(const FileBytes& bytes, Warnings* warnings) {
  return MshReader(bytes, warnings).read();
}

}  // namespace ductile::meshadapt
