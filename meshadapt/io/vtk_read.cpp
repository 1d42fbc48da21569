#include "formats.hpp"

#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "number_reader.hpp"
#include "vtk_decode.hpp"
#include "vtk_grid.hpp"

namespace ductile::meshadapt {
namespace {

constexpr bool vtk_swapped = std::endian::native == std::endian::little;

/// Decodes a name in which spaces and the like are written as %20.
std::string decoded_name(std::string_view text) {
  std::string name;
  for (std::size_t at = 0; at < text.size(); ++at) {
    int code = 0;
    if (text[at] == '%' && at + 2 < text.size() &&
        std::from_chars(&text[at + 1], &text[at + 3], code, 16).ptr == &text[at + 3]) {
      name.push_back(static_cast<char>(code));
      at += 2;
    } else {
      name.push_back(text[at]);
    }
  }
  return name;
}

class VtkReader {
 public:
  explicit VtkReader(const FileBytes& bytes) : in_(bytes) { grid_.name = bytes.name; }

  VtkGrid read() {
    read_head();
    for (;;) {
      const std::string word(in_.word().substr(0, 40));
      if (word.empty()) break;
      read_part(word);
    }
    expect_counts();
    return std::move(grid_);
  }

 private:
  enum class Data { none, points, cells };
  /// A part that a file has at most once, and the count that it gives.
  struct Part {
    std::string where;
    std::uint64_t count = 0;
  };

  std::uint64_t count(const char* what) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max() / 16;
    return static_cast<std::uint64_t>(in_.integer_within(what, 0, most));
  }
  /// Numbers follow here, or on the next line.
  void begin_numbers_here() {
    if (binary_) in_.set_binary(vtk_swapped);
  }
  void begin_numbers() {
    in_.line();
    begin_numbers_here();
  }
  void read_head() {
    in_.line();
    in_.line();  // a title
    const std::string_view form = in_.word();
    if (form != "ASCII" && form != "BINARY")
      in_.fail("expected ASCII or BINARY, found ", quoted(form), "; write the file again");
    binary_ = form == "BINARY";
  }

  void begin_part(const std::string& word) {
    if (!parts_.try_emplace(word, Part{in_.where(), 0}).second)
      in_.fail("expected one part ", word, ", found a second; remove one, or join them");
  }

  /// Compares the counts of parts when all have been read, because they come in any order.
  void expect_counts() const {
    const auto expect = [&](const char* word, std::size_t there, const char* what) {
      const auto part = parts_.find(word);
      if (part != parts_.end() && part->second.count != there)
        throw InputError(part->second.where + "expected a count of " + std::to_string(there) +
                         " behind " + word + ", as many as there are " + what + ", found " +
                         std::to_string(part->second.count) + "; correct it");
    };
    expect("CELL_TYPES", grid_.ends.size(), "cells");
    expect("POINT_DATA", grid_.points.size() / 3, "points");
    expect("CELL_DATA", grid_.ends.size(), "cells");
  }

  void read_part(const std::string& word) {
    if (word == "DATASET" || word == "POINTS" || word == "CELLS" || word == "CELL_TYPES" ||
        word == "POINT_DATA" || word == "CELL_DATA")
      begin_part(word);
    if (word == "DATASET") {
      if (const std::string_view kind = in_.word(); kind != "UNSTRUCTURED_GRID")
        in_.fail("expected DATASET UNSTRUCTURED_GRID, found ", quoted(kind),
                 "; write an unstructured grid");
    } else if (word == "POINTS") {
      read_points();
    } else if (word == "CELLS") {
      read_cells();
    } else if (word == "CELL_TYPES") {
      read_types();
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      data_ = word == "POINT_DATA" ? Data::points : Data::cells;
      parts_[word].count = data_count_ = count("a count of values");
    } else if (word == "FIELD") {
      read_field();
    } else if (word == "METADATA") {
      skip_metadata();
    } else {
      read_attribute(word);
    }
  }

  void read_points() {
    const std::uint64_t points = count("a count of points");
    const std::string type(in_.word());
    begin_numbers();
    grid_.points = values(3 * points, type);
  }

  std::vector<std::int64_t> indices(std::uint64_t how_many, bool wide) {
    in_.expect_room(how_many, {1, wide ? 8U : 4U}, "numbers");
    std::vector<std::int64_t> result(static_cast<std::size_t>(how_many));
    for (std::int64_t& index : result)
      index = wide ? in_.integer<std::int64_t>("a number of a cell")
                   : in_.integer<std::int32_t>("a number of a cell");
    in_.set_text();
    return result;
  }

  void read_cells() {
    const std::uint64_t cells = count("a count of cells"), size = count("a count of numbers");
    in_.line();
    if (in_.peek_word() == "OFFSETS") return read_cells_with_offsets(cells, size);
    begin_numbers_here();
    const std::vector<std::int64_t> list = indices(size, false);
    grid_.connectivity.reserve(list.size());
    for (std::size_t at = 0; at < list.size();) {
      const std::int64_t corners = list[at++];
      if (corners < 0 || static_cast<std::uint64_t>(corners) > list.size() - at)
        in_.fail("expected the points of a cell, found a count of ", corners,
                 " that does not fit; correct the list");
      for (std::int64_t i = 0; i < corners; ++i) grid_.connectivity.push_back(list[at++]);
      grid_.ends.push_back(static_cast<std::int64_t>(grid_.connectivity.size()));
    }
    if (grid_.ends.size() != cells)
      in_.fail("expected ", cells, " cells, found ", grid_.ends.size(), "; correct the count");
  }

  /// Reads cells of version 5.1: the offset of each, the end of the last one, then the points.
  void read_cells_with_offsets(std::uint64_t offsets, std::uint64_t points) {
    in_.word();
    bool wide = in_.word() == "vtktypeint64";
    begin_numbers();
    grid_.ends = indices(offsets, wide);
    if (!grid_.ends.empty()) grid_.ends.erase(grid_.ends.begin());
    if (const std::string_view word = in_.word(); word != "CONNECTIVITY")
      in_.fail("expected CONNECTIVITY, found ", meshadapt::quoted(word),
               "; correct the count of offsets");
    wide = in_.word() == "vtktypeint64";
    begin_numbers();
    grid_.connectivity = indices(points, wide);
  }

  void read_types() {
    const std::uint64_t cells = count("a count of cells");
    parts_["CELL_TYPES"].count = cells;
    begin_numbers();
    grid_.types = indices(cells, false);
  }

  std::vector<double> values(std::uint64_t how_many, const std::string& type) {
    const NumberKind number = number_kind(type);
    if (number.bytes == 0)
      in_.fail("expected a type of numbers, such as double, found ", meshadapt::quoted(type),
               "; write the array in another");
    in_.expect_room(how_many, {1, number.bytes}, "numbers");
    whole_ = !number.is_real;
    std::vector<double> result;
    if (binary_) {
      const auto size = static_cast<std::size_t>(how_many * number.bytes);
      result = vtk_reals(in_.bytes(size, "an array"), number, vtk_swapped);
    } else {
      result.resize(static_cast<std::size_t>(how_many));
      for (double& value : result) value = in_.real("a number of an array");
    }
    in_.set_text();
    return result;
  }

  /// Skips texts. In binary files each has its length in front, whose first two bits say how long
  /// that is.
  void skip_texts(std::uint64_t how_many) {
    for (std::uint64_t i = 0; i < how_many && in_.left() > 0; ++i) {
      if (!binary_) {
        in_.line();
        continue;
      }
      const auto head = in_.integer<std::uint8_t>("the length of a text");
      std::uint64_t length = head & 63U;
      for (unsigned more = 1; more < 8U >> (head >> 6U); ++more)
        length = length << 8U | in_.integer<std::uint8_t>("the length of a text");
      in_.expect_room(length, {1, 1}, "letters");
      in_.bytes(static_cast<std::size_t>(length), "a text");
    }
    in_.set_text();
  }

  /// Reads an array, and keeps it unless it belongs to nothing.
  void read_array(std::string name, std::uint64_t components, std::uint64_t tuples,
                  const std::string& type) {
    in_.expect_room(tuples, {components, components}, "values");
    std::vector<double> found = values(tuples * components, type);
    if (data_ == Data::none || tuples != data_count_) return;
    auto& arrays = data_ == Data::points ? grid_.point_data : grid_.cell_data;
    arrays.push_back(
        {std::move(name), static_cast<std::size_t>(components), std::move(found), whole_});
  }

  void read_scalars() {
    const std::string name = decoded_name(in_.word()), type(in_.word());
    const std::string_view more = in_.line();
    std::uint64_t components = 1;
    const std::size_t at = more.find_first_of("123456789");
    if (at != std::string_view::npos) components = static_cast<std::uint64_t>(more[at] - '0');
    if (in_.peek_word() == "LOOKUP_TABLE") in_.line();
    begin_numbers_here();
    read_array(name, components, data_count_, type);
  }

  void read_lookup_table() {
    in_.word();
    const std::uint64_t colours = count("a number of colours");
    begin_numbers();
    in_.expect_room(colours, {4, 4}, "colours");
    values(4 * colours, binary_ ? "unsigned_char" : "float");
  }

  /// Reads scalars, vectors or tensors, each of which has a keyword.
  void read_attribute(const std::string& word) {
    if (word == "SCALARS") return read_scalars();
    if (word == "LOOKUP_TABLE") return read_lookup_table();
    const bool is_vector = word == "VECTORS" || word == "NORMALS";
    const std::uint64_t components = is_vector            ? 3
                                     : word == "TENSORS"  ? 9
                                     : word == "TENSORS6" ? 6
                                                          : 0;
    if (components == 0)
      in_.fail("expected the beginning of a part, such as POINTS, found ", meshadapt::quoted(word),
               "; correct it, or the count of the part before");
    const std::string name = decoded_name(in_.word()), type(in_.word());
    begin_numbers();
    read_array(name, components, data_count_, type);
  }

  void read_field() {
    in_.word();
    const std::uint64_t arrays = count("a count of arrays");
    for (std::uint64_t i = 0; i < arrays; ++i) {
      while (in_.peek_word() == "METADATA") {
        in_.word();
        skip_metadata();
      }
      if (in_.peek_word().empty()) in_.fail_end("an array");
      const std::string name = decoded_name(in_.word());
      const std::uint64_t components = count("a number of components"),
                          tuples = count("a number of tuples");
      const std::string type(in_.word());
      begin_numbers();
      in_.expect_room(tuples, {components, components}, "values");
      if (type == "string")
        skip_texts(tuples * components);
      else if (name == "names" && data_ == Data::none)
        grid_.names = values(tuples * components, type);
      else
        read_array(name, components, tuples, type);
    }
  }

  /// Goes to the empty line that ends the metadata.
  void skip_metadata() {
    in_.line();
    while (in_.left() > 0 && !in_.line().empty()) {
    }
  }

  NumberReader in_;
  VtkGrid grid_;
  bool binary_ = false;
  Data data_ = Data::none;
  std::uint64_t data_count_ = 0;
  std::map<std::string, Part> parts_;
  bool whole_ = false;  // the last numbers that were read
};

}  // namespace

bool is_vtk(std::string_view bytes) { return bytes.starts_with("# vtk DataFile"); }

MeshWithFields read_vtk(const FileBytes& bytes, Warnings* warnings) {
  return finish(mesh_of(VtkReader(bytes).read()), warnings);
}

}  // namespace ductile::meshadapt
