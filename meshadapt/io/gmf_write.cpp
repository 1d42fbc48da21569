#include "formats.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "gmf_section.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/wording.hpp"
#include "sink.hpp"

namespace ductile::meshadapt {
namespace {

using gmf::Keyword;
using gmf::Section;
using Form = WriteOptions::Form;

// ---- What fits into a file ----

void expect(bool holds, const std::string& name, const std::string& text) {
  if (!holds) throw InputError(name + ": " + text);
}

/// Numbers of version 1 have single precision in binary.
void expect_range(const std::vector<double>& values, const WriteOptions& options,
                  const std::string& name) {
  constexpr double largest = std::numeric_limits<float>::max();
  if (options.version != 1 || options.form != Form::binary) return;
  for (const double value : values)
    expect(std::abs(value) <= largest, name,
           "expected numbers up to 3.4e38 in version 1 of the format, found " + number(value) +
               "; write version 2");
}

void expect_fit(const AnyMesh& mesh, const WriteOptions& options) {
  expect_range(mesh.coordinates, options, name_of(mesh));
  expect(mesh.vertex_count() != 0, name_of(mesh), "expected vertices, found none");
  expect(mesh.dimension == 3 || mesh.tetrahedra.size() == 0, name_of(mesh),
         "expected no tetrahedra in dimension 2, found some");
  for (const auto& [keyword, indices, marked] : gmf::marked_lists) {
    const auto& list = mesh.*indices;
    const std::size_t limit = entity_count(mesh, marked);
    const auto wrong =
        std::find_if(list.begin(), list.end(), [&](std::uint32_t i) { return i >= limit; });
    const std::string section(gmf::name_of(keyword));
    if (wrong != list.end())
      refuse(name_of(mesh) + ": " +
             entry(section, section, static_cast<std::size_t>(wrong - list.begin())) + " names " +
             index_word(*wrong) + ", beyond the " + std::to_string(limit) + " that there are");
  }
}

void expect_fit(const AnyField& field, const WriteOptions& options) {
  expect_values(field);
  expect_finite(runtime::Executor({.threads = 1}), field);
  expect_range(field.values, options, name_of(field));
  expect(field.vertex_count != 0, name_of(field), "expected values at vertices, found none");
  expect(field.types.size() <= 1000, name_of(field),
         "expected at most 1000 fields, found " + std::to_string(field.types.size()));
}

// ---- Sections ----

/// Calls visit(keyword, cells) for each kind of cell.
template <class Visit>
void for_each_cells(const AnyMesh& mesh, const Visit& visit) {
  visit(Keyword::edges, mesh.edges);
  visit(Keyword::triangles, mesh.triangles);
  visit(Keyword::tetrahedra, mesh.tetrahedra);
}

template <int Corners>
Section section_of(Keyword keyword, const Cells<Corners>& cells) {
  return {keyword, cells.size(), 0, Corners + 1};
}

Section vertices_of(const AnyMesh& mesh) {
  return {Keyword::vertices, mesh.vertex_count(), static_cast<std::uint64_t>(mesh.dimension), 1};
}

Section values_of(const AnyField& field) {
  return {Keyword::field_at_vertices, field.vertex_count, stride_of(field), 0};
}

std::vector<Section> sections_of(const AnyMesh& mesh) {
  std::vector<Section> sections{vertices_of(mesh)};
  for_each_cells(mesh, [&](Keyword keyword, const auto& cells) {
    sections.push_back(section_of(keyword, cells));
  });
  for (const auto& [keyword, indices, marked] : gmf::marked_lists)
    sections.push_back({keyword, (mesh.*indices).size(), 0, 1});
  std::erase_if(sections, [](const Section& section) { return section.count == 0; });
  return sections;
}

/// Writes sections number by number. Sizes are known in advance, so a binary section begins with
/// the position of the next one right away.
class GmfWriter {
 public:
  GmfWriter(Sink& sink, const WriteOptions& options)
      : sink_(sink), binary_(options.form == Form::binary), sizes_{options.version} {
    if (!binary_) {
      sink_.set_text("\n");
      sink_.write("MeshVersionFormatted " + std::to_string(options.version) + "\n");
      return;
    }
    sink_.set_binary(options.byte_order);
    sink_.put(std::int32_t{1}, static_cast<std::int32_t>(options.version));
  }

  void dimension(int dimension) {
    if (!binary_) return sink_.write("\nDimension " + std::to_string(dimension) + "\n");
    begin(Keyword::dimension, 4);
    sink_.put(static_cast<std::int32_t>(dimension));
  }
  /// The head numbers follow, then the records.
  void section(const Section& section, const std::vector<std::int32_t>& head_numbers = {}) {
    begin(section.keyword, sizes_.contents(section, head_numbers.size()));
    integer(static_cast<std::int64_t>(section.count));
    if (!binary_) end_record();
    for (const std::int32_t number : head_numbers)
      binary_ ? sink_.put(number) : sink_.write(std::to_string(number) + " ");
    if (!binary_ && !head_numbers.empty()) sink_.write("\n");
  }
  void real(double value) {
    binary_&& sizes_.version == 1 ? sink_.put(static_cast<float>(value)) : sink_.put(value);
  }
  void integer(std::int64_t value) {
    binary_&& sizes_.version != 4 ? sink_.put(static_cast<std::int32_t>(value)) : sink_.put(value);
  }
  void end_record() { sink_.end_record(); }
  void end() {
    if (!binary_) return sink_.write("\nEnd\n");
    sink_.put(static_cast<std::int32_t>(Keyword::end));
    position(0);
  }

 private:
  void begin(Keyword keyword, std::size_t contents) {
    if (!binary_) return sink_.write("\n" + std::string(gmf::name_of(keyword)) + "\n");
    const std::size_t next = sink_.size() + sizes_.head() + contents;
    sink_.put(static_cast<std::int32_t>(keyword));
    position(next);
  }
  void position(std::size_t position) {
    sizes_.position() == 8 ? sink_.put(static_cast<std::int64_t>(position))
                           : sink_.put(static_cast<std::int32_t>(position));
  }

  Sink& sink_;
  bool binary_;
  gmf::BinarySizes sizes_;
};

void put_mesh(GmfWriter&& out, const AnyMesh& mesh) {
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  out.dimension(mesh.dimension);
  out.section(vertices_of(mesh));
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    for (std::size_t axis = 0; axis < dimension; ++axis)
      out.real(mesh.coordinates[vertex * dimension + axis]);
    out.integer(mesh.vertex_reference[vertex]);
    out.end_record();
  }
  for_each_cells(mesh, [&](Keyword keyword, const auto& cells) {
    if (cells.size() != 0) out.section(section_of(keyword, cells));
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      for (const std::uint32_t vertex : cells.vertices[cell]) out.integer(std::int64_t{vertex} + 1);
      out.integer(cells.reference[cell]);
      out.end_record();
    }
  });
  for (const auto& [keyword, indices, marked] : gmf::marked_lists) {
    const auto& list = mesh.*indices;
    if (!list.empty()) out.section({keyword, list.size(), 0, 1});
    for (const std::uint32_t index : list) {
      out.integer(std::int64_t{index} + 1);
      out.end_record();
    }
  }
  out.end();
}

/// The number of fields, then their types.
std::vector<std::int32_t> head_of(const AnyField& field) {
  std::vector<std::int32_t> head{static_cast<std::int32_t>(field.types.size())};
  for (const AnyField::Type type : field.types) head.push_back(static_cast<std::int32_t>(type));
  return head;
}

void put_field(GmfWriter&& out, const AnyField& field) {
  const std::size_t stride = stride_of(field);
  out.dimension(field.dimension);
  out.section(values_of(field), head_of(field));
  for (std::size_t vertex = 0; vertex < field.vertex_count; ++vertex) {
    for (std::size_t component = 0; component < stride; ++component)
      out.real(field.values[vertex * stride + component]);
    out.end_record();
  }
  out.end();
}

// ---- Form and version ----

/// Fills in what the options leave open.
void choose_form(WriteOptions& options, const std::filesystem::path& path) {
  if (options.version < 0 || options.version > 4)
    throw InputError(path.string() + ": expected version 1 to 4 to write, found " +
                     std::to_string(options.version));
  if (options.form == Form::by_name)
    options.form = options.format.ends_with('b') ? Form::binary : Form::ascii;
}

/// Chooses the format of a field, which is not in the table of mesh formats.
void expect_ending_of_field(WriteOptions& options, const std::filesystem::path& path) {
  if (options.form != Form::by_name) return;
  const std::string ending = path.extension().string();
  if (ending != ".sol" && ending != ".solb")
    throw InputError(path.string() + ": expected a name that ends in .sol or .solb, found '" +
                     ending + "'; choose another name");
  options.format = ending == ".sol" ? ".sol" : ".solb";
}

int needed_version(const std::vector<Section>& sections, std::size_t head_numbers, Form form) {
  constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
  constexpr gmf::BinarySizes sizes{2};
  std::size_t bytes = sizes.frame();
  for (const Section& section : sections) {
    if (section.count > limit) return 4;
    bytes += sizes.head() + sizes.contents(section, head_numbers);
  }
  return form == Form::binary && bytes > limit ? 3 : 2;
}

void choose_version(WriteOptions& options, const std::filesystem::path& path,
                    const std::vector<Section>& sections, std::size_t head_numbers) {
  const int needed = needed_version(sections, head_numbers, options.form);
  if (options.version == 0) options.version = needed;
  if (options.version < needed && needed > 2)
    throw InputError(path.string() + ": too large for version " + std::to_string(options.version) +
                     " of the format; write version " + std::to_string(needed));
}

}  // namespace

void write_gmf(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& given) {
  WriteOptions options = given;
  choose_form(options, path);
  expect_fit(mesh, options);
  choose_version(options, path, sections_of(mesh), 0);
  if (!mesh.names.empty())
    warn_of_lost(options, path, "names of references (" + std::to_string(mesh.names.size()) + ")");
  put_mesh(GmfWriter(outputs.stage(path), options), mesh);
}

void write_field(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& given) {
  WriteOptions options = given;
  expect_ending_of_field(options, path);
  choose_form(options, path);
  expect_fit(field, options);
  choose_version(options, path, {values_of(field)}, head_of(field).size());
  put_field(GmfWriter(outputs.stage(path), options), field);
}

void write_field(const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options) {
  AtomicOutputs outputs;
  write_field(outputs, path, field, options);
  outputs.commit();
}

}  // namespace ductile::meshadapt
