/// @file
/// Meshes of ductile.h: from arrays, from files, and their arrays.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "handles.hpp"

namespace ductile::c {

namespace {

using meshadapt::AnyMesh;
using meshadapt::InputError;
using meshadapt::MeshArrays;

constexpr std::int64_t most_entities = std::numeric_limits<std::int32_t>::max();

thread_local std::string last_error;  // NOLINT: C functions cannot throw, so they set this

/// A span over `count` entries of `each` numbers; empty if the array is null, as omitted references
/// are.
template <class T>
std::span<const T> span_of(const T* array, std::int64_t count, std::int64_t each) {
  if (array == nullptr) return {};
  return {array, static_cast<std::size_t>(count * each)};
}

void expect_count(std::int64_t count, const char* name) {
  if (count > most_entities)
    throw InputError(std::string(name) + ": expected at most " + std::to_string(most_entities) +
                     " entries, found " + std::to_string(count));
}

/// The caller's cells. `corners` has the corners of one cell after the other.
template <class Index>
struct GivenCells {
  std::int64_t count;
  const Index* corners;
  const std::int32_t* reference;
};

/// Returns a mesh with the vertices of `mesh` and these elements or facets, after checking them.
template <class Index>
AnyMesh with_cells(const AnyMesh& mesh, const GivenCells<Index>& given, int each) {
  expect_array(given.corners, given.count, "corners");
  expect_count(given.count, "corners");
  MeshArrays<Index> arrays{.dimension = mesh.dimension,
                           .coordinates = mesh.coordinates,
                           .elements = {},
                           .vertex_reference = mesh.vertex_reference};
  const bool are_elements = each == mesh.dimension + 1;
  (are_elements ? arrays.elements : arrays.facets) = span_of(given.corners, given.count, each);
  (are_elements ? arrays.element_reference : arrays.facet_reference) =
      span_of(given.reference, given.count, 1);
  return meshadapt::mesh_from_arrays(runtime::Executor(), arrays);
}

/// Replaces the contents of a mesh except its names. It is no adapted mesh afterwards.
void replace(ductile_mesh& handle, AnyMesh&& mesh) {
  mesh.names = std::move(handle.mesh.names);
  handle = {std::move(mesh), {}, {}};
}

template <class Index>
int set_elements(ductile_mesh* handle, const GivenCells<Index>& given) {
  return guarded({{handle, "mesh"}}, [&] {
    replace(*handle, with_cells(handle->mesh, given, handle->mesh.dimension + 1));
  });
}

template <class Index>
int set_facets(ductile_mesh* handle, const GivenCells<Index>& given) {
  return guarded({{handle, "mesh"}}, [&] {
    AnyMesh mesh = handle->mesh;
    AnyMesh listed = with_cells(mesh, given, mesh.dimension);
    if (mesh.dimension == 2) {
      mesh.edges = std::move(listed.edges);
      mesh.required_edges.clear();
      mesh.ridges.clear();
    } else {
      mesh.triangles = std::move(listed.triangles);
      mesh.required_triangles.clear();
    }
    meshadapt::list_boundary(runtime::Executor(), mesh);
    handle->mesh = std::move(mesh);
  });
}

/// Returns the list of required entities of a kind; `count` becomes the number of all such
/// entities.
std::vector<std::uint32_t>& required_of(AnyMesh& mesh, int kind, std::size_t& count) {
  const bool flat = mesh.dimension == 2;
  switch (kind) {
    case DUCTILE_VERTICES:
      count = mesh.vertex_count();
      return mesh.required_vertices;
    case DUCTILE_FACETS:
      count = flat ? mesh.edges.size() : mesh.triangles.size();
      return flat ? mesh.required_edges : mesh.required_triangles;
    case DUCTILE_ELEMENTS:
      count = flat ? mesh.triangles.size() : mesh.tetrahedra.size();
      return flat ? mesh.required_triangles : mesh.required_tetrahedra;
    default:
      throw InputError(
          "kind: expected DUCTILE_VERTICES, DUCTILE_FACETS or DUCTILE_ELEMENTS, found " +
          std::to_string(kind));
  }
}

/// Calls use(cells) with the cells of this kind. Returns false if there are none of this kind.
bool visit_cells(const AnyMesh& mesh, int kind, auto&& use) {
  const bool flat = mesh.dimension == 2;
  if (kind == DUCTILE_RIDGES && !flat) return use(mesh.edges), true;
  if (kind == DUCTILE_FACETS) return flat ? use(mesh.edges) : use(mesh.triangles), true;
  if (kind == DUCTILE_ELEMENTS) return flat ? use(mesh.triangles) : use(mesh.tetrahedra), true;
  return false;
}

/// The kind of the entities of dimension `dimension` in a mesh; -1 if there is none.
int kind_of(int dimension, int mesh_dimension) {
  for (const int kind : {DUCTILE_VERTICES, DUCTILE_RIDGES, DUCTILE_FACETS, DUCTILE_ELEMENTS})
    if ((kind != DUCTILE_RIDGES || mesh_dimension == 3) &&
        dimension_of(kind, mesh_dimension) == dimension)
      return kind;
  return -1;
}

auto find_name(std::vector<meshadapt::ReferenceName>& names, int dimension,
               std::int32_t reference) {
  return std::find_if(names.begin(), names.end(), [&](const meshadapt::ReferenceName& one) {
    return one.dimension == dimension && one.reference == reference;
  });
}

template <class T>
const T* data_of(const std::vector<T>& values) {
  return values.empty() ? nullptr : values.data();
}

}  // namespace

void keep_error(const char* text) noexcept {
  try {
    last_error = text;
  } catch (...) {
    last_error = "no memory";  // short enough to need no allocation
  }
}

void keep_wrong_input(const char* text) noexcept {
  constexpr std::array<std::array<std::string_view, 2>, 7> names{
      {{"gradation:", "option hgrad:"},
       {"required_gradation:", "option hgradreq:"},
       {"hausdorff_tolerance:", "option hausd:"},
       {"ridge_angle:", "option ar:"},
       {"level:", "option ls:"},
       {"least_component:", "option rmc:"},
       {"bounds on sizes:", "hmin and hmax:"}}};
  keep_error(text);
  try {
    for (const auto& [theirs, ours] : names)
      if (last_error.starts_with(theirs)) return void(last_error.replace(0, theirs.size(), ours));
  } catch (...) {  // the previous text stays
  }
}

std::string number(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

}  // namespace ductile::c

using namespace ductile;  // NOLINT: the functions for C belong to no namespace

extern "C" {

const char* ductile_version() { return DUCTILE_VERSION; }

const char* ductile_last_error() { return c::last_error.c_str(); }

int ductile_mesh_create(int dimension, ductile_mesh** mesh) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    c::expect_dimension(dimension);
    auto made = std::make_unique<ductile_mesh>();
    made->mesh.dimension = dimension;
    *mesh = made.release();
  });
}

int ductile_mesh_set_vertices(ductile_mesh* mesh, int64_t count, const double* coordinates,
                              const int32_t* reference) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    c::expect_array(coordinates, count, "coordinates");
    c::expect_count(count, "coordinates");
    const c::MeshArrays<int32_t> arrays{
        .dimension = mesh->mesh.dimension,
        .coordinates = c::span_of(coordinates, count, mesh->mesh.dimension),
        .elements = {},
        .vertex_reference = c::span_of(reference, count, 1)};
    c::replace(*mesh, meshadapt::mesh_from_arrays(runtime::Executor(), arrays));
  });
}

int ductile_mesh_set_elements(ductile_mesh* mesh, int64_t count, const int32_t* corners,
                              const int32_t* reference) {
  return c::set_elements<int32_t>(mesh, {count, corners, reference});
}

int ductile_mesh_set_elements_64(ductile_mesh* mesh, int64_t count, const int64_t* corners,
                                 const int32_t* reference) {
  return c::set_elements<int64_t>(mesh, {count, corners, reference});
}

int ductile_mesh_set_facets(ductile_mesh* mesh, int64_t count, const int32_t* corners,
                            const int32_t* reference) {
  return c::set_facets<int32_t>(mesh, {count, corners, reference});
}

int ductile_mesh_set_facets_64(ductile_mesh* mesh, int64_t count, const int64_t* corners,
                               const int32_t* reference) {
  return c::set_facets<int64_t>(mesh, {count, corners, reference});
}

int ductile_mesh_require(ductile_mesh* mesh, int kind, int64_t count, const int32_t* indices) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    c::expect_array(indices, count, "indices");
    std::size_t entities = 0;
    std::vector<std::uint32_t>& required = c::required_of(mesh->mesh, kind, entities);
    for (std::int64_t i = 0; i < count; ++i)
      if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= entities)
        throw meshadapt::InputError(
            "indices[" + std::to_string(i) + "]: expected an index from 0 and below " +
            std::to_string(entities) + ", found " + std::to_string(indices[i]));
    required.assign(indices, indices + count);
  });
}

int ductile_mesh_join_vertices(ductile_mesh* mesh, double distance, int32_t* kept) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    auto joined = meshadapt::join_vertices(mesh->mesh, distance);
    if (kept != nullptr) std::copy(joined.kept.begin(), joined.kept.end(), kept);
    *mesh = {std::move(joined.mesh), {}, {}};
  });
}

int ductile_mesh_set_name(ductile_mesh* mesh, int kind, int32_t reference, const char* name) {
  return c::guarded({{mesh, "mesh"}}, [&] {
    const int dimension = c::dimension_of(kind, mesh->mesh.dimension);
    auto names = mesh->mesh.names;
    const auto found = c::find_name(names, dimension, reference);
    if (name == nullptr || *name == '\0') {
      if (found != names.end()) names.erase(found);
    } else if (found != names.end()) {
      found->name = name;
    } else {
      names.push_back({dimension, reference, name});
    }
    mesh->mesh.names = std::move(names);
  });
}

const char* ductile_mesh_name(const ductile_mesh* mesh, int kind, int32_t reference) {
  if (mesh == nullptr) return nullptr;
  const auto& names = mesh->mesh.names;
  for (const auto& one : names)
    if (one.reference == reference && c::kind_of(one.dimension, mesh->mesh.dimension) == kind)
      return one.name.c_str();
  return nullptr;
}

const char* ductile_mesh_name_at(const ductile_mesh* mesh, int64_t i, int* kind,
                                 int32_t* reference) {
  if (mesh == nullptr) return nullptr;
  const auto& names = mesh->mesh.names;
  if (i < 0 || static_cast<std::size_t>(i) >= names.size()) return nullptr;
  const auto& one = names[static_cast<std::size_t>(i)];
  if (kind != nullptr) *kind = c::kind_of(one.dimension, mesh->mesh.dimension);
  if (reference != nullptr) *reference = one.reference;
  return one.name.c_str();
}

int ductile_mesh_read(const char* path, ductile_mesh** mesh) {
  return c::guarded({{path, "path"}, {mesh, "mesh"}}, [&] {
    auto read = std::make_unique<ductile_mesh>();
    read->mesh = meshadapt::read_mesh(path);
    meshadapt::list_boundary(runtime::Executor(), read->mesh);
    *mesh = read.release();
  });
}

int ductile_mesh_write(const ductile_mesh* mesh, const char* path) {
  return c::guarded({{mesh, "mesh"}, {path, "path"}}, [&] {
    const std::filesystem::path file(path);
    const auto* const format = meshadapt::format_of(file);
    std::vector<meshadapt::NamedField> fields;
    if (format != nullptr && format->holds_fields && !mesh->metric.values.empty())
      fields = meshadapt::named_fields(mesh->metric, "metric");
    meshadapt::write_mesh(file, mesh->mesh, {.fields = fields});
  });
}

void ductile_mesh_destroy(ductile_mesh* mesh) { delete mesh; }

int ductile_mesh_dimension(const ductile_mesh* mesh) {
  return mesh == nullptr ? 0 : mesh->mesh.dimension;
}

int64_t ductile_mesh_count(const ductile_mesh* mesh, int kind) {
  if (mesh == nullptr) return -1;
  if (kind == DUCTILE_VERTICES) return static_cast<int64_t>(mesh->mesh.vertex_count());
  int64_t count = kind == DUCTILE_RIDGES ? 0 : -1;
  c::visit_cells(mesh->mesh, kind,
                 [&](const auto& cells) { count = static_cast<int64_t>(cells.size()); });
  return count;
}

const double* ductile_mesh_coordinates(const ductile_mesh* mesh) {
  return mesh == nullptr ? nullptr : c::data_of(mesh->mesh.coordinates);
}

const int32_t* ductile_mesh_corners(const ductile_mesh* mesh, int kind) {
  const int32_t* corners = nullptr;
  if (mesh == nullptr) return corners;
  c::visit_cells(mesh->mesh, kind, [&](const auto& cells) {
    if (cells.size() != 0)  // the signed type of the same size may alias the unsigned one
      corners = reinterpret_cast<const int32_t*>(cells.vertices[0].data());
  });
  return corners;
}

const int32_t* ductile_mesh_references(const ductile_mesh* mesh, int kind) {
  if (mesh == nullptr) return nullptr;
  if (kind == DUCTILE_VERTICES) return c::data_of(mesh->mesh.vertex_reference);
  const int32_t* reference = nullptr;
  c::visit_cells(mesh->mesh, kind,
                 [&](const auto& cells) { reference = c::data_of(cells.reference); });
  return reference;
}

const double* ductile_mesh_metric(const ductile_mesh* mesh) {
  return mesh == nullptr ? nullptr : c::data_of(mesh->metric.values);
}

}  // extern "C"
