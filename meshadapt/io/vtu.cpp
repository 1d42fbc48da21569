#include "ductile/meshadapt/vtu.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <new>
#include <pugixml.hpp>
#include <span>
#include <string_view>

#include "ductile/meshadapt/error.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/indices.hpp"
#include "vtk_array.hpp"

namespace ductile::meshadapt {
namespace {

using Type = AnyField::Type;

class OutputWriter : public pugi::xml_writer {
 public:
  explicit OutputWriter(OutputFile& out) : out_(out) {}
  void write(const void* data, std::size_t size) override {
    out_.write({static_cast<const char*>(data), size});
  }

 private:
  OutputFile& out_;
};

const char* type_name(double) { return "Float64"; }
const char* type_name(std::int64_t) { return "Int64"; }
const char* type_name(std::int32_t) { return "Int32"; }
const char* type_name(std::uint8_t) { return "UInt8"; }

// pugixml says by what it returns that there is no memory, and does nothing then.
void expect_memory(bool there_was) {
  if (!there_was) throw std::bad_alloc();
}

pugi::xml_node add_node(pugi::xml_node parent, const char* name) {
  const pugi::xml_node node = parent.append_child(name);
  expect_memory(node);
  return node;
}

template <class Value>
void add_attribute(pugi::xml_node node, const char* name, const Value& value) {
  expect_memory(node.append_attribute(name).set_value(value));
}

template <class Number>
void add_array(pugi::xml_node parent, const std::string& name, int components,
               const std::vector<Number>& values) {
  pugi::xml_node node = add_node(parent, "DataArray");
  add_attribute(node, "type", type_name(Number{}));
  add_attribute(node, "Name", name.c_str());
  add_attribute(node, "NumberOfComponents", components);
  add_attribute(node, "format", "binary");
  const std::string text = vtk_encoded(std::as_bytes(std::span(values)));
  expect_memory(node.append_child(pugi::node_pcdata).set_value(text.c_str()));
}

/// Where component (row, column) of a field stands among those of a vertex; -1: nowhere.
int component_at(Type type, int dimension, int row, int column) {
  if (row >= dimension || column >= dimension) return -1;
  if (type == Type::matrix) return row * dimension + column;
  if (type == Type::vector) return column;
  return std::max(row, column) * (std::max(row, column) + 1) / 2 + std::min(row, column);
}

/// Of two arrays of one name, readers keep one.
std::string unused_name(pugi::xml_node parent, const std::string& name) {
  std::string result = name;
  for (int i = 2; parent.find_child_by_attribute("Name", result.c_str()); ++i)
    result = name + "_" + std::to_string(i);
  return result;
}

/// Throws unless XML can hold it: UTF-8 without control characters.
void expect_text(const std::string& name, std::size_t index) {
  const auto byte = [&](std::size_t i) {
    return i < name.size() ? static_cast<unsigned char>(name[i]) : 0U;
  };
  for (std::size_t at = 0; at < name.size();) {
    const unsigned first = byte(at), second = byte(at + 1);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xC2 && first < 0xE0 ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    bool good = length > 1 || (first >= 0x20 && first != 0x7F);
    good = good && length > 0;
    for (std::size_t i = 1; i < length; ++i) good = good && byte(at + i) >> 6U == 2;
    // Not too long, no surrogate, none beyond the last character, no noncharacter of XML.
    good = good && !(first == 0xE0 && second < 0xA0) && !(first == 0xED && second > 0x9F) &&
           !(first == 0xF0 && second < 0x90) && !(first == 0xF4 && second > 0x8F) &&
           !(first == 0xEF && second == 0xBF && byte(at + 2) > 0xBD);
    if (!good)
      throw InputError("fields[" + std::to_string(index) +
                       "].name: expected UTF-8 without control characters, found another byte at " +
                       std::to_string(at));
    at += length;
  }
}

void expect_fields(const AnyMesh& mesh, const std::vector<NamedField>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto& [name, type, values, at] = fields[i];
    const std::string place = "fields[" + std::to_string(i) + "]";
    if (at != NamedField::Place::vertices)
      throw InputError(place + ".place: expected vertices, found elements");
    const int number = static_cast<int>(type);
    if (number < 1 || number > 4)
      throw InputError(place + ".type: expected 1 to 4, found " + std::to_string(number));
    const std::size_t expected =
        mesh.vertex_count() * static_cast<std::size_t>(component_count(type, mesh.dimension));
    if (values.size() != expected)
      throw InputError(place + ".values: expected " + std::to_string(expected) +
                       " numbers, found " + std::to_string(values.size()));
    expect_text(name, i);
  }
}

void add_field(pugi::xml_node parent, const NamedField& field, const AnyMesh& mesh) {
  const auto stride = static_cast<std::size_t>(component_count(field.type, mesh.dimension));
  const std::string name = unused_name(parent, field.name);
  if (field.type == Type::scalar) return add_array(parent, name, 1, field.values);
  const int rows = field.type == Type::vector ? 1 : 3;
  std::vector<double> wide;
  wide.reserve(mesh.vertex_count() * static_cast<std::size_t>(3 * rows));
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 3; ++column) {
        const int from = component_at(field.type, mesh.dimension, row, column);
        wide.push_back(from < 0 ? 0.0
                                : field.values[vertex * stride + static_cast<std::size_t>(from)]);
      }
  add_array(parent, name, 3 * rows, wide);
}

void add_points(pugi::xml_node piece, const AnyMesh& mesh) {
  const NamedField points{.name = "Points", .type = Type::vector, .values = mesh.coordinates};
  add_field(add_node(piece, "Points"), points, mesh);
}

template <class Visit>
void for_each_cells(const AnyMesh& mesh, const Visit& visit) {
  constexpr std::uint8_t vtk_line = 3, vtk_triangle = 5, vtk_tetrahedron = 10;
  visit(mesh.tetrahedra, vtk_tetrahedron);
  visit(mesh.triangles, vtk_triangle);
  visit(mesh.edges, vtk_line);
}

void add_cells(pugi::xml_node piece, const AnyMesh& mesh) {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> references;
  for_each_cells(mesh, [&](const auto& cells, std::uint8_t type) {
    for (const auto& vertices : cells.vertices) {
      connectivity.insert(connectivity.end(), vertices.begin(), vertices.end());
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    types.insert(types.end(), cells.size(), type);
    references.insert(references.end(), cells.reference.begin(), cells.reference.end());
  });
  const pugi::xml_node cells = add_node(piece, "Cells");
  add_array(cells, "connectivity", 1, connectivity);
  add_array(cells, "offsets", 1, offsets);
  add_array(cells, "types", 1, types);
  add_array(add_node(piece, "CellData"), "reference", 1, references);
}

void add_piece(pugi::xml_node grid, const AnyMesh& mesh, const std::vector<NamedField>& fields) {
  const pugi::xml_node piece = add_node(grid, "Piece");
  const std::size_t cells = mesh.tetrahedra.size() + mesh.triangles.size() + mesh.edges.size();
  add_attribute(piece, "NumberOfPoints", mesh.vertex_count());
  add_attribute(piece, "NumberOfCells", cells);
  add_points(piece, mesh);
  add_cells(piece, mesh);
  const pugi::xml_node point_data = add_node(piece, "PointData");
  add_array(point_data, "reference", 1, mesh.vertex_reference);
  for (const NamedField& field : fields) add_field(point_data, field, mesh);
}

}  // namespace

void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields) {
  expect_coordinates(mesh);
  expect_references(mesh);
  expect_all_vertices(mesh);
  expect_finite_coordinates(runtime::Executor({.threads = 1}), mesh);
  expect_fields(mesh, fields);
  pugi::xml_document document;
  const pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  add_attribute(declaration, "version", "1.0");
  const pugi::xml_node file = add_node(document, "VTKFile");
  add_attribute(file, "type", "UnstructuredGrid");
  add_attribute(file, "version", "1.0");
  add_attribute(file, "byte_order",
                std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian");
  add_attribute(file, "header_type", "UInt64");
  add_attribute(file, "compressor", "vtkZLibDataCompressor");
  add_piece(add_node(file, "UnstructuredGrid"), mesh, fields);
  OutputWriter writer(outputs.stage(path));
  document.save(writer, " ");
}

void write_vtu(const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields) {
  AtomicOutputs outputs;
  write_vtu(outputs, path, mesh, fields);
  outputs.commit();
}

}  // namespace ductile::meshadapt
