#include "spatial_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/flatten.hpp"
#include "mesh/indices.hpp"
#include "utf8.hpp"

namespace ductile::meshadapt {
namespace {

using Type = AnyField::Type;

/// Flattens a mesh, without a warning if it lies in z = 0: these formats have three coordinates.
void flatten_quietly(AnyMesh& mesh, Warnings* warnings) {
  bool in_plane = true;
  for (std::size_t i = 2; i < mesh.coordinates.size(); i += 3)
    in_plane = in_plane && mesh.coordinates[i] == 0;
  flatten(mesh, in_plane ? nullptr : warnings);
}

// ---- Fields that were read ----

/// The type of a field that is read, and the components of the file that it consists of.
struct Layout {
  Type type = Type::scalar;
  std::vector<std::size_t> from;  ///< [component]
};

/// The axes of space that a mesh has.
std::vector<std::size_t> axes_of(const AnyMesh& mesh) {
  std::vector<std::size_t> axes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (mesh.dimension == 3 || axis != static_cast<std::size_t>(mesh.dropped_axis))
      axes.push_back(axis);
  return axes;
}

/// [row][column] of a symmetric tensor of six components as VTK has them: xx yy zz xy yz xz.
constexpr std::array<std::array<std::size_t, 3>, 3> vtk_symmetric{
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

/// True if the tensors at these places are symmetric.
bool is_symmetric(const SpatialField& field, const std::vector<std::size_t>& places) {
  return std::all_of(places.begin(), places.end(), [&](std::size_t place) {
    const double* t = &field.values[9 * place];
    return t[1] == t[3] && t[2] == t[6] && t[5] == t[7];
  });
}

/// The layout for a field; without components if the mesh has no place for it.
Layout layout_of(const SpatialField& field, const std::vector<std::size_t>& places,
                 const AnyMesh& mesh) {
  const std::vector<std::size_t> axes = axes_of(mesh);
  const bool flat = mesh.dimension == 2;
  Layout layout;
  if (field.components == 1) return {Type::scalar, {0}};
  if (field.components == 3) return {Type::vector, axes};
  if (field.components == 2 && flat) return {Type::vector, {0, 1}};
  if (field.components == 4 && flat) return {Type::matrix, {0, 1, 2, 3}};
  if (field.components == 6 || (field.components == 9 && is_symmetric(field, places))) {
    layout.type = Type::symmetric;
    for (std::size_t row = 0; row < axes.size(); ++row)
      for (std::size_t column = 0; column <= row; ++column)
        layout.from.push_back(field.components == 6 ? vtk_symmetric[axes[row]][axes[column]]
                                                    : 3 * axes[row] + axes[column]);
  } else if (field.components == 9) {
    layout.type = Type::matrix;
    for (const std::size_t row : axes)
      for (const std::size_t column : axes) layout.from.push_back(3 * row + column);
  }
  return layout;
}

std::string what_is(const SpatialField& field) {
  return std::string(field.place == NamedField::Place::vertices ? "at vertices" : "in cells") +
         " '" + field.name + "'";
}

/// [vertex or element] its number in the file.
std::vector<std::size_t> places_of(const SpatialField& field, const SpatialMesh& spatial) {
  if (field.place == NamedField::Place::elements)
    return element_dimension(spatial.mesh) == 2 ? spatial.cell_of_triangle
                                                : spatial.cell_of_tetrahedron;
  std::vector<std::size_t> all(spatial.mesh.vertex_count());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

void take_field(MeshWithFields& to, const SpatialField& field, const SpatialMesh& spatial,
                Warnings* warnings) {
  const std::string begin = to.mesh.name + ": the field " + what_is(field) + " is left out: ";
  const std::vector<std::size_t> places = places_of(field, spatial);
  if (places.empty()) return warn(warnings, begin + "the mesh has no elements");
  const Layout layout = layout_of(field, places, to.mesh);
  if (layout.from.empty())
    return warn(warnings, begin + "it has " + std::to_string(field.components) +
                              " components, not those of a scalar, vector or tensor");
  NamedField taken{field.name, layout.type, {}, field.place, field.whole};
  taken.values.reserve(places.size() * layout.from.size());
  for (const std::size_t place : places)
    for (const std::size_t component : layout.from)
      taken.values.push_back(field.values[place * field.components + component]);
  if (std::any_of(taken.values.begin(), taken.values.end(), [](double x) { return std::isnan(x); }))
    return warn(warnings, begin + "it has no number everywhere");
  to.fields.push_back(std::move(taken));
}

// ---- Fields that are written ----

/// The index of component (row, column) among those of one place; -1 if there is none.
int component_at(Type type, int dimension, int row, int column) {
  if (row >= dimension || column >= dimension) return -1;
  if (type == Type::matrix) return row * dimension + column;
  if (type == Type::vector) return column;
  return std::max(row, column) * (std::max(row, column) + 1) / 2 + std::min(row, column);
}

/// Throws InputError unless a name is UTF-8 with the characters that XML can hold.
void expect_text(const std::string& name, std::size_t index) {
  for (std::size_t at = 0, length = 0; at < name.size(); at += length) {
    length = utf8_length(name, at);
    const auto first = static_cast<unsigned char>(name[at]);
    const bool is_control = first < 0x20 || first == 0x7F;
    const std::string_view character(&name[at], length);
    if (length == 0 || is_control || character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF")
      throw InputError("fields[" + std::to_string(index) +
                       "].name: expected UTF-8 without control characters, found another byte at " +
                       std::to_string(at));
  }
}

}  // namespace

MeshWithFields finish(SpatialMesh&& spatial, Warnings* warnings) {
  expect_finite_coordinates(runtime::Executor({.threads = 1}), spatial.mesh);
  flatten_quietly(spatial.mesh, warnings);
  MeshWithFields result;
  result.mesh.name = spatial.mesh.name;
  result.mesh.dimension = spatial.mesh.dimension;
  result.mesh.dropped_axis = spatial.mesh.dropped_axis;
  for (const SpatialField& field : spatial.fields) take_field(result, field, spatial, warnings);
  result.mesh = std::move(spatial.mesh);
  return result;
}

SpatialField in_space(const NamedField& field, const AnyMesh& mesh) {
  const auto stride = static_cast<std::size_t>(component_count(field.type, mesh.dimension));
  if (field.type == Type::scalar) return {field.name, field.place, 1, field.values, field.whole};
  const int rows = field.type == Type::vector ? 1 : 3;
  SpatialField wide{field.name, field.place, static_cast<std::size_t>(3 * rows), {}, field.whole};
  wide.values.reserve(field.values.size() / stride * wide.components);
  for (std::size_t first = 0; first < field.values.size(); first += stride)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 3; ++column) {
        const int from = component_at(field.type, mesh.dimension, row, column);
        wide.values.push_back(from < 0 ? 0.0
                                       : field.values[first + static_cast<std::size_t>(from)]);
      }
  return wide;
}

std::optional<std::vector<std::int64_t>> whole_values(const SpatialField& field,
                                                      std::size_t count) {
  constexpr double most = 9007199254740992;  // 2^53
  const auto is_whole = [](double x) { return std::abs(x) <= most && x == std::floor(x); };
  if (!field.whole || !std::all_of(field.values.begin(), field.values.end(), is_whole))
    return std::nullopt;
  std::vector<std::int64_t> values(count);
  std::transform(field.values.begin(), field.values.end(), values.begin(),
                 [](double x) { return static_cast<std::int64_t>(x); });
  return values;
}

std::vector<double> points_in_space(const AnyMesh& mesh) {
  return in_space({.name = {}, .type = Type::vector, .values = mesh.coordinates}, mesh).values;
}

void expect_fit_for_file(const AnyMesh& mesh, std::span<const NamedField> fields) {
  expect_coordinates(mesh);
  expect_references(mesh);
  expect_all_vertices(mesh);
  expect_finite_coordinates(runtime::Executor({.threads = 1}), mesh);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto& [name, type, values, at, whole] = fields[i];
    const std::string place = "fields[" + std::to_string(i) + "]";
    const int number = static_cast<int>(type);
    if (number < 1 || number > 4)
      throw InputError(place + ".type: expected 1 to 4, found " + std::to_string(number));
    const std::size_t expected =
        (at == NamedField::Place::vertices ? mesh.vertex_count() : element_count(mesh)) *
        static_cast<std::size_t>(component_count(type, mesh.dimension));
    if (values.size() != expected)
      throw InputError(place + ".values: expected " + std::to_string(expected) +
                       " numbers, found " + std::to_string(values.size()));
    expect_text(name, i);
  }
}

std::string beside_cells(const AnyMesh& mesh) {
  std::string text;
  const auto add = [&text](const char* what, std::size_t count) {
    if (count > 0)
      text += (text.empty() ? "" : ", ") + std::string(what) + " (" + std::to_string(count) + ")";
  };
  add("required vertices", mesh.required_vertices.size());
  add("required edges", mesh.required_edges.size());
  add("required triangles", mesh.required_triangles.size());
  add("required tetrahedra", mesh.required_tetrahedra.size());
  return text;
}

void warn_of_lost(const WriteOptions& options, const std::filesystem::path& path,
                  const std::string& lost) {
  if (!lost.empty())
    warn(options.warnings,
         path.string() + ": files of this format have no place for " + lost + ", which it lacks");
}

}  // namespace ductile::meshadapt
