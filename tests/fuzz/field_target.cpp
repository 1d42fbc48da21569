// Any bytes as a file of fields: the file is read, or refused by a message. Fields that are read
// must survive writing and reading; as a metric they are refused, or positive definite and accepted
// again.

#include <cmath>
#include <cstring>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "oracle.hpp"
#include "targets.hpp"

namespace ductile::fuzz {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::WriteOptions;

void expect_whole(const AnyField& field) {
  expect(field.dimension == 2 || field.dimension == 3, "the dimension is neither 2 nor 3");
  expect(field.values.size() == field.vertex_count * stride_of(field),
         "the number of values does not fit the vertices");
  for (const double value : field.values) expect(std::isfinite(value), "a value is not finite");
}

void expect_round_trip(const AnyField& field, std::size_t choice) {
  static MemoryFile file;
  file.set(nullptr, 0);
  WriteOptions options;
  options.form = choice % 2 == 0 ? WriteOptions::Form::ascii : WriteOptions::Form::binary;
  options.version = static_cast<int>(2 + choice / 2 % 3);
  options.byte_order = choice / 6 % 2 == 0 ? std::endian::little : std::endian::big;
  write_field(file.path(), field, options);
  const AnyField again = meshadapt::read_field(file.path());
  expect(again.dimension == field.dimension && again.vertex_count == field.vertex_count &&
             again.types == field.types && again.values.size() == field.values.size(),
         "another field after writing and reading");
  expect(field.values.empty() ||
             std::memcmp(again.values.data(), field.values.data(), 8 * field.values.size()) == 0,
         "other values after writing and reading");
}

/// A mesh of the field's dimension with as many vertices as the field has values for.
AnyMesh mesh_of(const AnyField& field) {
  AnyMesh mesh;
  mesh.dimension = field.dimension;
  mesh.coordinates.assign(field.vertex_count * static_cast<std::size_t>(field.dimension), 0);
  mesh.vertex_reference.assign(field.vertex_count, 0);
  mesh.name = "m";
  return mesh;
}

void use_as_metric(const AnyField& field) {
  const AnyMesh mesh = mesh_of(field);
  AnyField metric;
  try {
    metric = meshadapt::metric_of(field, mesh);
  } catch (const meshadapt::InputError& error) {
    expect_message(error.what());
    return;
  }
  expect_whole(metric);
  try {
    meshadapt::metric_of(metric, mesh);
  } catch (const meshadapt::InputError& error) {
    fail(std::string("a metric that was accepted is refused: ") + error.what());
  }
}

}  // namespace

void try_field(std::string_view, const std::uint8_t* bytes, std::size_t size) {
  static MemoryFile file;
  file.set(bytes, size);
  meshadapt::Warnings warnings;
  try {
    const AnyField field = meshadapt::read_field(file.path(), &warnings);
    expect_messages(warnings);
    expect_whole(field);
    expect_round_trip(field, size + bytes[size / 2]);
    use_as_metric(field);
    for (const auto& one : meshadapt::named_fields(field, "x"))
      expect(!one.name.empty(), "a field without a name");
  } catch (const meshadapt::InputError& error) {
    expect_message_of(file.path(), error.what());
  }
}

}  // namespace ductile::fuzz
