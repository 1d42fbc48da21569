/// @file
/// PLY: vertices and faces of a surface with any properties, of which coordinates, corners and a
/// reference of faces are read; text, or binary in either byte order.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file_surface.hpp"
#include "formats.hpp"
#include "number_reader.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {
namespace {

struct Property {
  std::string name;
  NumberKind kind;
  std::optional<NumberKind> count;  ///< that of the number of entries; none if it is no list
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  explicit PlyReader(const FileBytes& bytes) : in_(bytes), faces_(bytes) {}

  MeshWithFields read(Warnings* warnings) {
    read_header();
    for (const Element& element : elements_) read_element(element);
    const AnyMesh& mesh = faces_.mesh;
    const std::size_t count = mesh.coordinates.size() / 3;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles.vertices[t])
        if (v >= count)
          in_.fail("expected vertices below ", count, ", found ", v, " in triangle ", t + 1,
                   "; correct it");
    return faces_.finish(in_, warnings);
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
      in_.fail("expected ascii, binary_little_endian or binary_big_endian, found ", quoted(form),
               "; correct it");
  }

  void read_element_head() {
    std::string name(in_.word());
    elements_.push_back({std::move(name), in_.integer<std::uint64_t>("a number of elements"), {}});
  }

  NumberKind read_kind() {
    const std::string_view name = in_.word();
    const NumberKind kind = number_kind(name);
    if (kind.bytes == 0)
      in_.fail("expected a type such as float, found ", quoted(name), "; correct it");
    return kind;
  }

  void read_property() {
    if (elements_.empty()) in_.fail("expected an element before its properties, found none");
    Property property{};
    if (in_.peek_word() == "list") {
      in_.word();
      property.count = read_kind();
    }
    property.kind = read_kind();
    property.name = std::string(in_.word());
    elements_.back().properties.push_back(std::move(property));
  }

  // ---- Elements ----

  double number(NumberKind kind) {
    if (!binary_) return in_.real("a number");
    return visit_number(kind, [&](auto value) {
      if (!in_.take(value)) in_.fail_end("a number");
      return static_cast<double>(value);
    });
  }

  /// A whole number from 0 on, such as a count or a vertex.
  std::uint32_t index(NumberKind kind, const char* what) {
    const double value = number(kind);
    if (!(value >= 0 && value < std::numeric_limits<std::uint32_t>::max()) ||
        value != std::floor(value))
      in_.fail("expected ", what, ", found another number; correct it");
    return static_cast<std::uint32_t>(value);
  }

  void read_element(const Element& element) {
    if (element.properties.empty()) return;
    in_.expect_room(element.count, {element.properties.size(), element.properties.size()},
                    element.name);
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (is_vertex) faces_.mesh.coordinates.assign(3 * element.count, 0);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::int32_t reference = 0;
      corners_.clear();
      for (const Property& property : element.properties) {
        if (property.count) {
          read_list(property, is_face);
          continue;
        }
        const double value = number(property.kind);
        if (is_vertex) place(i, property.name, value);
        if (is_face && property.name == "reference") reference = static_cast<std::int32_t>(value);
      }
      if (is_face) faces_.add(in_, corners_, reference);
    }
  }

  void place(std::uint64_t vertex, const std::string& axis, double value) {
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') return;
    const auto k = static_cast<std::size_t>(axis[0] - 'x');
    faces_.mesh.coordinates[3 * vertex + k] = in_.finite(value);
  }

  void read_list(const Property& property, bool is_face) {
    const bool are_corners =
        is_face && (property.name == "vertex_indices" || property.name == "vertex_index");
    const std::uint32_t count = index(*property.count, "a number of entries");
    for (std::uint32_t k = 0; k < count; ++k)
      if (are_corners)
        corners_.push_back(index(property.kind, "a vertex, from 0"));
      else
        number(property.kind);
  }

  NumberReader in_;
  FaceCollector faces_;
  std::vector<Element> elements_;
  std::optional<std::endian> binary_;
  std::vector<std::uint32_t> corners_;  // of a face
};

}  // namespace

bool is_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

MeshWithFields read_ply(const FileBytes& bytes, Warnings* warnings) {
  return PlyReader(bytes).read(warnings);
}

void write_ply(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path, options);
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
  for (std::size_t vertex = 0; 3 * vertex < surface.coordinates.size(); ++vertex)
    sink.record(surface.point(vertex));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    sink.record(std::uint8_t{3}, surface.triangles.vertices[t], surface.triangles.reference[t]);
}

}  // namespace ductile::meshadapt
