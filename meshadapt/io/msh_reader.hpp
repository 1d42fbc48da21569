/// @file
/// MshReader: reads a Gmsh file section by section (private to io). Versions differ in how sections
/// hold nodes and elements; groups, fields and the frames of sections are the same.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msh_cells.hpp"
#include "number_reader.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Thread safety: one thread.
class MshReader {
 public:
  MshReader(const FileBytes& bytes, Warnings* warnings) : in_(bytes), warnings_(warnings) {
    to_.mesh.dimension = 3;
    to_.mesh.name = bytes.name;
  }

  SpatialMesh read();

 private:
  // ---- Sections ----
  void read_section(const std::string& name);
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
    GroupSet physical;
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
  void read_data(NamedField::Place place, const std::string& section);

  // ---- Numbers ----
  void begin_numbers() {
    if (binary_) in_.set_binary(swapped_);
  }
  std::int32_t number(const char* what) { return in_.integer<std::int32_t>(what); }
  /// A number that the format calls size_t.
  std::uint64_t size(const char* what) {
    if (in_.is_binary())
      return size_bytes_ == 4 ? in_.integer<std::uint32_t>(what) : in_.integer<std::uint64_t>(what);
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    return static_cast<std::uint64_t>(in_.integer_within(what, 0, most));
  }
  void read_point() {
    for (int axis = 0; axis < 3; ++axis) to_.mesh.coordinates.push_back(in_.real("a coordinate"));
  }

  NumberReader in_;
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
  LeftOut left_out_;
  std::size_t between_parts_ = 0, in_parts_ = 0;
};

}  // namespace ductile::meshadapt
