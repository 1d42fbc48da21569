#include "vtu_read.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <new>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "vtk_decode.hpp"
#include "vtk_grid.hpp"

namespace ductile::meshadapt {
namespace {

/// What VTK appends behind the XML: bytes between an underscore and the end.
struct Appended {
  std::string_view bytes;
  bool base64 = false;
};

class VtuReader {
 public:
  explicit VtuReader(const FileBytes& bytes) : name_(bytes.name) {
    parse({bytes.begin(), bytes.size});
  }

  VtkGrid read() {
    const pugi::xml_node file = document_.child("VTKFile");
    if (!file) fail("expected the element VTKFile, found none; give a .vtu file");
    read_head(file);
    const pugi::xml_node grid = file.child("UnstructuredGrid");
    const pugi::xml_node piece = grid.child("Piece");
    if (!piece) fail("expected a Piece of an UnstructuredGrid, found none; write the file again");
    if (piece.next_sibling("Piece"))
      fail(
          "expected one Piece, found several; write the grid in one, as ParaView does after Merge");
    VtkGrid result;
    result.name = name_;
    read_piece(result, piece);
    read_names(result, grid.child("FieldData"));
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw InputError(name_ + ": " + text); }

  /// XML ends where raw bytes may begin.
  void parse(std::string_view bytes) {
    const std::size_t cut = bytes.find("<AppendedData");
    std::string xml(bytes.substr(0, cut));
    if (cut != std::string_view::npos) {
      xml += "</VTKFile>";
      const std::string_view rest = bytes.substr(cut);
      const std::size_t begin = rest.find('_', rest.find('>'));
      if (begin == std::string_view::npos)
        fail("expected '_' before appended data, found none; the file is cut short");
      appended_.bytes = rest.substr(begin + 1);
      appended_.base64 = rest.substr(0, rest.find('>')).find("base64") != std::string_view::npos;
    }
    const pugi::xml_parse_result parsed = document_.load_buffer(xml.data(), xml.size());
    if (parsed.status == pugi::status_out_of_memory) throw std::bad_alloc();
    if (!parsed)
      fail("expected XML, found at byte " + std::to_string(parsed.offset) + ": " +
           parsed.description() + "; the file is damaged or cut short, write it again");
  }

  void read_head(pugi::xml_node file) {
    const std::string type = file.attribute("type").value();
    if (type != "UnstructuredGrid")
      fail("expected VTK's type UnstructuredGrid, found " + quoted_type(type) +
           "; write an unstructured grid in one file");
    const std::string compressor = file.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail("expected arrays compressed by zlib or not at all, found " + quoted_type(compressor) +
           "; write the file with zlib");
    encoding_.compressed = !compressor.empty();
    encoding_.head_bytes = file.attribute("header_type").value() == std::string("UInt64") ? 8 : 4;
    const bool big = file.attribute("byte_order").value() == std::string("BigEndian");
    encoding_.swapped = big != (std::endian::native == std::endian::big);
  }
  static std::string quoted_type(const std::string& text) { return "'" + text.substr(0, 60) + "'"; }

  std::string where(pugi::xml_node node) const {
    return std::string("array '") + std::string(node.attribute("Name").value()).substr(0, 60) +
           "': ";
  }

  /// The bytes of an array that is no text.
  std::string bytes_of(pugi::xml_node node) const {
    if (node.attribute("format").value() != std::string("appended"))
      return vtk_decoded(node.text().get(), true, encoding_);
    const std::uint64_t offset = node.attribute("offset").as_ullong();
    if (offset >= appended_.bytes.size())
      throw InputError("expected an offset within the appended data, found " +
                       std::to_string(offset) + "; the file is cut short");
    return vtk_decoded(appended_.bytes.substr(static_cast<std::size_t>(offset)), appended_.base64,
                       encoding_);
  }

  std::vector<double> numbers_of(pugi::xml_node node) const {
    try {
      const std::string format = node.attribute("format").value();
      if (format != "binary" && format != "appended") return vtk_reals(node.text().get());
      const VtkNumber number = vtk_number(node.attribute("type").value());
      if (number.bytes == 0)
        throw InputError("expected numbers, found type " +
                         quoted_type(node.attribute("type").value()) + "; leave the array out");
      return vtk_reals(bytes_of(node), number, encoding_.swapped);
    } catch (const InputError& error) {
      fail(where(node) + error.what());
    }
  }

  std::vector<std::int64_t> indices_of(pugi::xml_node cells, const char* name,
                                       std::size_t count) const {
    const pugi::xml_node node = cells.find_child_by_attribute("DataArray", "Name", name);
    if (!node)
      fail(std::string("expected the array '") + name + "' of Cells, found none; write it");
    const std::vector<double> numbers = numbers_of(node);
    if (count != any_count && numbers.size() != count)
      fail(where(node) + "expected " + std::to_string(count) + " numbers, found " +
           std::to_string(numbers.size()) + "; the file is damaged, write it again");
    std::vector<std::int64_t> indices(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!(std::abs(numbers[i]) < 1e15) || numbers[i] != std::floor(numbers[i]))
        fail(where(node) + "expected whole numbers, found others; write the file again");
      indices[i] = static_cast<std::int64_t>(numbers[i]);
    }
    return indices;
  }

  /// Those of numbers that have values for all.
  std::vector<VtkArray> arrays_of(pugi::xml_node data, std::size_t count) const {
    std::vector<VtkArray> arrays;
    for (const pugi::xml_node node : data.children("DataArray")) {
      const VtkNumber number = vtk_number(node.attribute("type").value());
      if (number.bytes == 0) continue;  // texts
      VtkArray array;
      array.whole = !number.is_real;
      array.name = node.attribute("Name").value();
      array.components = node.attribute("NumberOfComponents").as_ullong(1);
      array.values = numbers_of(node);
      if (array.components == 0 || array.components > array.values.size() + 1 ||
          array.values.size() != array.components * count)
        fail(where(node) + "expected " + std::to_string(array.components) +
             " numbers for each of " + std::to_string(count) + ", found " +
             std::to_string(array.values.size()) + "; the file is damaged, write it again");
      arrays.push_back(std::move(array));
    }
    return arrays;
  }

  void read_piece(VtkGrid& grid, pugi::xml_node piece) const {
    const std::size_t points = piece.attribute("NumberOfPoints").as_ullong();
    const std::size_t cells = piece.attribute("NumberOfCells").as_ullong();
    const pugi::xml_node coordinates = piece.child("Points").child("DataArray");
    if (!coordinates) fail("expected an array of Points, found none; write the file again");
    grid.points = numbers_of(coordinates);
    if (grid.points.size() / 3 != points || grid.points.size() % 3 != 0)
      fail("expected 3 coordinates of each of " + std::to_string(points) + " points, found " +
           std::to_string(grid.points.size()) + "; the file is damaged, write it again");
    grid.types = indices_of(piece.child("Cells"), "types", cells);
    grid.ends = indices_of(piece.child("Cells"), "offsets", cells);
    grid.connectivity = indices_of(piece.child("Cells"), "connectivity", any_count);
    grid.point_data = arrays_of(piece.child("PointData"), points);
    grid.cell_data = arrays_of(piece.child("CellData"), cells);
  }

  void read_names(VtkGrid& grid, pugi::xml_node field_data) const {
    const pugi::xml_node node = field_data.find_child_by_attribute("DataArray", "Name", "names");
    if (node.attribute("type").value() == std::string("UInt8")) grid.names = numbers_of(node);
  }

  static constexpr std::size_t any_count = ~std::size_t{0};
  std::string name_;
  pugi::xml_document document_;
  Appended appended_;
  VtkEncoding encoding_;
};

}  // namespace

bool is_vtu(std::string_view bytes) {
  const std::string_view begin = bytes.substr(0, 512);
  return begin.starts_with("<VTKFile") ||
         (begin.starts_with("<?xml") && begin.find("<VTKFile") != std::string_view::npos);
}

SpatialMesh read_vtu(const FileBytes& bytes, Warnings* /*warnings*/) {
  return mesh_of(VtuReader(bytes).read());
}

}  // namespace ductile::meshadapt
