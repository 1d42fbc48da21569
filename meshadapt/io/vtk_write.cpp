#include "formats.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "sink.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

/// A name with the characters that would end it encoded, as VTK does.
std::string encoded_name(const std::string& name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > ' ' && byte < 0x7F && c != '"' && c != '%') {
      text.push_back(c);
      continue;
    }
    text.push_back('%');
    text.push_back(digits[byte >> 4U]);
    text.push_back(digits[byte & 15U]);
  }
  return text.empty() ? "%20" : text;
}

constexpr const char* legacy_name(double) { return "double"; }
constexpr const char* legacy_name(std::int64_t) { return "vtktypeint64"; }
constexpr const char* legacy_name(std::int32_t) { return "int"; }
constexpr const char* legacy_name(std::uint8_t) { return "unsigned_char"; }

template <class Number>
void put_array(Sink& sink, const std::string& name, std::size_t components,
               const std::vector<Number>& values) {
  sink.write(encoded_name(name) + " " + std::to_string(components) + " " +
             std::to_string(values.size() / components) + " " + legacy_name(Number{}) + "\n");
  for (std::size_t i = 0; i < values.size(); ++i) {
    sink.put(values[i]);
    if ((i + 1) % components == 0) sink.end_record();
  }
  sink.write("\n");
}

/// Puts names of references as letters, because some readers stop at arrays of texts.
void put_names(Sink& sink, const AnyMesh& mesh) {
  if (mesh.names.empty()) return;
  sink.write("FIELD FieldData 1\n");
  put_array(sink, "names", 1, name_lines(mesh));
}

void put_grid(Sink& sink, const AnyMesh& mesh) {
  const std::vector<double> points = points_in_space(mesh);
  sink.write("POINTS " + std::to_string(mesh.vertex_count()) + " double\n");
  for (std::size_t i = 0; i < points.size(); i += 3) sink.record(std::span(&points[i], 3));
  std::size_t numbers = 0;
  for_each_vtk_cells(mesh, [&]<int Corners>(const Cells<Corners>& cells, std::uint8_t) {
    numbers += cells.size() * (Corners + 1);
  });
  const std::string count = std::to_string(cell_count(mesh));
  sink.write("\nCELLS " + count + " " + std::to_string(numbers) + "\n");
  for_each_vtk_cells(mesh, [&]<int Corners>(const Cells<Corners>& cells, std::uint8_t) {
    for (const auto& vertices : cells.vertices) {
      sink.put(std::int32_t{Corners});
      for (const std::uint32_t vertex : vertices) sink.put(static_cast<std::int32_t>(vertex));
      sink.end_record();
    }
  });
  sink.write("\nCELL_TYPES " + count + "\n");
  for_each_vtk_cells(mesh, [&](const auto& cells, std::uint8_t type) {
    for (std::size_t i = 0; i < cells.size(); ++i) sink.record(std::int32_t{type});
  });
}

/// Puts references first, then fields, each under a name of its own.
void put_data(Sink& sink, const AnyMesh& mesh, std::span<const NamedField> fields) {
  // VTK reads no "nan" in text.
  const double missing = sink.is_binary() ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  const auto put = [&](const std::string& name, std::size_t components, const auto& values) {
    put_array(sink, name, components, values);
  };
  const auto at_vertices = std::count_if(fields.begin(), fields.end(), [](const NamedField& field) {
    return field.place == NamedField::Place::vertices;
  });
  const CellReferences references = cell_references(mesh);
  sink.write("\nCELL_DATA " + std::to_string(cell_count(mesh)) + "\nFIELD FieldData " +
             std::to_string(2 + std::ssize(fields) - at_vertices) + "\n");
  put("region", 1, references.region);
  put("boundary", 1, references.boundary);
  for_each_vtk_field(mesh, fields, NamedField::Place::elements, missing, put);
  sink.write("\nPOINT_DATA " + std::to_string(mesh.vertex_count()) + "\nFIELD FieldData " +
             std::to_string(1 + at_vertices) + "\n");
  put("reference", 1, mesh.vertex_reference);
  for_each_vtk_field(mesh, fields, NamedField::Place::vertices, missing, put);
}

}  // namespace

void write_vtk(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  if (mesh.vertex_count() > std::numeric_limits<std::int32_t>::max())
    throw InputError(path.string() +
                     ": too large for this format, whose numbers have 32 bits; write a .vtu");
  warn_of_lost(options, path, beside_cells(mesh));
  const bool binary = options.form == WriteOptions::Form::binary;
  Sink& sink = outputs.stage(path);
  if (binary) sink.set_binary(std::endian::big);
  sink.write(std::string("# vtk DataFile Version 4.2\nwritten by Ductile\n") +
             (binary ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\n");
  put_names(sink, mesh);
  put_grid(sink, mesh);
  put_data(sink, mesh, options.fields);
}

}  // namespace ductile::meshadapt
