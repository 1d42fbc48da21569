#include "formats.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesh/flatten.hpp"
#include "number_reader.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

/// The part of a text before the first of these characters.
std::string_view before(std::string_view text, std::string_view ends) {
  return text.substr(0, text.find_first_of(ends));
}

class Su2Reader {
 public:
  Su2Reader(const FileBytes& bytes, Warnings* warnings) : in_(bytes, '%'), warnings_(warnings) {
    mesh_.name = bytes.name;
  }

  AnyMesh read() {
    while (!in_.peek_word().empty()) read_line();
    expect_whole();
    name_markers();
    left_out_.tell(warnings_);
    return std::move(mesh_);
  }

 private:
  // ---- Rows ----

  /// Goes to the next row that is neither empty nor a comment.
  void begin_row(const char* what) {
    if (in_.peek_word().empty()) in_.fail_end(what);
    row_end_ = std::find(in_.at(), in_.at() + in_.left(), '\n');
  }

  /// The next number of this row.
  template <class Number>
  Number number(const char* what) {
    if (in_.peek_word().data() >= row_end_)
      in_.fail("expected ", what, ", found the end of the line; complete it");
    if constexpr (std::is_floating_point_v<Number>)
      return in_.real(what);
    else
      return in_.integer<Number>(what);
  }

  // ---- Sections ----

  void read_line() {
    const std::string_view line = in_.line();
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      if (in_unknown_section_) return;
      in_.fail("expected a keyword such as NPOIN=, found ", quoted(before(line, "\r")),
               "; correct it, or the count of the section before");
    }
    const std::string_view key = trimmed(line.substr(0, equals));
    in_unknown_section_ = !read_section(key, trimmed(before(line.substr(equals + 1), "%")));
    if (in_unknown_section_) left_out_.add(in_, key);
  }

  /// Returns false if it does not know the section.
  bool read_section(std::string_view key, std::string_view value) {
    if (key == "MARKER_TAG") {
      const std::string tag(before(value, " \t"));
      if (tag.empty()) in_.fail("expected the name of a marker, found none; give it one");
      ++markers_begun_;
      const auto [known, is_new] = place_of_.try_emplace(tag, tags_.size());
      if (is_new) tags_.push_back(tag);
      tag_ = known->second;
      return true;
    }
    if (key == "IZONE") return true;
    constexpr std::array<std::string_view, 6> counts{"NZONE", "NDIME", "NPOIN",
                                                     "NELEM", "NMARK", "MARKER_ELEMS"};
    if (std::ranges::find(counts, key) == counts.end()) return false;
    const std::uint64_t count = count_of(key, value);
    if (key == "NZONE" && count != 1)
      in_.fail("expected one zone, found ", value, "; give a file for each zone");
    if (key == "NDIME") read_dimension(count);
    if (key == "NPOIN") read_points(count);
    if (key == "NELEM") read_elements(count);
    if (key == "NMARK") marker_count_ = count;
    if (key == "MARKER_ELEMS") read_marker(count);
    return true;
  }

  /// A second number that some programs write behind it, a count without other parts, is ignored.
  std::uint64_t count_of(std::string_view key, std::string_view value) const {
    const std::string_view digits = before(value, " \t");
    const auto count = number_in<std::uint64_t>(digits);
    if (!count)
      in_.fail("expected a number behind ", key, "=, found ", quoted(digits), "; correct it");
    return *count;
  }

  void read_dimension(std::uint64_t dimension) {
    if (mesh_.dimension != 0) in_.fail("expected one NDIME=, found a second; remove one");
    if (dimension != 2 && dimension != 3)
      in_.fail("expected dimension 2 or 3, found ", dimension, "; correct it");
    mesh_.dimension = static_cast<int>(dimension);
  }

  void read_points(std::uint64_t count) {
    if (std::exchange(has_points_, true))
      in_.fail("expected one NPOIN=, found a second; remove one");
    if (mesh_.dimension == 0) in_.fail("expected NDIME= before NPOIN=, found none; put it first");
    const auto dimension = static_cast<std::size_t>(mesh_.dimension);
    if (count >= std::numeric_limits<std::uint32_t>::max())
      in_.fail("expected fewer than 4294967295 points, found more; take a smaller mesh");
    in_.expect_room(count, {dimension, 0}, "points");
    mesh_.coordinates.reserve(dimension * count);
    for (std::uint64_t i = 0; i < count; ++i) {
      begin_row("a point");
      for (std::size_t axis = 0; axis < dimension; ++axis)
        mesh_.coordinates.push_back(in_.finite(number<double>("a coordinate")));
      in_.line();  // which may end with its number
    }
    mesh_.vertex_reference.assign(count, 0);
  }

  void read_elements(std::uint64_t count) {
    if (std::exchange(has_elements_, true))
      in_.fail("expected one NELEM=, found a second; remove one");
    if (mesh_.dimension == 0) in_.fail("expected NDIME= before NELEM=, found none; put it first");
    mesh_.dimension == 2 ? read_cells(mesh_.triangles, count, 0)
                         : read_cells(mesh_.tetrahedra, count, 0);
  }

  void read_marker(std::uint64_t count) {
    if (tags_.empty())
      in_.fail("expected MARKER_TAG= before MARKER_ELEMS=, found none; name the marker");
    if (mesh_.dimension == 0) in_.fail("expected NDIME= before markers, found none; put it first");
    const auto place = static_cast<std::int32_t>(tag_);
    mesh_.dimension == 2 ? read_cells(mesh_.edges, count, place)
                         : read_cells(mesh_.triangles, count, place);
  }

  /// Each has a row: VTK's number for its shape, its vertices and, in older files, its own number.
  template <int Corners>
  void read_cells(Cells<Corners>& to, std::uint64_t count, std::int32_t reference) {
    constexpr std::array types{vtk_line, vtk_triangle, vtk_tetrahedron};
    constexpr std::array names{"a line", "a triangle", "a tetrahedron"};
    constexpr int type = types[Corners - 2];
    constexpr const char* name = names[Corners - 2];
    in_.expect_room(count, {1 + Corners, 0}, "elements");
    if (to.size() == 0) {
      to.vertices.reserve(count);
      to.reference.reserve(count);
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      begin_row(name);
      if (const int found = number<int>("the type of an element"); found != type)
        in_.fail("expected ", name, " (type ", type, "), found type ", found,
                 "; split such elements into simplices");
      std::array<std::uint32_t, Corners> corners;
      for (std::uint32_t& corner : corners) corner = number<std::uint32_t>("a point, from 0");
      to.add(corners, reference);
      in_.line();
    }
  }

  // ---- The whole ----

  void expect_whole() const {
    const auto expect = [&](bool has, const char* key) {
      if (!has)
        in_.fail("expected ", key, "=, found none; the file is cut short, write or copy it again");
    };
    expect(mesh_.dimension != 0, "NDIME");
    expect(has_elements_, "NELEM");
    expect(has_points_ && mesh_.vertex_count() > 0, "NPOIN");
    if (marker_count_ && *marker_count_ != markers_begun_)
      in_.fail("expected ", *marker_count_, " markers, by NMARK=, found ", markers_begun_,
               "; correct it, or the file is cut short");
    expect_in_range(mesh_.edges, "line of a marker");
    expect_in_range(mesh_.triangles, mesh_.dimension == 2 ? "triangle" : "triangle of a marker");
    expect_in_range(mesh_.tetrahedra, "tetrahedron");
  }

  template <int Corners>
  void expect_in_range(const Cells<Corners>& cells, const char* what) const {
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (const std::uint32_t corner : cells.vertices[i])
        if (corner >= mesh_.vertex_count())
          throw InputError(in_.name() + ": expected points from 0 to " +
                           std::to_string(mesh_.vertex_count() - 1) + ", found " +
                           std::to_string(corner) + " in " + what + " " + std::to_string(i + 1) +
                           " of the file; correct it, or NPOIN=");
  }

  /// Replaces the references of facets, which are places of their markers in the list so far.
  void name_markers() {
    std::set<std::int32_t> taken;
    for (const std::string& tag : tags_)
      if (const auto number = number_in<std::int32_t>(tag)) taken.insert(*number);
    std::vector<std::int32_t> reference_of;  // [tag]
    std::int32_t next = 1;
    for (const std::string& tag : tags_) {
      if (const auto number = number_in<std::int32_t>(tag)) {
        reference_of.push_back(*number);
        continue;
      }
      while (taken.contains(next)) ++next;
      reference_of.push_back(next);
      mesh_.names.push_back({mesh_.dimension - 1, next++, tag});
    }
    auto& references = mesh_.dimension == 2 ? mesh_.edges.reference : mesh_.triangles.reference;
    for (std::int32_t& reference : references)
      reference = reference_of[static_cast<std::size_t>(reference)];
  }

  NumberReader in_;
  Warnings* warnings_;
  AnyMesh mesh_;
  const char* row_end_ = nullptr;
  bool has_points_ = false, has_elements_ = false;
  bool in_unknown_section_ = false;
  std::optional<std::uint64_t> marker_count_;
  std::uint64_t markers_begun_ = 0;
  std::vector<std::string> tags_;  ///< each once, in their order; facets have their places so far
  std::map<std::string, std::size_t> place_of_;  ///< [tag], in tags_
  std::size_t tag_ = 0;                          ///< place of the marker that is read
  LeftOut left_out_;
};

}  // namespace

bool is_su2(std::string_view bytes) {
  bytes = from_first_word(bytes, '%');
  if (bytes.find_first_of("=\n") == std::string_view::npos) return false;
  const std::string_view key = trimmed(before(bytes, "=\n"));
  constexpr std::array keys{"NDIME", "NZONE", "IZONE", "NELEM", "NPOIN", "NMARK"};
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

MeshWithFields read_su2(const FileBytes& bytes, Warnings* warnings) {
  MeshWithFields file{Su2Reader(bytes, warnings).read(), {}};
  flatten(file.mesh, warnings);
  return file;
}

}  // namespace ductile::meshadapt
