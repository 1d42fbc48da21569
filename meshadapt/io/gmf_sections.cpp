#include "gmf_sections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "ductile/runtime/arrays.hpp"

namespace ductile::meshadapt::gmf {

/// Gives a vector that holds nothing n elements, all of which are about to be read.
template <class T>
static void make_room(std::vector<T>& empty, std::size_t n) {
  runtime::resize_empty(runtime::Executor({.threads = 1}), runtime::EmptyVector{empty, n});
}

// ---- Heads ----

template <class Cursor>
void SectionReader<Cursor>::read_dimension() {
  in_.enter(Keyword::dimension, 1);
  const std::int64_t dimension = in_.small_integer();
  if (target_.dimension() != 0) in_.fail("expected one Dimension, found a second; remove one");
  if (dimension != 2 && dimension != 3)
    in_.fail("expected Dimension 2 or 3, found " + std::to_string(dimension) +
             "; only these can be adapted");
  target_.dimension() = static_cast<int>(dimension);
  in_.leave();
}

template <class Cursor>
std::uint64_t SectionReader<Cursor>::read_count(Keyword keyword) {
  in_.enter(keyword, 0);
  const std::int64_t count = in_.count();
  if (count < 0 || count >= std::numeric_limits<std::uint32_t>::max())
    in_.fail("expected a count from 0 to 4294967294 of " + std::string(name_of(keyword)) +
             ", found " + std::to_string(count) + "; correct it");
  return static_cast<std::uint64_t>(count);
}

template <class Cursor>
void SectionReader<Cursor>::expect_once(Keyword keyword) const {
  const std::string name(name_of(keyword));
  if (target_.dimension() == 0)
    in_.fail("expected Dimension before " + name + ", found none; put it first");
  if (find(keyword)) in_.fail("expected one section " + name + ", found a second; join them");
}

template <class Cursor>
void SectionReader<Cursor>::refuse_other_cells(Keyword keyword, std::uint64_t count) const {
  if (count != 0 && target_.mesh)
    in_.fail("expected edges, triangles and tetrahedra only, found " + std::to_string(count) + " " +
             std::string(name_of(keyword)) +
             " (mixed or unsupported elements); split them into linear simplices first");
}

// ---- Sections ----

template <class Cursor>
void SectionReader<Cursor>::read(Keyword keyword) {
  expect_once(keyword);
  const std::uint64_t count = read_count(keyword);
  in_.enter(keyword, count);
  if (keyword == Keyword::tetrahedra && count != 0 && target_.dimension() == 2)
    in_.fail("expected no Tetrahedra in Dimension 2, found " + std::to_string(count) +
             "; correct the Dimension");
  AnyMesh* const mesh = target_.mesh;
  switch (keyword) {
    case Keyword::field_at_vertices:
      read_field(count);
      break;
    case Keyword::vertices:
      read_vertices(count);
      break;
    case Keyword::edges:
      read_cells(count, mesh->edges);
      break;
    case Keyword::triangles:
      read_cells(count, mesh->triangles);
      break;
    case Keyword::tetrahedra:
      read_cells(count, mesh->tetrahedra);
      break;
    case Keyword::corners:
      read_list(count, mesh->corners);
      break;
    case Keyword::ridges:
      read_list(count, mesh->ridges);
      break;
    case Keyword::required_vertices:
      read_list(count, mesh->required_vertices);
      break;
    case Keyword::required_edges:
      read_list(count, mesh->required_edges);
      break;
    case Keyword::required_triangles:
      read_list(count, mesh->required_triangles);
      break;
    default:
      read_list(count, mesh->required_tetrahedra);
      break;
  }
  in_.leave();
}

template <class Cursor>
void SectionReader<Cursor>::read_vertices(std::uint64_t count) {
  AnyMesh& mesh = *target_.mesh;
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  places_.push_back(in_.enter_records({dimension, 1}));
  make_room(mesh.coordinates, count * dimension);
  make_room(mesh.vertex_reference, count);
  double* coordinate = mesh.coordinates.data();
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    in_.record(vertex);
    for (std::size_t axis = 0; axis < dimension; ++axis) *coordinate++ = read_real();
    mesh.vertex_reference[vertex] = read_reference();
  }
}

template <class Cursor>
template <int Corners>
void SectionReader<Cursor>::read_cells(std::uint64_t count, Cells<Corners>& cells) {
  places_.push_back(in_.enter_records({0, Corners + 1}));
  make_room(cells.vertices, count);
  make_room(cells.reference, count);
  for (std::size_t cell = 0; cell < count; ++cell) {
    in_.record(cell);
    for (std::uint32_t& vertex : cells.vertices[cell]) vertex = read_index();
    cells.reference[cell] = read_reference();
  }
}

template <class Cursor>
void SectionReader<Cursor>::read_list(std::uint64_t count, std::vector<std::uint32_t>& list) {
  places_.push_back(in_.enter_records({0, 1}));
  make_room(list, count);
  for (std::size_t entry = 0; entry < count; ++entry) {
    in_.record(entry);
    list[entry] = read_index();
  }
}

template <class Cursor>
void SectionReader<Cursor>::read_field(std::uint64_t count) {
  AnyField& field = *target_.field;
  const std::int64_t fields = in_.small_integer();
  if (fields < 1 || fields > 1000)
    in_.fail("expected a number of fields from 1 to 1000, found " + std::to_string(fields) +
             "; correct it");
  for (std::int64_t i = 0; i < fields; ++i) {
    const std::int64_t type = in_.small_integer();
    if (type < 1 || type > 4)
      in_.fail(
          "expected a field's type, 1 (scalar), 2 (vector), 3 (symmetric) or 4 (matrix), "
          "found " +
          std::to_string(type) + "; correct it");
    field.types.push_back(static_cast<AnyField::Type>(type));
  }
  const std::size_t stride = stride_of(field);
  places_.push_back(in_.enter_records({stride, 0}));
  field.vertex_count = count;
  make_room(field.values, count * stride);
  double* value = field.values.data();
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    in_.record(vertex);
    for (std::size_t component = 0; component < stride; ++component) *value++ = read_value();
  }
}

// ---- Numbers ----

template <class Cursor>
std::uint32_t SectionReader<Cursor>::read_index() {
  const std::int64_t number = in_.integer();
  if (number < 1 || number >= std::numeric_limits<std::uint32_t>::max()) [[unlikely]]
    in_.fail_number("an index of at least 1", std::to_string(number));
  return static_cast<std::uint32_t>(number - 1);
}

template <class Cursor>
std::int32_t SectionReader<Cursor>::read_reference() {
  const std::int64_t number = in_.integer();
  if (number != static_cast<std::int32_t>(number)) [[unlikely]]
    in_.fail_number("a reference of 32 bits", std::to_string(number));
  return static_cast<std::int32_t>(number);
}

template <class Cursor>
double SectionReader<Cursor>::read_real() {
  const double number = in_.real();
  if (!std::isfinite(number)) [[unlikely]]
    in_.fail_number("a finite number", std::to_string(number));
  return number;
}

template <class Cursor>
double SectionReader<Cursor>::read_value() {
  if (!target_.infinite) return read_real();
  const double number = in_.real_or_infinite();
  if (std::isnan(number)) [[unlikely]]
    in_.fail_number("a number", std::to_string(number));
  return number;
}

// ---- Checks ----

template <class Cursor>
const Place* SectionReader<Cursor>::find(Keyword keyword) const {
  for (const Place& place : places_)
    if (place.keyword == keyword) return &place;
  return nullptr;
}

template <class Cursor>
void SectionReader<Cursor>::expect_below(Keyword keyword, const std::uint32_t* indices,
                                         std::uint64_t per_record, std::size_t limit,
                                         Keyword counted) const {
  const Place* const place = find(keyword);
  if (!place) return;
  std::uint32_t largest = 0;
  const std::uint64_t total = place->count * per_record;
  for (std::uint64_t i = 0; i < total; ++i) largest = std::max(largest, indices[i]);
  if (total == 0 || largest < limit) return;
  const auto wrong = static_cast<std::uint64_t>(
      std::find_if(indices, indices + total, [&](std::uint32_t i) { return i >= limit; }) -
      indices);
  const std::size_t record = wrong / per_record;
  in_.fail_in(*place, record, static_cast<int>(wrong % per_record),
              "expected an index up to " + std::to_string(limit) + ", the count of " +
                  std::string(name_of(counted)) + ", in " + record_name(*place, record) +
                  ", found " + std::to_string(std::uint64_t{indices[wrong]} + 1) +
                  "; correct the index or the count");
}

template <class Cursor>
void SectionReader<Cursor>::finish() const {
  const Keyword main = target_.mesh ? Keyword::vertices : Keyword::field_at_vertices;
  const Place* const place = find(main);
  if (!place || place->count == 0)
    in_.fail("expected the section " + std::string(name_of(main)) + ", found " +
             (place ? "it empty" : "none") +
             (target_.mesh ? "; give a mesh file" : "; give a file with a field at the vertices"));
  if (!target_.mesh) return;
  const AnyMesh& mesh = *target_.mesh;
  const std::size_t vertices = mesh.vertex_count();
  const auto cells = [&](Keyword keyword, const auto& list) {
    constexpr std::size_t corners = std::tuple_size_v<std::decay_t<decltype(list.vertices[0])>>;
    const std::uint32_t* first = list.size() ? list.vertices[0].data() : nullptr;
    expect_below(keyword, first, corners, vertices, Keyword::vertices);
  };
  const auto list = [&](Keyword keyword, const auto& indices, std::size_t limit, Keyword counted) {
    expect_below(keyword, indices.data(), 1, limit, counted);
  };
  cells(Keyword::edges, mesh.edges);
  cells(Keyword::triangles, mesh.triangles);
  cells(Keyword::tetrahedra, mesh.tetrahedra);
  list(Keyword::corners, mesh.corners, vertices, Keyword::vertices);
  list(Keyword::required_vertices, mesh.required_vertices, vertices, Keyword::vertices);
  list(Keyword::ridges, mesh.ridges, mesh.edges.size(), Keyword::edges);
  list(Keyword::required_edges, mesh.required_edges, mesh.edges.size(), Keyword::edges);
  list(Keyword::required_triangles, mesh.required_triangles, mesh.triangles.size(),
       Keyword::triangles);
  list(Keyword::required_tetrahedra, mesh.required_tetrahedra, mesh.tetrahedra.size(),
       Keyword::tetrahedra);
}

template class SectionReader<AsciiCursor>;
template class SectionReader<BinaryCursor>;

}  // namespace ductile::meshadapt::gmf
