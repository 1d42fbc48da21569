#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base64.hpp"
#include "ductile/meshadapt/error.hpp"
#include "formats.hpp"
#include "sink.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

// ---- The text of one array ----

constexpr std::size_t block_size = std::size_t{1} << 20;

/// Appends one compressed block and returns its size.
std::uint64_t append_compressed(std::vector<unsigned char>& bytes,
                                std::span<const std::byte> block) {
  const std::size_t start = bytes.size();
  uLongf size = compressBound(static_cast<uLong>(block.size()));
  bytes.resize(start + size);
  const int result =
      compress2(bytes.data() + start, &size, reinterpret_cast<const Bytef*>(block.data()),
                static_cast<uLong>(block.size()), Z_BEST_SPEED);
  if (result != Z_OK) throw Error("zlib cannot compress an array, probably for want of memory");
  bytes.resize(start + size);
  return size;
}

/// An array as VTK's format "binary" has it: cut into blocks, each compressed by zlib, the table of
/// their sizes in front, all of it in base64. Numbers have the byte order of this machine.
std::string vtk_encoded(std::span<const std::byte> array) {
  // The table: blocks, bytes of a block, bytes of the last one if it is shorter, compressed sizes.
  std::vector<std::uint64_t> table = {(array.size() + block_size - 1) / block_size, block_size,
                                      array.size() % block_size};
  std::vector<unsigned char> compressed;
  for (std::size_t begin = 0; begin < array.size(); begin += block_size)
    table.push_back(append_compressed(
        compressed, array.subspan(begin, std::min(block_size, array.size() - begin))));
  std::string text;
  append_base64(text, std::as_bytes(std::span(table)));
  append_base64(text, std::as_bytes(std::span(compressed)));
  return text;
}

// ---- Elements of XML ----

constexpr const char* type_name(double) { return "Float64"; }
constexpr const char* type_name(std::int64_t) { return "Int64"; }
constexpr const char* type_name(std::int32_t) { return "Int32"; }
constexpr const char* type_name(std::uint8_t) { return "UInt8"; }

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name)
    text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return text;
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

class VtuWriter {
 public:
  VtuWriter(Sink& sink, const AnyMesh& mesh, std::span<const NamedField> fields)
      : sink_(sink), mesh_(mesh), fields_(fields) {}

  void write() {
    constexpr bool little = std::endian::native == std::endian::little;
    sink_.write("<?xml version=\"1.0\"?>\n");
    begin("VTKFile", attribute("type", "UnstructuredGrid") + attribute("version", "1.0") +
                         attribute("byte_order", little ? "LittleEndian" : "BigEndian") +
                         attribute("header_type", "UInt64") +
                         attribute("compressor", "vtkZLibDataCompressor"));
    begin("UnstructuredGrid");
    put_names();
    begin("Piece", attribute("NumberOfPoints", std::to_string(mesh_.vertex_count())) +
                       attribute("NumberOfCells", std::to_string(cell_count(mesh_))));
    put_data();
    begin("Points");
    put_array("Points", 3, points_in_space(mesh_));
    end("Points");
    put_cells();
    end("Piece");
    end("UnstructuredGrid");
    end("VTKFile");
  }

 private:
  void begin(const std::string& element, const std::string& attributes = "") {
    sink_.write(std::string(depth_++, ' ') + "<" + element + attributes + ">\n");
    names_.clear();
  }
  void end(const std::string& element) {
    sink_.write(std::string(--depth_, ' ') + "</" + element + ">\n");
  }

  template <class Number>
  void put_array(const std::string& name, std::size_t components, const std::vector<Number>& values,
                 const std::string& attributes = "") {
    std::string unused = name;  // readers keep one of two arrays with one name
    for (int i = 2; !names_.insert(unused).second; ++i) unused = name + "_" + std::to_string(i);
    sink_.write(
        std::string(depth_, ' ') + "<DataArray" + attribute("type", type_name(Number{})) +
        attribute("Name", escaped(unused)) +
        (components > 1 ? attribute("NumberOfComponents", std::to_string(components)) : "") +
        attribute("format", "binary") + attributes + ">");
    sink_.write(vtk_encoded(std::as_bytes(std::span(values))));
    sink_.write("</DataArray>\n");
  }

  /// Puts names of references as letters, a line for each, because some readers stop at arrays of
  /// strings.
  void put_names() {
    if (mesh_.names.empty()) return;
    const std::vector<std::uint8_t> letters = name_lines(mesh_);
    begin("FieldData");
    put_array("names", 1, letters, attribute("NumberOfTuples", std::to_string(letters.size())));
    end("FieldData");
  }

  void put_data() {
    begin("PointData");
    put_array("reference", 1, mesh_.vertex_reference);
    put_fields(NamedField::Place::vertices);
    end("PointData");
    const CellReferences references = cell_references(mesh_);
    begin("CellData");
    put_array("region", 1, references.region);
    put_array("boundary", 1, references.boundary);
    put_fields(NamedField::Place::elements);
    end("CellData");
  }

  void put_fields(NamedField::Place place) {
    for_each_vtk_field(mesh_, fields_, place, std::numeric_limits<double>::quiet_NaN(),
                       [this](const std::string& name, std::size_t components, const auto& values) {
                         put_array(name, components, values);
                       });
  }

  void put_cells() {
    std::vector<std::int64_t> connectivity, offsets;
    std::vector<std::uint8_t> types;
    for_each_vtk_cells(mesh_, [&](const auto& cells, std::uint8_t type) {
      for (const auto& vertices : cells.vertices) {
        connectivity.insert(connectivity.end(), vertices.begin(), vertices.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
      types.insert(types.end(), cells.size(), type);
    });
    begin("Cells");
    put_array("connectivity", 1, connectivity);
    put_array("offsets", 1, offsets);
    put_array("types", 1, types);
    end("Cells");
  }

  Sink& sink_;
  const AnyMesh& mesh_;
  std::span<const NamedField> fields_;
  std::size_t depth_ = 0;
  std::set<std::string> names_;  ///< of arrays of the element that is written
};

}  // namespace

void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  warn_of_lost(options, path, beside_cells(mesh));
  VtuWriter(outputs.stage(path), mesh, options.fields).write();
}

}  // namespace ductile::meshadapt
