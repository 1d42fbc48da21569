#include "vtk_write.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "io/atomic_file.hpp"
#include "spatial_mesh.hpp"
#include "vtk_cells.hpp"

namespace ductile::meshadapt {
namespace {

class VtkSink {
 public:
  VtkSink(OutputFile& out, bool binary) : out_(out), binary_(binary) {}

  void text(const std::string& text) { out_.write(text); }
  template <class Number>
  void put(Number number) {
    constexpr std::size_t widest = 32;
    char* const at = out_.room(widest);
    if (binary_) {
      std::copy_n(reinterpret_cast<const char*>(&number), sizeof(Number), at);
      if (std::endian::native == std::endian::little) std::reverse(at, at + sizeof(Number));
      return out_.advance_to(at + sizeof(Number));
    }
    const auto shown = [&] {  // as a number, where it is a letter
      if constexpr (sizeof(Number) == 1)
        return int{number};
      else
        return number;
    }();
    char* const end = std::to_chars(at, at + widest - 1, shown).ptr;
    *end = ' ';
    out_.advance_to(end + 1);
  }
  void end_line() { out_.write("\n"); }
  void end_record() {
    if (!binary_) end_line();
  }
  template <class Number>
  void array(const std::string& name, std::size_t components, const char* type,
             const std::vector<Number>& values) {
    text(encoded_name(name) + " " + std::to_string(components) + " " +
         std::to_string(values.size() / components) + " " + type + "\n");
    for (std::size_t i = 0; i < values.size(); ++i) {
      put(values[i]);
      if ((i + 1) % components == 0) end_record();
    }
    end_line();
  }
  bool is_binary() const { return binary_; }

  /// As VTK writes names with what would end them.
  static std::string encoded_name(const std::string& name) {
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

 private:
  OutputFile& out_;
  bool binary_;
};

/// Letters of a text, because arrays of texts stop some readers.
void put_names(VtkSink& sink, const AnyMesh& mesh) {
  if (mesh.names.empty()) return;
  const std::string text = name_lines(mesh);
  sink.text("FIELD FieldData 1\n");
  sink.array("names", 1, "unsigned_char", std::vector<std::uint8_t>(text.begin(), text.end()));
}

void put_grid(VtkSink& sink, const AnyMesh& mesh) {
  const std::vector<double> points = points_in_space(mesh);
  sink.text("POINTS " + std::to_string(mesh.vertex_count()) + " double\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    sink.put(points[i]);
    if (i % 3 == 2) sink.end_record();
  }
  std::size_t numbers = 0;
  for_each_vtk_cells(mesh, [&]<int Corners>(const Cells<Corners>& cells, std::uint8_t) {
    numbers += cells.size() * (Corners + 1);
  });
  const std::string count = std::to_string(cell_count(mesh));
  sink.text("\nCELLS " + count + " " + std::to_string(numbers) + "\n");
  for_each_vtk_cells(mesh, [&]<int Corners>(const Cells<Corners>& cells, std::uint8_t) {
    for (const auto& vertices : cells.vertices) {
      sink.put(std::int32_t{Corners});
      for (const std::uint32_t vertex : vertices) sink.put(static_cast<std::int32_t>(vertex));
      sink.end_record();
    }
  });
  sink.text("\nCELL_TYPES " + count + "\n");
  for_each_vtk_cells(mesh, [&](const auto& cells, std::uint8_t type) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      sink.put(std::int32_t{type});
      sink.end_record();
    }
  });
}

/// References first, then fields, each under a name of its own.
void put_data(VtkSink& sink, const AnyMesh& mesh, std::span<const NamedField> fields) {
  const auto is_in = [](NamedField::Place place) {
    return [place](const NamedField& field) { return field.place == place; };
  };
  const auto put_fields = [&](NamedField::Place place, std::size_t count) {
    for (const NamedField& field : fields) {
      if (field.place != place) continue;
      SpatialField wide = in_space(field, mesh);
      if (const auto whole = whole_values(wide, count * wide.components)) {
        sink.array(field.name, wide.components, "vtktypeint64", *whole);
        continue;
      }
      // VTK reads no "nan" in text.
      wide.values.resize(count * wide.components,
                         sink.is_binary() ? std::numeric_limits<double>::quiet_NaN() : 0.0);
      sink.array(field.name, wide.components, "double", wide.values);
    }
  };
  const auto count_in = [&](NamedField::Place place) {
    return std::to_string(std::count_if(fields.begin(), fields.end(), is_in(place)));
  };
  const CellReferences references = cell_references(mesh);
  sink.text("\nCELL_DATA " + std::to_string(cell_count(mesh)) + "\nFIELD FieldData " +
            std::to_string(2 + std::stoul(count_in(NamedField::Place::elements))) + "\n");
  sink.array("region", 1, "int", references.region);
  sink.array("boundary", 1, "int", references.boundary);
  put_fields(NamedField::Place::elements, cell_count(mesh));
  sink.text("\nPOINT_DATA " + std::to_string(mesh.vertex_count()) + "\nFIELD FieldData " +
            std::to_string(1 + std::stoul(count_in(NamedField::Place::vertices))) + "\n");
  sink.array("reference", 1, "int", mesh.vertex_reference);
  put_fields(NamedField::Place::vertices, mesh.vertex_count());
}

}  // namespace

void write_vtk(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options) {
  expect_fit_for_file(mesh, options.fields);
  if (mesh.vertex_count() > std::numeric_limits<std::int32_t>::max())
    throw InputError(path.string() +
                     ": too large for this format, whose numbers have 32 bits; write a .vtu");
  warn_of_lost(options, path, beside_cells(mesh));
  const bool binary = options.form == WriteOptions::Form::binary;
  VtkSink sink(outputs.stage(path), binary);
  sink.text(std::string("# vtk DataFile Version 4.2\nwritten by Ductile\n") +
            (binary ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\n");
  put_names(sink, mesh);
  put_grid(sink, mesh);
  put_data(sink, mesh, options.fields);
}

}  // namespace ductile::meshadapt
