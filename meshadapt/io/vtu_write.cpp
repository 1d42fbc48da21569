#include "vtu_write.hpp"

#include <bit>
#include <cstdint>
#include <limits>
#include <new>
#include <pugixml.hpp>
#include <span>
#include <string_view>

#include "ductile/meshadapt/error.hpp"
#include "io/atomic_file.hpp"
#include "spatial_mesh.hpp"
#include "vtk_array.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

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
void add_array(pugi::xml_node parent, const std::string& name, std::size_t components,
               const std::vector<Number>& values) {
  pugi::xml_node node = add_node(parent, "DataArray");
  add_attribute(node, "type", type_name(Number{}));
  add_attribute(node, "Name", name.c_str());
  if (components > 1) add_attribute(node, "NumberOfComponents", components);  // as VTK does
  add_attribute(node, "format", "binary");
  const std::string text = vtk_encoded(std::as_bytes(std::span(values)));
  expect_memory(node.append_child(pugi::node_pcdata).set_value(text.c_str()));
}

/// Of two arrays of one name, readers keep one.
std::string unused_name(pugi::xml_node parent, const std::string& name) {
  std::string result = name;
  for (int i = 2; parent.find_child_by_attribute("Name", result.c_str()); ++i)
    result = name + "_" + std::to_string(i);
  return result;
}

void add_points(pugi::xml_node piece, const AnyMesh& mesh) {
  add_array(add_node(piece, "Points"), "Points", 3, points_in_space(mesh));
}

void add_cells(pugi::xml_node piece, const AnyMesh& mesh) {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  for_each_vtk_cells(mesh, [&](const auto& cells, std::uint8_t type) {
    for (const auto& vertices : cells.vertices) {
      connectivity.insert(connectivity.end(), vertices.begin(), vertices.end());
      offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    types.insert(types.end(), cells.size(), type);
  });
  const pugi::xml_node cells = add_node(piece, "Cells");
  add_array(cells, "connectivity", 1, connectivity);
  add_array(cells, "offsets", 1, offsets);
  add_array(cells, "types", 1, types);
}

/// Values at vertices, or in elements, which are the first cells; other cells get a value that is
/// not a number, and 0 where numbers are whole.
void add_field(pugi::xml_node data, const NamedField& field, const AnyMesh& mesh) {
  SpatialField wide = in_space(field, mesh);
  const std::size_t places =
      field.place == NamedField::Place::elements ? cell_count(mesh) : mesh.vertex_count();
  const std::string name = unused_name(data, field.name);
  if (const auto whole = whole_values(wide, places * wide.components))
    return add_array(data, name, wide.components, *whole);
  wide.values.resize(places * wide.components, std::numeric_limits<double>::quiet_NaN());
  add_array(data, name, wide.components, wide.values);
}

void add_data(pugi::xml_node piece, const AnyMesh& mesh, std::span<const NamedField> fields) {
  const pugi::xml_node point_data = add_node(piece, "PointData");
  add_array(point_data, "reference", 1, mesh.vertex_reference);
  const pugi::xml_node cell_data = add_node(piece, "CellData");
  const CellReferences references = cell_references(mesh);
  add_array(cell_data, "region", 1, references.region);
  add_array(cell_data, "boundary", 1, references.boundary);
  for (const NamedField& field : fields)
    add_field(field.place == NamedField::Place::elements ? cell_data : point_data, field, mesh);
}

/// Names of references as one text, a line for each, in an array of its bytes: some readers stop at
/// arrays of strings.
void add_names(pugi::xml_node grid, const AnyMesh& mesh) {
  if (mesh.names.empty()) return;
  const std::string text = name_lines(mesh);
  const pugi::xml_node data = add_node(grid, "FieldData");
  add_array(data, "names", 1, std::vector<std::uint8_t>(text.begin(), text.end()));
  add_attribute(data.first_child(), "NumberOfTuples", text.size());
}

void add_piece(pugi::xml_node grid, const AnyMesh& mesh, std::span<const NamedField> fields) {
  add_names(grid, mesh);
  const pugi::xml_node piece = add_node(grid, "Piece");
  add_attribute(piece, "NumberOfPoints", mesh.vertex_count());
  add_attribute(piece, "NumberOfCells", cell_count(mesh));
  add_data(piece, mesh, fields);
  add_points(piece, mesh);
  add_cells(piece, mesh);
}

}  // namespace

void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  expect_fit_for_file(mesh, options.fields);
  warn_of_lost(options, path, beside_cells(mesh));
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
  add_piece(add_node(file, "UnstructuredGrid"), mesh, options.fields);
  OutputWriter writer(outputs.stage(path));
  document.save(writer, " ");
}

}  // namespace ductile::meshadapt
