#include "formats.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <new>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "vtk_decode.hpp"
#include "vtk_grid.hpp"

namespace ductile::meshadapt {
namespace {

/// The bytes that VTK appends behind the XML, between an underscore and the end.
struct Appended {
  std::string_view bytes;
  bool base64 = false;
};

class VtuReader {
 public:
  explicit VtuReader(const FileBytes& bytes) : name_(bytes.name), size_(bytes.size) {
    parse({bytes.begin(), bytes.size});
  }

  VtkGrid read() {
    const pugi::xml_node file = document_.child("VTKFile");
    if (!file) fail("expected the element VTKFile, found none; give a .vtu file");
    const bool in_files = file.attribute("type").value() == std::string("PUnstructuredGrid");
    return in_files ? read_files(file.child("PUnstructuredGrid")) : read_pieces(file);
  }

 private:
  template <class... Parts>
  [[noreturn, gnu::noinline]] void fail(const Parts&... parts) const {
    throw InputError(text_of(name_, ": ", parts...));
  }

  // ---- Pieces ----

  /// A piece without points and cells, which a rank without a part writes, may lack its arrays.
  VtkGrid read_pieces(pugi::xml_node file) {
    read_head(file);
    const pugi::xml_node grid = file.child("UnstructuredGrid");
    if (!grid.child("Piece"))
      fail("expected a Piece of an UnstructuredGrid, found none; write the file again");
    std::vector<VtkGrid> pieces;
    for (const pugi::xml_node piece : grid.children("Piece")) {
      VtkGrid& part = pieces.emplace_back();
      part.name = name_;
      if (piece.attribute("NumberOfPoints").as_ullong() != 0 ||
          piece.attribute("NumberOfCells").as_ullong() != 0)
        read_piece(part, piece);
    }
    read_names(pieces[0], grid.child("FieldData"));
    return joined(name_, std::move(pieces));
  }

  /// The pieces of a .pvtu are files of their own, named relative to it.
  VtkGrid read_files(pugi::xml_node grid) const {
    std::vector<VtkGrid> pieces;
    for (const pugi::xml_node piece : grid.children("Piece")) {
      const std::string source = piece.attribute("Source").value();
      try {
        if (!source.ends_with(".vtu"))
          throw InputError("expected the name of a .vtu file as its Source, found " +
                           quoted_type(source));
        const auto folder = std::filesystem::path(name_).parent_path();
        VtuReader reader(read_bytes(folder / source));
        pieces.push_back(reader.read_pieces(reader.document_.child("VTKFile")));
      } catch (const InputError& error) {
        fail("Piece ", pieces.size() + 1, ": ", error.what());
      }
    }
    if (pieces.empty())
      fail("expected a Piece of a PUnstructuredGrid, found none; write the files again");
    return joined(name_, std::move(pieces));
  }

  // ---- One file ----

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
      fail("expected XML, found at byte ", parsed.offset, ": ", parsed.description(),
           "; the file is damaged or cut short, write it again");
  }

  void read_head(pugi::xml_node file) {
    const std::string type = file.attribute("type").value();
    if (type != "UnstructuredGrid")
      fail("expected VTK's type UnstructuredGrid, found ", quoted_type(type),
           "; write an unstructured grid");
    const std::string compressor = file.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail("expected arrays compressed by zlib or not at all, found ", quoted_type(compressor),
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
  std::string bytes_of(pugi::xml_node node) {
    if (node.attribute("format").value() != std::string("appended"))
      return vtk_decoded(node.text().get(), true, encoding_).bytes;
    const std::uint64_t offset = node.attribute("offset").as_ullong();
    if (offset >= appended_.bytes.size())
      throw InputError("expected an offset within the appended data, found " +
                       std::to_string(offset) + "; the file is cut short");
    VtkDecoded decoded = vtk_decoded(appended_.bytes.substr(static_cast<std::size_t>(offset)),
                                     appended_.base64, encoding_);
    taken_ += decoded.taken;
    if (taken_ > 2 * size_)  // memory is to stay in proportion to the file
      throw InputError(
          "expected bytes of its own in the appended data, found that arrays share "
          "them, which take more than the file has; write the file again");
    return std::move(decoded.bytes);
  }

  std::vector<double> numbers_of(pugi::xml_node node) {
    try {
      const std::string format = node.attribute("format").value();
      if (format != "binary" && format != "appended") return vtk_reals(node.text().get());
      const NumberKind number = number_kind(node.attribute("type").value());
      if (number.bytes == 0)
        throw InputError("expected numbers, found type " +
                         quoted_type(node.attribute("type").value()) + "; leave the array out");
      return vtk_reals(bytes_of(node), number, encoding_.swapped);
    } catch (const InputError& error) {
      fail(where(node), error.what());
    }
  }

  std::vector<std::int64_t> indices_of(pugi::xml_node cells, const char* name, std::size_t count) {
    const pugi::xml_node node = cells.find_child_by_attribute("DataArray", "Name", name);
    if (!node) fail("expected the array '", name, "' of Cells, found none; write it");
    const std::vector<double> numbers = numbers_of(node);
    if (count != any_count && numbers.size() != count)
      fail(where(node), "expected ", count, " numbers, found ", numbers.size(),
           "; the file is damaged, write it again");
    std::vector<std::int64_t> indices(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!(std::abs(numbers[i]) < 1e15) || numbers[i] != std::floor(numbers[i]))
        fail(where(node), "expected whole numbers, found others; write the file again");
      indices[i] = static_cast<std::int64_t>(numbers[i]);
    }
    return indices;
  }

  /// The arrays of numbers, all of which must have `count` values.
  std::vector<VtkArray> arrays_of(pugi::xml_node data, std::size_t count) {
    std::vector<VtkArray> arrays;
    for (const pugi::xml_node node : data.children("DataArray")) {
      const NumberKind number = number_kind(node.attribute("type").value());
      if (number.bytes == 0) continue;  // texts
      VtkArray array;
      array.whole = !number.is_real;
      array.name = node.attribute("Name").value();
      array.components = node.attribute("NumberOfComponents").as_ullong(1);
      array.values = numbers_of(node);
      if (array.components == 0 || array.components > array.values.size() + 1 ||
          array.values.size() != array.components * count)
        fail(where(node), "expected ", array.components, " numbers for each of ", count, ", found ",
             array.values.size(), "; the file is damaged, write it again");
      arrays.push_back(std::move(array));
    }
    return arrays;
  }

  void read_piece(VtkGrid& grid, pugi::xml_node piece) {
    const std::size_t points = piece.attribute("NumberOfPoints").as_ullong();
    const std::size_t cells = piece.attribute("NumberOfCells").as_ullong();
    const pugi::xml_node coordinates = piece.child("Points").child("DataArray");
    if (!coordinates) fail("expected an array of Points, found none; write the file again");
    grid.points = numbers_of(coordinates);
    if (grid.points.size() / 3 != points || grid.points.size() % 3 != 0)
      fail("expected 3 coordinates of each of ", points, " points, found ", grid.points.size(),
           "; the file is damaged, write it again");
    grid.types = indices_of(piece.child("Cells"), "types", cells);
    grid.ends = indices_of(piece.child("Cells"), "offsets", cells);
    grid.connectivity = indices_of(piece.child("Cells"), "connectivity", any_count);
    grid.point_data = arrays_of(piece.child("PointData"), points);
    grid.cell_data = arrays_of(piece.child("CellData"), cells);
  }

  void read_names(VtkGrid& grid, pugi::xml_node field_data) {
    const pugi::xml_node node = field_data.find_child_by_attribute("DataArray", "Name", "names");
    if (node.attribute("type").value() == std::string("UInt8")) grid.names = numbers_of(node);
  }

  static constexpr std::size_t any_count = ~std::size_t{0};
  std::string name_;
  std::size_t size_;       ///< of the file
  std::size_t taken_ = 0;  ///< bytes of appended data that arrays have been read from
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

MeshWithFields read_vtu(const FileBytes& bytes, Warnings* warnings) {
  return finish(mesh_of(VtuReader(bytes).read()), warnings);
}

}  // namespace ductile::meshadapt
