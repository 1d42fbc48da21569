#include "formats.hpp"

#include "msh_reader.hpp"

namespace ductile::meshadapt {

// ---- Sections ----

SpatialMesh MshReader::read() {
  for (;;) {
    const std::string_view word = in_.word();
    if (word.empty()) break;
    if (word[0] != '$' || word.size() < 2)
      in_.fail("expected the beginning of a section, such as $Nodes, found ", quoted(word),
               "; correct it, or the count of the section before");
    const std::string name(word.substr(1, 40));
    in_.line();
    if (version_ == 0 && name != "MeshFormat" && name != "Comments")
      in_.fail("expected $MeshFormat first, found ", quoted(word),
               "; write the file in version 4.1 or 2.2");
    read_section(name);
  }
  expect_sections();
  say_what_is_left_out();
  return std::move(to_);
}

void MshReader::read_section(const std::string& name) {
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
    return read_data(NamedField::Place::vertices, name);
  else if (name == "ElementData")
    return read_data(NamedField::Place::elements, name);
  else {
    if (name != "Comments") left_out_.add(in_, name);
    return skip_section(name);
  }
  end_section(name);
}

void MshReader::skip_section(const std::string& name) {
  in_.set_text();
  if (!in_.skip_behind("$End" + name)) in_.fail_end("$End" + name);
}

void MshReader::end_section(const std::string& name) {
  in_.set_text();
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_end("$End" + name);
  if (word != "$End" + name)
    in_.fail("expected $End", name, ", found ", quoted(word),
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
    in_.fail("expected version 2.2 or 4.1, found ", quoted(version),
             "; write the file in one of them, as with gmsh -format msh41");
  binary_ = in_.integer<int>("whether the file is binary, 0 or 1") != 0;
  const int bytes = in_.integer<int>("the size of numbers, 8");
  if (bytes != 8 && (version_ == 2 || bytes != 4))
    in_.fail("expected numbers of 8 bytes, found ", bytes, "; write the file again");
  size_bytes_ = static_cast<std::uint64_t>(bytes);
  if (!binary_) return;
  in_.line();
  in_.set_binary(false);
  const std::int32_t one = number("the number 1, which tells the byte order");
  swapped_ = one == 0x01000000;
  if (one != 1 && !swapped_)
    in_.fail("expected the number 1, which tells the byte order, found ", one,
             "; copy the file again");
}

void MshReader::read_names() {
  const std::uint64_t count = size("the number of names");
  in_.expect_room(count, {3, 12}, "names");
  for (std::uint64_t i = 0; i < count; ++i) {
    ReferenceName name;
    name.dimension = static_cast<int>(in_.integer_within("the dimension of a group", 0, 3));
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
    in_.fail("expected each node once, found node ", node_numbers_[node_index_.repeated()],
             " twice; remove one");
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
  left_out_.tell(warnings_);
  const auto tell = [&](std::size_t count, const char* text) {
    if (count > 0) warn(warnings_, in_.name() + ": " + std::to_string(count) + text);
  };
  tell(between_parts_, " elements between partitions are left out");
  tell(in_parts_, " elements say which partition they are in, which is left out");
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

void MshReader::read_data(NamedField::Place place, const std::string& section) {
  if (!has_nodes_ || (place == NamedField::Place::elements && !has_elements_))
    in_.fail("expected $Nodes and $Elements before $", section, ", found none; put them first");
  const DataHead head = read_data_head();
  const bool at_vertices = place == NamedField::Place::vertices;
  const std::size_t wanted = (at_vertices ? node_numbers_ : element_numbers_).size();
  const bool usable = head.components == 1 || head.components == 3 || head.components == 9;
  if (!usable || head.count < wanted || wanted == 0) {
    left_out_.add(in_, section,
                  " '" + head.name + "' (" + std::to_string(head.components) + " components, " +
                      std::to_string(head.count) + " of " + std::to_string(wanted) + " values)");
    return skip_section(section);
  }
  const auto components = static_cast<std::size_t>(head.components);
  if (!at_vertices && !element_index_) element_index_ = NumberIndex(element_numbers_);
  SpatialField field{head.name, place, components, {}};
  begin_numbers();
  in_.expect_room(head.count, {1 + components, 4 + 8 * components}, "values");
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
  // The last of several steps replaces earlier ones.
  const auto [known, is_new] = field_of_.try_emplace({!at_vertices, head.name}, to_.fields.size());
  if (is_new)
    to_.fields.push_back(std::move(field));
  else
    to_.fields[known->second] = std::move(field);
}

bool is_msh(std::string_view bytes) {
  return bytes.starts_with("$MeshFormat") || bytes.starts_with("$Comments") ||
         bytes.starts_with("$NOD");
}

MeshWithFields read_msh(const FileBytes& bytes, Warnings* warnings) {
  return finish(MshReader(bytes, warnings).read(), warnings);
}

}  // namespace ductile::meshadapt
