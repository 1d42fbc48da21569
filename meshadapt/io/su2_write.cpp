#include "su2_write.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <set>
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

/// The names of a reference, several with a plus between. A marker ends at white space, so that it
/// has none. Empty: there is no name.
std::string plain_name(const AnyMesh& mesh, std::int32_t reference) {
  std::string text;
  for (const ReferenceName& name : mesh.names)
    if (name.dimension == mesh.dimension - 1 && name.reference == reference && !name.name.empty())
      text += (text.empty() ? "" : "+") + name.name;
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '=' || c == '%'; }, '_');
  return text;
}

/// Whether it is read as a reference of its own.
bool is_number(const std::string& name) {
  std::int32_t number = 0;
  const auto [after, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc{} && after == name.data() + name.size();
}

std::string renamed(const std::string& name, std::int32_t reference, const std::string& other) {
  return printable("the boundary '" + name + "' of reference " + std::to_string(reference) +
                   " is called '" + other +
                   "', because its name is that of another marker or a number");
}

/// [reference] a name of its own for each. Names that are as in the mesh come before altered ones;
/// what is called by a number would be read as that reference.
std::map<std::int32_t, std::string> marker_names(const AnyMesh& mesh,
                                                 const std::set<std::int32_t>& references,
                                                 Warnings* warnings) {
  std::map<std::int32_t, std::string> name_of;
  std::set<std::string> taken;
  const auto give = [&](std::int32_t reference, const std::string& name) {
    if (!taken.insert(name).second) return false;
    name_of[reference] = name;
    return true;
  };
  for (const std::int32_t reference : references)
    if (const std::string number = std::to_string(reference);
        plain_name(mesh, reference).empty() || plain_name(mesh, reference) == number)
      give(reference, number);
  for (const bool exact : {true, false})
    for (const std::int32_t reference : references) {
      const std::string name = plain_name(mesh, reference);
      const bool is_exact =
          std::any_of(mesh.names.begin(), mesh.names.end(), [&](const ReferenceName& one) {
            return one.dimension == mesh.dimension - 1 && one.reference == reference &&
                   one.name == name;
          });
      if (name_of.contains(reference) || (exact && !is_exact)) continue;
      if (!is_number(name) && give(reference, name)) continue;
      if (exact) continue;
      std::string other = name + "_" + std::to_string(reference);
      while (!give(reference, other)) other += "_";
      if (warnings) warnings->push_back(renamed(name, reference, other));
    }
  return name_of;
}

template <int Dim>
void put_markers(Su2Sink& sink, const AnyMesh& mesh, Warnings* warnings) {
  const auto& facets = facets_in<Dim>(mesh);
  const std::set<std::int32_t> references(facets.reference.begin(), facets.reference.end());
  const auto name_of = marker_names(mesh, references, warnings);
  std::map<std::string, std::vector<std::size_t>> facets_of;  // [marker]
  for (std::size_t i = 0; i < facets.size(); ++i)
    facets_of[name_of.at(facets.reference[i])].push_back(i);
  sink.text("NMARK= " + std::to_string(facets_of.size()) + "\n");
  for (const auto& [name, those] : facets_of) {
    sink.text("MARKER_TAG= " + name + "\nMARKER_ELEMS= " + std::to_string(those.size()) + "\n");
    for (const std::size_t i : those)
      sink.cell(Dim == 2 ? vtk_line : vtk_triangle, facets.vertices[i]);
  }
}

template <int Dim>
void put_mesh(Su2Sink& sink, const AnyMesh& mesh, Warnings* warnings) {
  const auto& elements = elements_in<Dim>(mesh);
  sink.text("NDIME= " + std::to_string(Dim) + "\nNELEM= " + std::to_string(elements.size()) + "\n");
  for (const auto& corners : elements.vertices)
    sink.cell(Dim == 2 ? vtk_triangle : vtk_tetrahedron, corners);
  sink.text("NPOIN= " + std::to_string(mesh.vertex_count()) + "\n");
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
    sink.put(mesh.coordinates[i]);
    if ((i + 1) % Dim == 0) sink.text("\n");
  }
  put_markers<Dim>(sink, mesh, warnings);
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
  flat ? put_mesh<2>(sink, mesh, options.warnings) : put_mesh<3>(sink, mesh, options.warnings);
}

}  // namespace ductile::meshadapt
