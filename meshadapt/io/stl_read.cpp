#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "formats.hpp"
#include "number_reader.hpp"
#include "weld.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::size_t head_size = 80, facet_size = 50;

/// A binary file has 80 bytes of any kind, a count, and 50 bytes for each triangle.
bool is_binary(std::string_view bytes) {
  constexpr bool swapped = std::endian::native != std::endian::little;
  return bytes.size() >= head_size + 4 &&
         bytes.size() ==
             head_size + 4 +
                 facet_size * std::size_t{loaded<std::uint32_t>(bytes.data() + head_size, swapped)};
}

class StlReader {
 public:
  explicit StlReader(const FileBytes& bytes) : bytes_(bytes), in_(bytes) {
    spatial_.mesh.dimension = 3;
    spatial_.mesh.name = bytes.name;
  }

  SpatialMesh read() {
    if (is_binary({bytes_.begin(), bytes_.size}))
      read_binary();
    else
      read_text();
    AnyMesh& mesh = spatial_.mesh;
    if (mesh.triangles.size() == 0)
      in_.fail("expected triangles, found none; write the file again");
    if (solids_ == 1) {
      mesh.triangles.reference.assign(mesh.triangles.size(), 0);
      mesh.names.clear();
    }
    mesh.coordinates = weld_.take_coordinates();
    mesh.vertex_reference.assign(mesh.coordinates.size() / 3, 0);
    return std::move(spatial_);
  }

 private:
  void read_binary() {
    solids_ = 1;
    in_.set_binary(std::endian::native != std::endian::little);
    in_.go_to(head_size);
    const auto count = in_.integer<std::uint32_t>("the number of triangles");
    for (std::uint32_t t = 0; t < count; ++t) {
      in_.bytes(3 * sizeof(float), "a normal");
      add_triangle([&] {
        float x = 0;
        in_.take(x);
        return static_cast<double>(x);
      });
      in_.bytes(2, "the end of a triangle");
    }
  }

  /// Several solids get the references 1, 2 and so on.
  void read_text() {
    while (!in_.peek_word().empty()) {
      expect("solid");
      const std::string name(trimmed(in_.line()));
      ++solids_;
      if (!name.empty()) spatial_.mesh.names.push_back({2, solids_, name});
      while (lower(in_.peek_word()) == "facet") read_facet();
      expect("endsolid");
      in_.line();
    }
  }

  void read_facet() {
    for (const char* word : {"facet", "normal"}) expect(word);
    for (int i = 0; i < 3; ++i) in_.word();  // which may be no number
    for (const char* word : {"outer", "loop"}) expect(word);
    int at = 0;
    add_triangle([&] {
      if (at++ % 3 == 0) expect("vertex");
      return in_.real("a coordinate");
    });
    for (const char* word : {"endloop", "endfacet"}) expect(word);
  }

  void expect(const char* word) {
    const std::string_view found = in_.word();
    if (lower(found) == word) return;
    if (found.empty()) in_.fail_end(quoted(word));
    in_.fail("expected " + quoted(word) + ", found " + quoted(found) + "; correct it");
  }

  static std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
  }

  void add_triangle(auto&& coordinate) {
    std::array<std::uint32_t, 3> corners;
    for (std::uint32_t& corner : corners) {
      Weld::Point point;
      for (double& x : point) {
        x = coordinate();
        if (!std::isfinite(x)) in_.fail("expected a finite coordinate, found another; correct it");
      }
      corner = weld_.number_of(point);
    }
    spatial_.mesh.triangles.add(corners, solids_);
  }

  const FileBytes& bytes_;
  NumberReader in_;
  SpatialMesh spatial_;
  Weld weld_;
  std::int32_t solids_ = 0;
};

}  // namespace

bool is_stl(std::string_view bytes) {
  if (is_binary(bytes)) return true;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  const std::string begin = lower(bytes.substr(first, 1024));
  return begin.starts_with("solid") &&
         (begin.find("facet") != std::string::npos || begin.find("endsolid") != std::string::npos);
}

SpatialMesh read_stl(const FileBytes& bytes, Warnings*) { return StlReader(bytes).read(); }

}  // namespace ductile::meshadapt
