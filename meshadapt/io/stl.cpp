/// @file
/// STL: the triangles of a surface, each with the coordinates of its corners; text or binary.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "file_surface.hpp"
#include "formats.hpp"
#include "number_reader.hpp"
#include "point_map.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {
namespace {

constexpr std::size_t head_size = 80, facet_size = 50;
constexpr bool stl_swapped = std::endian::native != std::endian::little;

/// A binary file has 80 bytes of any kind, a count, and 50 bytes for each triangle.
bool is_binary(std::string_view bytes) {
  return bytes.size() >= head_size + 4 &&
         bytes.size() == head_size + 4 +
                             facet_size * std::size_t{loaded<std::uint32_t>(
                                              bytes.data() + head_size, stl_swapped)};
}

class StlReader {
 public:
  explicit StlReader(const FileBytes& bytes) : bytes_(bytes), in_(bytes), faces_(bytes) {}

  MeshWithFields read(Warnings* warnings) {
    is_binary({bytes_.begin(), bytes_.size}) ? read_binary() : read_text();
    AnyMesh& mesh = faces_.mesh;
    if (solids_ == 1) {
      mesh.triangles.reference.assign(mesh.triangles.size(), 0);
      mesh.names.clear();
    }
    return faces_.finish(in_, warnings);
  }

 private:
  void read_binary() {
    solids_ = 1;
    in_.set_binary(stl_swapped);
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
      if (!name.empty()) faces_.mesh.names.push_back({2, solids_, name});
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
    in_.fail("expected ", quoted(word), ", found ", quoted(found), "; correct it");
  }

  /// Points with the same coordinates become one vertex, in the order in which they first come.
  void add_triangle(auto&& coordinate) {
    std::array<std::uint32_t, 3> corners;
    for (std::uint32_t& corner : corners) {
      std::array<double, 3> point;
      for (double& x : point) x = in_.finite(coordinate()) + 0.0;  // -0 is 0
      const auto [at, is_new] =
          number_of_.try_emplace(point, static_cast<std::uint32_t>(number_of_.size()));
      auto& all = faces_.mesh.coordinates;
      if (is_new) all.insert(all.end(), point.begin(), point.end());
      corner = at->second;
    }
    faces_.add(in_, corners, solids_);
  }

  const FileBytes& bytes_;
  NumberReader in_;
  FaceCollector faces_;
  PointMap<std::uint32_t> number_of_;
  std::int32_t solids_ = 0;
};

// ---- Writing ----

using Triangle = std::array<Vector<3>, 3>;

Vector<3> normal_of(const Triangle& p) {
  const Vector<3> n = cross(p[1] - p[0], p[2] - p[0]);
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!(length > 0 && std::isfinite(length))) return {};
  return {{n[0] / length, n[1] / length, n[2] / length}};
}

Triangle points_of(const FileSurface& surface, std::size_t triangle) {
  Triangle points;
  for (std::size_t i = 0; i < 3; ++i)
    std::ranges::copy(surface.point(surface.triangles.vertices[triangle][i]), points[i].x.begin());
  return points;
}

void put_binary(Sink& sink, const FileSurface& surface) {
  std::string head = "binary STL by Ductile";
  head.resize(head_size, ' ');
  sink.write(head);
  sink.set_binary(std::endian::little);
  sink.put(static_cast<std::uint32_t>(surface.triangles.size()));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle p = points_of(surface, t);
    for (const Vector<3>& vector : {normal_of(p), p[0], p[1], p[2]})
      for (const double x : vector.x) sink.put(static_cast<float>(x));
    sink.put(std::uint16_t{0});
  }
}

void put_text(Sink& sink, const FileSurface& surface) {
  sink.set_text("\n");
  sink.write("solid Ductile\n");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle points = points_of(surface, t);
    sink.write("facet normal ");
    sink.record(normal_of(points).x);
    sink.write("outer loop\n");
    for (const Vector<3>& point : points) {
      sink.write("vertex ");
      sink.record(point.x);
    }
    sink.write("endloop\nendfacet\n");
  }
  sink.write("endsolid Ductile\n");
}

void expect_single(const std::vector<double>& coordinates, const std::filesystem::path& path) {
  for (const double x : coordinates)
    if (std::abs(x) > std::numeric_limits<float>::max())
      throw InputError(path.string() +
                       ": expected coordinates that single precision holds, found a larger one; "
                       "write another format");
}

}  // namespace

bool is_stl(std::string_view bytes) {
  if (is_binary(bytes)) return true;
  const std::string begin =
      lower(from_first_word(bytes, NumberReader::no_comments).substr(0, 1024));
  return begin.starts_with("solid") &&
         (begin.find("facet") != std::string::npos || begin.find("endsolid") != std::string::npos);
}

MeshWithFields read_stl(const FileBytes& bytes, Warnings* warnings) {
  return StlReader(bytes).read(warnings);
}

void write_stl(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path, options);
  if (surface.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(path.string() + ": too many triangles for this format; write another");
  if (mesh.tetrahedra.size() == 0) warn_of_lost(options, path, "references");
  const bool is_text = options.form == WriteOptions::Form::ascii;
  if (!is_text) expect_single(surface.coordinates, path);
  Sink& sink = outputs.stage(path);
  is_text ? put_text(sink, surface) : put_binary(sink, surface);
}

}  // namespace ductile::meshadapt
