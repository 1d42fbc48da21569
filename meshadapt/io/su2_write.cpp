#include "formats.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "mesh/names.hpp"
#include "number_in.hpp"
#include "sink.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

/// The names of a reference, joined by '+', without white space, at which a marker ends; empty if
/// there are none.
std::string plain_name(const AnyMesh& mesh, std::int32_t reference) {
  std::string text = joined_names(mesh, mesh.dimension - 1, reference);
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '=' || c == '%'; }, '_');
  return text;
}

std::string renamed(const std::string& name, std::int32_t reference, const std::string& other) {
  return printable("the boundary '" + name + "' of reference " + std::to_string(reference) +
                   " is called '" + other +
                   "', because its name is that of another marker or a number");
}

/// [reference] its own name. Names as in the mesh come before altered ones; a number as a name
/// would be read as that reference.
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
      if (!number_in<std::int32_t>(name) && give(reference, name)) continue;
      if (exact) continue;
      std::string other = name + "_" + std::to_string(reference);
      while (!give(reference, other)) other += "_";
      if (warnings) warnings->push_back(renamed(name, reference, other));
    }
  return name_of;
}

template <int Dim>
void put_markers(Sink& sink, const AnyMesh& mesh, Warnings* warnings) {
  const auto& facets = facets_in<Dim>(mesh);
  const std::set<std::int32_t> references(facets.reference.begin(), facets.reference.end());
  const auto name_of = marker_names(mesh, references, warnings);
  std::map<std::string, std::vector<std::size_t>> facets_of;  // [marker]
  for (std::size_t i = 0; i < facets.size(); ++i)
    facets_of[name_of.at(facets.reference[i])].push_back(i);
  sink.write("NMARK= " + std::to_string(facets_of.size()) + "\n");
  for (const auto& [name, those] : facets_of) {
    sink.write("MARKER_TAG= " + name + "\nMARKER_ELEMS= " + std::to_string(those.size()) + "\n");
    for (const std::size_t i : those)
      sink.record(Dim == 2 ? vtk_line : vtk_triangle, facets.vertices[i]);
  }
}

template <int Dim>
void put_mesh(Sink& sink, const AnyMesh& mesh, Warnings* warnings) {
  const auto& elements = elements_in<Dim>(mesh);
  sink.write("NDIME= " + std::to_string(Dim) + "\nNELEM= " + std::to_string(elements.size()) +
             "\n");
  for (const auto& corners : elements.vertices)
    sink.record(Dim == 2 ? vtk_triangle : vtk_tetrahedron, corners);
  sink.write("NPOIN= " + std::to_string(mesh.vertex_count()) + "\n");
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += Dim)
    sink.record(std::span(&mesh.coordinates[i], Dim));
  put_markers<Dim>(sink, mesh, warnings);
}

bool several(const std::vector<std::int32_t>& reference) {
  return std::adjacent_find(reference.begin(), reference.end(), std::not_equal_to<>()) !=
         reference.end();
}

}  // namespace

void write_su2(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  std::string lost = beside_cells(mesh);
  const bool flat = mesh.dimension == 2;
  if (several(flat ? mesh.triangles.reference : mesh.tetrahedra.reference))
    lost += std::string(lost.empty() ? "" : ", ") + "references of elements";
  warn_of_lost(options, path, lost);
  Sink& sink = outputs.stage(path);
  flat ? put_mesh<2>(sink, mesh, options.warnings) : put_mesh<3>(sink, mesh, options.warnings);
}

}  // namespace ductile::meshadapt
