#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "gmf_mesh.hpp"
#include "gmf_sink.hpp"
#include "io/atomic_file.hpp"
#include "mesh/wording.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {
namespace {

using gmf::BinarySink;
using gmf::BinarySizes;
using gmf::Keyword;
using gmf::Place;
using gmf::TextSink;
using Form = WriteOptions::Form;

// ---- What is fit for a file ----

void expect(bool holds, const std::string& name, const std::string& text) {
  if (!holds) throw InputError(name + ": cannot be written: " + text);
}

void expect_finite(const std::vector<double>& values, std::size_t stride,
                   const WriteOptions& options, const std::string& name, const std::string& array) {
  const double largest = options.version == 1 && options.form == Form::binary
                             ? double{std::numeric_limits<float>::max()}
                             : std::numeric_limits<double>::max();
  const auto wrong = std::find_if(values.begin(), values.end(),
                                  [&](double value) { return !(std::abs(value) <= largest); });
  if (wrong == values.end()) return;
  const auto at = static_cast<std::size_t>(wrong - values.begin());
  refuse(name +
         ": cannot be written: expected a finite number within the range of the version at " +
         Wording(array + "[" + std::to_string(at) + "], vertex " + std::to_string(at / stride),
                 "vertex " + std::to_string(at / stride + 1)) +
         ", found " + number(*wrong));
}

struct Indices {
  const std::uint32_t* data;
  std::size_t count, per_entity;
};

void expect_below(const Indices& those, std::size_t limit, const std::string& name,
                  Keyword keyword) {
  const auto [indices, count, per_entity] = those;
  const auto* wrong =
      std::find_if(indices, indices + count, [&](std::uint32_t i) { return i >= limit; });
  if (wrong == indices + count) return;
  const auto at = static_cast<std::size_t>(wrong - indices) / per_entity;
  const std::string section(gmf::name_of(keyword));
  refuse(name + ": cannot be written: " + entry(section, section, at) + " names " +
         index_word(*wrong) + ", beyond the " + std::to_string(limit) + " that there are");
}

// ---- The sections of a mesh ----

struct ListOf {
  Keyword keyword;
  const std::vector<std::uint32_t>& indices;
  std::size_t limit;
};

std::vector<ListOf> lists_of(const AnyMesh& mesh) {
  const std::size_t vertices = mesh.vertex_count();
  return {{Keyword::corners, mesh.corners, vertices},
          {Keyword::ridges, mesh.ridges, mesh.edges.size()},
          {Keyword::required_vertices, mesh.required_vertices, vertices},
          {Keyword::required_edges, mesh.required_edges, mesh.edges.size()},
          {Keyword::required_triangles, mesh.required_triangles, mesh.triangles.size()},
          {Keyword::required_tetrahedra, mesh.required_tetrahedra, mesh.tetrahedra.size()}};
}

/// Calls visit(keyword, cells) for each kind of cell.
template <class Visit>
void for_each_cells(const AnyMesh& mesh, const Visit& visit) {
  visit(Keyword::edges, mesh.edges);
  visit(Keyword::triangles, mesh.triangles);
  visit(Keyword::tetrahedra, mesh.tetrahedra);
}

template <int Corners>
Place place_of(Keyword keyword, const Cells<Corners>& cells) {
  return {keyword, cells.size(), 0, {0, Corners + 1}};
}

Place vertices_of(const AnyMesh& mesh) {
  return {
      Keyword::vertices, mesh.vertex_count(), 0, {static_cast<std::uint64_t>(mesh.dimension), 1}};
}

void expect_fit(const AnyMesh& mesh, const WriteOptions& options, const std::string& name) {
  expect(mesh.dimension == 2 || mesh.dimension == 3, name,
         "expected dimension 2 or 3, found " + std::to_string(mesh.dimension));
  expect(mesh.vertex_count() != 0, name, "the mesh has no vertices");
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  expect(mesh.coordinates.size() == dimension * mesh.vertex_count(), name,
         "coordinates and references of vertices differ in number");
  expect_finite(mesh.coordinates, dimension, options, name, "coordinates");
  for_each_cells(mesh, [&]<int Corners>(Keyword keyword, const Cells<Corners>& cells) {
    expect(cells.vertices.size() == cells.reference.size(), name,
           "cells and references differ in number");
    if (cells.size() != 0)
      expect_below({cells.vertices[0].data(), Corners * cells.size(), Corners}, mesh.vertex_count(),
                   name, keyword);
  });
  expect(mesh.dimension == 3 || mesh.tetrahedra.size() == 0, name, "tetrahedra in dimension 2");
  for (const auto& [keyword, indices, limit] : lists_of(mesh))
    expect_below({indices.data(), indices.size(), 1}, limit, name, keyword);
}

std::vector<Place> sections_of(const AnyMesh& mesh) {
  std::vector<Place> sections{vertices_of(mesh)};
  for_each_cells(mesh, [&](Keyword keyword, const auto& cells) {
    if (cells.size() != 0) sections.push_back(place_of(keyword, cells));
  });
  for (const auto& [keyword, indices, limit] : lists_of(mesh))
    if (!indices.empty()) sections.push_back({keyword, indices.size(), 0, {0, 1}});
  return sections;
}

template <class Sink>
void put_mesh(Sink&& sink, const AnyMesh& mesh) {
  sink.dimension(mesh.dimension);
  const Place vertices = vertices_of(mesh);
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  sink.section(vertices);
  for (std::size_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    sink.begin_record(vertices);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      sink.real(mesh.coordinates[vertex * dimension + axis]);
    sink.integer(mesh.vertex_reference[vertex]);
    sink.end_record();
  }
  for_each_cells(mesh, [&](Keyword keyword, const auto& cells) {
    const Place section = place_of(keyword, cells);
    if (cells.size() != 0) sink.section(section);
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      sink.begin_record(section);
      for (const std::uint32_t vertex : cells.vertices[cell])
        sink.integer(std::int64_t{vertex} + 1);
      sink.integer(cells.reference[cell]);
      sink.end_record();
    }
  });
  for (const auto& [keyword, indices, limit] : lists_of(mesh)) {
    const Place section{keyword, indices.size(), 0, {0, 1}};
    if (!indices.empty()) sink.section(section);
    for (const std::uint32_t index : indices) {
      sink.begin_record(section);
      sink.integer(std::int64_t{index} + 1);
      sink.end_record();
    }
  }
  sink.end_of_file();
}

// ---- The section of a field ----

Place values_of(const AnyField& field) {
  return {Keyword::field_at_vertices, field.vertex_count, 0, {stride_of(field), 0}};
}

void expect_fit(const AnyField& field, const WriteOptions& options, const std::string& name) {
  expect(field.dimension == 2 || field.dimension == 3, name,
         "expected dimension 2 or 3, found " + std::to_string(field.dimension));
  expect(field.vertex_count != 0, name, "the field has no vertices");
  expect(!field.types.empty() && field.types.size() <= 1000, name,
         "expected 1 to 1000 fields, found " + std::to_string(field.types.size()));
  const std::size_t stride = stride_of(field);
  expect(field.values.size() == stride * field.vertex_count, name,
         "expected " + std::to_string(stride) + " values at each vertex, found " +
             std::to_string(field.values.size()) + " in all");
  expect_finite(field.values, stride, options, name, "values");
}

template <class Sink>
void put_field(Sink&& sink, const AnyField& field) {
  const Place section = values_of(field);
  const std::size_t stride = stride_of(field);
  sink.dimension(field.dimension);
  sink.section(section, 1 + field.types.size());
  sink.head_number(static_cast<int>(field.types.size()));
  for (const AnyField::Type type : field.types) sink.head_number(static_cast<int>(type));
  sink.end_of_head();
  for (std::size_t vertex = 0; vertex < field.vertex_count; ++vertex) {
    sink.begin_record(section);
    for (std::size_t component = 0; component < stride; ++component)
      sink.real(field.values[vertex * stride + component]);
    sink.end_record();
  }
  sink.end_of_file();
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

/// Fields are in files of their own, so their format is no mesh format.
void expect_ending_of_field(WriteOptions& options, const std::filesystem::path& path) {
  if (options.form != Form::by_name) return;
  const std::string ending = path.extension().string();
  if (ending != ".sol" && ending != ".solb")
    throw InputError(path.string() + ": expected a name that ends in .sol or .solb, found '" +
                     ending + "'; choose another name");
  options.format = ending == ".sol" ? ".sol" : ".solb";
}

int needed_version(const std::vector<Place>& sections, std::size_t head_numbers, Form form) {
  constexpr std::size_t limit = std::numeric_limits<std::int32_t>::max();
  std::size_t bytes = BinarySizes{2}.frame();
  for (const Place& section : sections) {
    if (section.count > limit) return 4;
    bytes += BinarySizes{2}.section(section, head_numbers);
  }
  return form == Form::binary && bytes > limit ? 3 : 2;
}

void choose_version(WriteOptions& options, const std::filesystem::path& path,
                    const std::vector<Place>& sections, std::size_t head_numbers) {
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
  expect_fit(mesh, options, path.string());
  choose_version(options, path, sections_of(mesh), 0);
  if (!mesh.names.empty())
    warn_of_lost(options, path, "names of references (" + std::to_string(mesh.names.size()) + ")");
  OutputFile& out = outputs.stage(path);
  if (options.form == Form::binary)
    put_mesh(BinarySink(out, options.version, options.byte_order), mesh);
  else
    put_mesh(TextSink(out, options.version), mesh);
}

void write_field(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& given) {
  WriteOptions options = given;
  expect_ending_of_field(options, path);
  choose_form(options, path);
  expect_fit(field, options, path.string());
  choose_version(options, path, {values_of(field)}, 1 + field.types.size());
  OutputFile& out = outputs.stage(path);
  if (options.form == Form::binary)
    put_field(BinarySink(out, options.version, options.byte_order), field);
  else
    put_field(TextSink(out, options.version), field);
}

void write_field(const std::filesystem::path& path, const AnyField& field,
                 const WriteOptions& options) {
  AtomicOutputs outputs;
  write_field(outputs, path, field, options);
  outputs.commit();
}

}  // namespace ductile::meshadapt
