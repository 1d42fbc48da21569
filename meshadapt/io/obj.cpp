/// @file
/// Wavefront OBJ: the vertices and faces of a surface, whose groups are references.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "file_surface.hpp"
#include "formats.hpp"
#include "mesh/names.hpp"
#include "number_reader.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const FileBytes& bytes) : in_(bytes, '#'), faces_(bytes) {}

  MeshWithFields read(Warnings* warnings) {
    while (!in_.peek_word().empty()) read_line();
    return faces_.finish(in_, warnings);
  }

 private:
  /// Other lines, such as normals and materials, say nothing of the mesh.
  void read_line() {
    const std::string_view key = in_.word();
    if (key == "v") read_vertex();
    if (key == "f") return read_face();
    if (key == "g") return read_group();
    in_.line();
  }

  void read_vertex() {
    for (int axis = 0; axis < 3; ++axis)
      faces_.mesh.coordinates.push_back(in_.finite(in_.real("a coordinate")));
  }

  void read_face() {
    corners_.clear();
    while (in_.first_on_line() != 0) corners_.push_back(corner_in(in_.word()));
    faces_.add(in_, corners_, group_);
  }

  /// "7", or "7/2/5" with those of a texture and a normal; from -1 they count back.
  std::uint32_t corner_in(std::string_view word) const {
    const auto number = number_in<std::int64_t>(word.substr(0, word.find('/')));
    const auto count = static_cast<std::int64_t>(faces_.mesh.coordinates.size() / 3);
    const std::int64_t corner = !number ? 0 : *number < 0 ? count + *number + 1 : *number;
    if (corner < 1 || corner > count)
      in_.fail("expected a vertex from 1 to the ", count, " so far, found ", quoted(word),
               "; correct the face");
    return static_cast<std::uint32_t>(corner - 1);
  }

  void read_group() {
    const std::string name(trimmed(in_.line()));
    if (const auto number = number_in<std::int32_t>(name)) {
      group_ = *number;
      return;
    }
    const auto next = static_cast<std::int32_t>(reference_of_.size() + 1);
    const auto [at, is_new] = reference_of_.try_emplace(name, next);
    group_ = at->second;
    if (is_new && !name.empty()) faces_.mesh.names.push_back({2, group_, name});
  }

  NumberReader in_;
  FaceCollector faces_;
  std::map<std::string, std::int32_t> reference_of_;  // [group], of those that are no numbers
  std::vector<std::uint32_t> corners_;                // of a face
  std::int32_t group_ = 0;
};

}  // namespace

bool is_obj(std::string_view bytes) {
  bytes = from_first_word(bytes, '#');
  const std::string_view word = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
  constexpr std::array<std::string_view, 8> words{"v", "vn", "vt",     "o",
                                                  "g", "s",  "mtllib", "usemtl"};
  return std::find(words.begin(), words.end(), word) != words.end() &&
         (bytes.find("\nf ") != std::string_view::npos ||
          bytes.find("\nf\t") != std::string_view::npos);
}

MeshWithFields read_obj(const FileBytes& bytes, Warnings* warnings) {
  return ObjReader(bytes).read(warnings);
}

void write_obj(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path, options);
  const auto& references = surface.triangles.reference;
  const bool grouped =
      std::any_of(references.begin(), references.end(), [](std::int32_t r) { return r != 0; });
  Sink& sink = outputs.stage(path);
  sink.set_text("\n");
  for (std::size_t vertex = 0; 3 * vertex < surface.coordinates.size(); ++vertex) {
    sink.write("v ");
    sink.record(surface.point(vertex));
  }
  for (std::size_t t = 0; t < references.size(); ++t) {
    if (grouped && (t == 0 || references[t] != references[t - 1])) {
      const std::string name = joined_names(mesh, 2, references[t]);
      sink.write("g " + (name.empty() ? std::to_string(references[t]) : name) + "\n");
    }
    const auto [a, b, c] = surface.triangles.vertices[t];
    sink.write("f ");
    sink.record(std::uint64_t{a} + 1, std::uint64_t{b} + 1, std::uint64_t{c} + 1);
  }
}

}  // namespace ductile::meshadapt
