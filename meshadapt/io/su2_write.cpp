#include "su2_write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "spatial_mesh.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

class Su2Sink {
 public:
  explicit Su2Sink(OutputFile& out) : out_(out) {}
  void text(const std::string& text) { out_.write(text); }
  template <class Number>
  void put(Number number) {
    constexpr std::size_t widest = 32;
    char* const at = out_.room(widest);
    char* const end = std::to_chars(at, at + widest - 1, number).ptr;
    *end = ' ';
    out_.advance_to(end + 1);
  }
  template <std::size_t Corners>
  void cell(int type, const std::array<std::uint32_t, Corners>& corners) {
    put(type);
    for (const std::uint32_t vertex : corners) put(vertex);
    text("\n");
  }

 private:
  OutputFile& out_;
};

/// A marker ends at white space, so a name has none.
std::string marker_name(const AnyMesh& mesh, std::int32_t reference) {
  for (const ReferenceName& name : mesh.names) {
    if (name.dimension != mesh.dimension - 1 || name.reference != reference || name.name.empty())
      continue;
    std::string text = name.name;
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '=' || c == '%'; }, '_');
    return text;
  }
  return std::to_string(reference);
}

template <int Dim>
void put_markers(Su2Sink& sink, const AnyMesh& mesh) {
  const auto& facets = facets_in<Dim>(mesh);
  std::map<std::string, std::vector<std::size_t>> facets_of;  // [marker]
  for (std::size_t i = 0; i < facets.size(); ++i)
    facets_of[marker_name(mesh, facets.reference[i])].push_back(i);
  sink.text("NMARK= " + std::to_string(facets_of.size()) + "\n");
  for (const auto& [name, those] : facets_of) {
    sink.text("MARKER_TAG= " + name + "\nMARKER_ELEMS= " + std::to_string(those.size()) + "\n");
    for (const std::size_t i : those)
      sink.cell(Dim == 2 ? vtk_line : vtk_triangle, facets.vertices[i]);
  }
}

template <int Dim>
void put_mesh(Su2Sink& sink, const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh);
  sink.text("NDIME= " + std::to_string(Dim) + "\nNELEM= " + std::to_string(elements.size()) + "\n");
  for (const auto& corners : elements.vertices)
    sink.cell(Dim == 2 ? vtk_triangle : vtk_tetrahedron, corners);
  sink.text("NPOIN= " + std::to_string(mesh.vertex_count()) + "\n");
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
    sink.put(mesh.coordinates[i]);
    if ((i + 1) % Dim == 0) sink.text("\n");
  }
  put_markers<Dim>(sink, mesh);
}

bool several(const std::vector<std::int32_t>& reference) {
  return std::adjacent_find(reference.begin(), reference.end(), std::not_equal_to<>()) !=
         reference.end();
}

}  // namespace

void write_su2(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  expect_fit_for_file(mesh, {});
  std::string lost = beside_cells(mesh);
  const bool flat = mesh.dimension == 2;
  if (several(flat ? mesh.triangles.reference : mesh.tetrahedra.reference))
    lost += std::string(lost.empty() ? "" : ", ") + "references of elements";
  warn_of_lost(options, path, lost);
  Su2Sink sink(outputs.stage(path));
  flat ? put_mesh<2>(sink, mesh) : put_mesh<3>(sink, mesh);
}

}  // namespace ductile::meshadapt
