/// @file
/// PLY: vertices and faces of a surface with any properties, of which coordinates, corners and a
/// reference of faces are read; text, or binary in either byte order.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats.hpp"
#include "number_reader.hpp"
#include "sink.hpp"
#include "surface_of.hpp"

namespace ductile::meshadapt {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                  {"uchar", "uint8"},
                                                                  {"short", "int16"},
                                                                  {"ushort", "uint16"},
                                                                  {"int", "int32"},
                                                                  {"uint", "uint32"},
                                                                  {"float", "float32"},
                                                                  {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i][0] || name == names[i][1]) return static_cast<PlyType>(i);
  return std::nullopt;
}

struct Property {
  std::string name;
  PlyType type;
  std::optional<PlyType> count;  ///< that of the number of entries; none if it is no list
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(const FileBytes& bytes, Warnings* warnings) : in_(bytes), warnings_(warnings) {
    mesh_.dimension = 3;
    mesh_.name = bytes.name;
  }

  SpatialMesh read() {
    read_header();
    for (const Element& element : elements_) read_element(element);
    if (mesh_.triangles.size() == 0) in_.fail("expected faces, found none; write the file again");
    const auto count = static_cast<std::uint32_t>(mesh_.coordinates.size() / 3);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles.vertices[t])
        if (v >= count)
          in_.fail("expected vertices below " + std::to_string(count) + ", found " +
                   std::to_string(v) + " in triangle " + std::to_string(t + 1) + "; correct it");
    mesh_.vertex_reference.assign(count, 0);
    if (cut_ > 0 && warnings_)
      warnings_->push_back(printable(mesh_.name + ": " + std::to_string(cut_) +
                                     " faces of more than three corners were cut into triangles"));
    return {std::move(mesh_), {}, {}, {}};
  }

 private:
  // ---- Header ----

  void read_header() {
    in_.line();  // "ply"
    for (bool more = true; more;) {
      const std::string_view key = in_.word();
      if (key.empty()) in_.fail_end("end_header");
      more = key != "end_header";
      if (key == "format") read_format();
      if (key == "element") read_element_head();
      if (key == "property") read_property();
      in_.line();
    }
    if (binary_) in_.set_binary(*binary_ != std::endian::native);
  }

  void read_format() {
    const std::string_view form = in_.word();
    if (form == "binary_little_endian")
      binary_ = std::endian::little;
    else if (form == "binary_big_endian")
      binary_ = std::endian::big;
    else if (form != "ascii")
      in_.fail("expected ascii, binary_little_endian or binary_big_endian, found " + quoted(form) +
               "; correct it");
  }

  void read_element_head() {
    std::string name(in_.word());
    elements_.push_back({std::move(name), in_.integer<std::uint64_t>("a number of elements"), {}});
  }

  PlyType read_type() {
    const std::string_view name = in_.word();
    if (const auto type = type_named(name)) return *type;
    in_.fail("expected a type such as float, found " + quoted(name) + "; correct it");
  }

  void read_property() {
    if (elements_.empty()) in_.fail("expected an element before its properties, found none");
    Property property{};
    if (in_.peek_word() == "list") {
      in_.word();
      property.count = read_type();
    }
    property.type = read_type();
    property.name = std::string(in_.word());
    elements_.back().properties.push_back(std::move(property));
  }

  // ---- Elements ----

  double number(PlyType type) {
    if (!binary_) return in_.real("a number");
    switch (type) {
      case PlyType::int8:
        return in_.integer<std::int8_t>("a number");
      case PlyType::uint8:
        return in_.integer<std::uint8_t>("a number");
      case PlyType::int16:
        return in_.integer<std::int16_t>("a number");
      case PlyType::uint16:
        return in_.integer<std::uint16_t>("a number");
      case PlyType::int32:
        return in_.integer<std::int32_t>("a number");
      case PlyType::uint32:
        return in_.integer<std::uint32_t>("a number");
      case PlyType::float32: {
        float x = 0;
        if (!in_.take(x)) in_.fail_end("a number");
        return x;
      }
      case PlyType::float64:
        return in_.real("a number");
    }
    return 0;
  }

  /// A whole number from 0 on, such as a count or a vertex.
  std::uint32_t index(PlyType type, const char* what) {
    const double value = number(type);
    if (!(value >= 0 && value < std::numeric_limits<std::uint32_t>::max()) ||
        value != std::floor(value))
      in_.fail(std::string("expected ") + what + ", found another number; correct it");
    return static_cast<std::uint32_t>(value);
  }

  void read_element(const Element& element) {
    if (element.properties.empty()) return;
    in_.expect_room(element.count, {element.properties.size(), element.properties.size()},
                    element.name);
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (is_vertex) mesh_.coordinates.assign(3 * element.count, 0);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::int32_t reference = 0;
      corners_.clear();
      for (const Property& property : element.properties) {
        if (property.count) {
          read_list(property, is_face);
          continue;
        }
        const double value = number(property.type);
        if (is_vertex) place(i, property.name, value);
        if (is_face && property.name == "reference") reference = static_cast<std::int32_t>(value);
      }
      if (is_face) add_face(reference);
    }
  }

  void place(std::uint64_t vertex, const std::string& axis, double value) {
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return;
    if (!std::isfinite(value)) in_.fail("expected a finite coordinate, found another; correct it");
    mesh_.coordinates[3 * vertex + static_cast<std::size_t>(axis[0] - 'x')] = value;
  }

  void read_list(const Property& property, bool is_face) {
    const bool are_corners =
        is_face && (property.name == "vertex_indices" || property.name == "vertex_index");
    const std::uint32_t count = index(*property.count, "a number of entries");
    for (std::uint32_t k = 0; k < count; ++k)
      if (are_corners)
        corners_.push_back(index(property.type, "a vertex, from 0"));
      else
        number(property.type);
  }

  void add_face(std::int32_t reference) {
    if (corners_.size() < 3)
      in_.fail("expected three corners or more, found " + std::to_string(corners_.size()) +
               "; correct the face");
    for (std::size_t i = 2; i < corners_.size(); ++i)
      mesh_.triangles.add({corners_[0], corners_[i - 1], corners_[i]}, reference);
    cut_ += corners_.size() > 3;
  }

  NumberReader in_;
  Warnings* warnings_;
  AnyMesh mesh_;
  std::vector<Element> elements_;
  std::optional<std::endian> binary_;
  std::vector<std::uint32_t> corners_;  // of a face
  std::size_t cut_ = 0;
};

}  // namespace

bool is_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

SpatialMesh read_ply(const FileBytes& bytes, Warnings* warnings) {
  return PlyReader(bytes, warnings).read();
}

void write_ply(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path);
  if (mesh.tetrahedra.size() > 0) warn_of_lost(options, path, "references and the inside");
  const bool is_text = options.form == WriteOptions::Form::ascii;
  Sink& sink = outputs.stage(path);
  sink.write(std::string("ply\nformat ") + (is_text ? "ascii" : "binary_little_endian") +
             " 1.0\nelement vertex " + std::to_string(surface.coordinates.size() / 3) +
             "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
             std::to_string(surface.triangles.size()) +
             "\nproperty list uchar int vertex_indices\nproperty int reference\nend_header\n");
  if (is_text)
    sink.set_text("\n");
  else
    sink.set_binary(std::endian::little);
  for (std::size_t i = 0; i < surface.coordinates.size(); i += 3)
    sink.record(
        std::array{surface.coordinates[i], surface.coordinates[i + 1], surface.coordinates[i + 2]});
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    sink.record(std::uint8_t{3}, surface.triangles.vertices[t], surface.triangles.reference[t]);
}

}  // namespace ductile::meshadapt
