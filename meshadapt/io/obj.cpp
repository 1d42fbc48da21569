/// @file
/// Wavefront OBJ: the vertices and faces of a surface, whose groups are references.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "formats.hpp"
#include "number_reader.hpp"
#include "sink.hpp"
#include "surface_of.hpp"

namespace ductile::meshadapt {
namespace {

class ObjReader {
 public:
  ObjReader(const FileBytes& bytes, Warnings* warnings) : in_(bytes, '#'), warnings_(warnings) {
    mesh_.dimension = 3;
    mesh_.name = bytes.name;
  }

  SpatialMesh read() {
    while (!in_.peek_word().empty()) read_line();
    if (mesh_.triangles.size() == 0) in_.fail("expected faces, found none; write the file again");
    mesh_.vertex_reference.assign(mesh_.coordinates.size() / 3, 0);
    if (cut_ > 0 && warnings_)
      warnings_->push_back(printable(mesh_.name + ": " + std::to_string(cut_) +
                                     " faces of more than three corners were cut into triangles"));
    return {std::move(mesh_), {}, {}, {}};
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
    for (int axis = 0; axis < 3; ++axis) {
      mesh_.coordinates.push_back(in_.real("a coordinate"));
      if (!std::isfinite(mesh_.coordinates.back()))
        in_.fail("expected a finite coordinate, found another; correct it");
    }
  }

  void read_face() {
    corners_.clear();
    while (in_.first_on_line() != 0) corners_.push_back(corner_in(in_.word()));
    if (corners_.size() < 3)
      in_.fail("expected three corners or more, found " + std::to_string(corners_.size()) +
               "; correct the face");
    for (std::size_t i = 2; i < corners_.size(); ++i)
      mesh_.triangles.add({corners_[0], corners_[i - 1], corners_[i]}, group_);
    cut_ += corners_.size() > 3;
  }

  /// "7", or "7/2/5" with those of a texture and a normal; from -1 they count back.
  std::uint32_t corner_in(std::string_view word) const {
    const auto number = number_in<std::int64_t>(word.substr(0, word.find('/')));
    const auto count = static_cast<std::int64_t>(mesh_.coordinates.size() / 3);
    const std::int64_t corner = !number ? 0 : *number < 0 ? count + *number + 1 : *number;
    if (corner < 1 || corner > count)
      in_.fail("expected a vertex from 1 to the " + std::to_string(count) + " so far, found " +
               quoted(word) + "; correct the face");
    return static_cast<std::uint32_t>(corner - 1);
  }

  void read_group() {
    const std::string_view line = in_.line();
    const std::string name(line.substr(0, line.find_last_not_of(" \t\r") + 1));
    const std::string trimmed = name.substr(std::min(name.find_first_not_of(" \t"), name.size()));
    if (const auto number = number_in<std::int32_t>(trimmed)) {
      group_ = *number;
      return;
    }
    const auto next = static_cast<std::int32_t>(reference_of_.size() + 1);
    const auto [at, is_new] = reference_of_.try_emplace(trimmed, next);
    group_ = at->second;
    if (is_new && !trimmed.empty()) mesh_.names.push_back({2, group_, trimmed});
  }

  NumberReader in_;
  Warnings* warnings_;
  AnyMesh mesh_;
  std::map<std::string, std::int32_t> reference_of_;  // [group], of those that are no numbers
  std::vector<std::uint32_t> corners_;                // of a face
  std::int32_t group_ = 0;
  std::size_t cut_ = 0;
};

std::string name_of_group(const AnyMesh& mesh, std::int32_t reference) {
  for (const ReferenceName& name : mesh.names)
    if (name.dimension == 2 && name.reference == reference) return name.name;
  return std::to_string(reference);
}

}  // namespace

bool is_obj(std::string_view bytes) {
  for (;;) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    bytes.remove_prefix(first);
    if (bytes[0] != '#') break;
    bytes.remove_prefix(std::min(bytes.find('\n'), bytes.size()));
  }
  const std::string_view word = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
  constexpr std::array<std::string_view, 8> words{"v", "vn", "vt",     "o",
                                                  "g", "s",  "mtllib", "usemtl"};
  return std::find(words.begin(), words.end(), word) != words.end() &&
         (bytes.find("\nf ") != std::string_view::npos ||
          bytes.find("\nf\t") != std::string_view::npos);
}

SpatialMesh read_obj(const FileBytes& bytes, Warnings* warnings) {
  return ObjReader(bytes, warnings).read();
}

void write_obj(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  const FileSurface surface = surface_of(mesh, path);
  if (mesh.tetrahedra.size() > 0) warn_of_lost(options, path, "references and the inside");
  const auto& references = surface.triangles.reference;
  const bool grouped =
      std::any_of(references.begin(), references.end(), [](std::int32_t r) { return r != 0; });
  Sink& sink = outputs.stage(path);
  sink.set_text("\n");
  for (std::size_t i = 0; i < surface.coordinates.size(); i += 3) {
    sink.write("v ");
    sink.record(
        std::array{surface.coordinates[i], surface.coordinates[i + 1], surface.coordinates[i + 2]});
  }
  for (std::size_t t = 0; t < references.size(); ++t) {
    if (grouped && (t == 0 || references[t] != references[t - 1]))
      sink.write("g " + name_of_group(mesh, references[t]) + "\n");
    const auto [a, b, c] = surface.triangles.vertices[t];
    sink.write("f ");
    sink.record(std::array{std::uint64_t{a} + 1, std::uint64_t{b} + 1, std::uint64_t{c} + 1});
  }
}

}  // namespace ductile::meshadapt
