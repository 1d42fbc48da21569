#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "ductile/runtime/arrays.hpp"
#include "gmf_reader.hpp"

namespace ductile::meshadapt::gmf {

/// Gives a vector that holds nothing n elements, all of which are about to be read.
template <class T>
static void make_room(std::vector<T>& empty, std::size_t n) {
  runtime::resize_empty(runtime::Executor({.threads = 1}), runtime::EmptyVector{empty, n});
}

// ---- Heads ----

void GmfReader::read_dimension() {
  section_ = {.keyword = Keyword::dimension};
  const std::int64_t dimension = small_integer();
  if (target_.dimension() != 0) fail("expected one Dimension, found a second; remove one");
  if (dimension != 2 && dimension != 3)
    fail("expected Dimension 2 or 3, found ", dimension, "; only these can be adapted");
  target_.dimension() = static_cast<int>(dimension);
  expect_section_end();
}

std::uint64_t GmfReader::read_count(Keyword keyword) {
  section_ = {.keyword = keyword};
  const std::int64_t count = integer();
  if (count < 0 || count >= std::numeric_limits<std::uint32_t>::max())
    fail("expected a count from 0 to 4294967294 of ", name_of(keyword), ", found ", count,
         "; correct it");
  return static_cast<std::uint64_t>(count);
}

void GmfReader::expect_once(Keyword keyword) const {
  const std::string name(name_of(keyword));
  if (target_.dimension() == 0)
    fail("expected Dimension before ", name, ", found none; put it first");
  if (find(keyword)) fail("expected one section ", name, ", found a second; join them");
}

void GmfReader::refuse_other_cells(Keyword keyword, std::uint64_t count) const {
  if (count != 0 && target_.mesh)
    fail("expected edges, triangles and tetrahedra only, found ", count, " ", name_of(keyword),
         " (mixed or unsupported elements); split them into linear simplices first");
}

// ---- Sections ----

void GmfReader::read_section(Keyword keyword) {
  expect_once(keyword);
  const std::uint64_t count = read_count(keyword);
  section_.count = count;
  if (keyword == Keyword::tetrahedra && count != 0 && target_.dimension() == 2)
    fail("expected no Tetrahedra in Dimension 2, found ", count, "; correct the Dimension");
  read_records(keyword, count);
  expect_section_end();
}

void GmfReader::begin_records(std::uint64_t reals, std::uint64_t integers) {
  section_.reals = reals;
  section_.integers = integers;
  section_.begin = in_.position();
  const std::uint64_t bytes = reals * sizes_.real() + integers * sizes_.integer();
  in_.expect_room(section_.count, {section_.numbers(), bytes},
                  std::string(name_of(section_.keyword)));
  read_.push_back(section_);
}

void GmfReader::read_records(Keyword keyword, std::uint64_t count) {
  AnyMesh* const mesh = target_.mesh;
  switch (keyword) {
    case Keyword::field_at_vertices:
      return read_field(count);
    case Keyword::vertices:
      return read_vertices(count);
    case Keyword::edges:
      return read_cells(count, mesh->edges);
    case Keyword::triangles:
      return read_cells(count, mesh->triangles);
    case Keyword::tetrahedra:
      return read_cells(count, mesh->tetrahedra);
    default:
      for (const auto& [of_list, indices, marked] : marked_lists)
        if (keyword == of_list) read_list(count, mesh->*indices);
  }
}

void GmfReader::read_vertices(std::uint64_t count) {
  AnyMesh& mesh = *target_.mesh;
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  begin_records(dimension, 1);
  make_room(mesh.coordinates, count * dimension);
  make_room(mesh.vertex_reference, count);
  double* coordinate = mesh.coordinates.data();
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    record_ = vertex;
    for (std::size_t axis = 0; axis < dimension; ++axis) *coordinate++ = read_real(false);
    mesh.vertex_reference[vertex] = read_reference();
  }
}

template <int Corners>
void GmfReader::read_cells(std::uint64_t count, Cells<Corners>& cells) {
  begin_records(0, Corners + 1);
  make_room(cells.vertices, count);
  make_room(cells.reference, count);
  for (std::size_t cell = 0; cell < count; ++cell) {
    record_ = cell;
    for (std::uint32_t& vertex : cells.vertices[cell]) vertex = read_index();
    cells.reference[cell] = read_reference();
  }
}

void GmfReader::read_list(std::uint64_t count, std::vector<std::uint32_t>& list) {
  begin_records(0, 1);
  make_room(list, count);
  for (std::size_t entry = 0; entry < count; ++entry) {
    record_ = entry;
    list[entry] = read_index();
  }
}

void GmfReader::read_field(std::uint64_t count) {
  AnyField& field = *target_.field;
  const std::int64_t fields = small_integer();
  if (fields < 1 || fields > 1000)
    fail("expected a number of fields from 1 to 1000, found ", fields, "; correct it");
  for (std::int64_t i = 0; i < fields; ++i) {
    const std::int64_t type = small_integer();
    if (type < 1 || type > 4)
      fail(
          "expected a field's type, 1 (scalar), 2 (vector), 3 (symmetric) or 4 (matrix), "
          "found ",
          type, "; correct it");
    field.types.push_back(static_cast<AnyField::Type>(type));
  }
  const std::size_t stride = stride_of(field);
  begin_records(stride, 0);
  field.vertex_count = count;
  make_room(field.values, count * stride);
  double* value = field.values.data();
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    record_ = vertex;
    for (std::size_t component = 0; component < stride; ++component)
      *value++ = read_real(target_.infinite);
  }
}

// ---- Numbers ----

std::int64_t GmfReader::integer(bool wide) {
  std::int64_t value = 0;
  std::int32_t narrow = 0;
  const bool is_there = wide ? in_.take(value) : in_.take(narrow);
  if (!is_there) [[unlikely]]
    fail_word("an integer");
  return wide ? value : narrow;
}

std::uint32_t GmfReader::read_index() {
  const std::int64_t number = integer();
  if (number < 1 || number >= std::numeric_limits<std::uint32_t>::max()) [[unlikely]]
    fail_number("an index of at least 1", std::to_string(number));
  return static_cast<std::uint32_t>(number - 1);
}

std::int32_t GmfReader::read_reference() {
  const std::int64_t number = integer();
  if (number != static_cast<std::int32_t>(number)) [[unlikely]]
    fail_number("a reference of 32 bits", std::to_string(number));
  return static_cast<std::int32_t>(number);
}

double GmfReader::read_real(bool infinite) {
  double value = 0;
  float narrow = 0;
  const bool single = sizes_.real() == 4;
  const bool is_there = single ? in_.take(narrow) : in_.take(value);
  if (single) value = static_cast<double>(narrow);
  if (is_there && (std::isfinite(value) || (infinite && !std::isnan(value)))) [[likely]]
    return value;
  const char* const expected = infinite ? "a number" : "a finite number";
  if (is_there && in_.is_binary()) fail_number(expected, std::to_string(value));
  fail_word(expected);
}

// ---- Checks ----

const Section* GmfReader::find(Keyword keyword) const {
  for (const Section& section : read_)
    if (section.keyword == keyword) return &section;
  return nullptr;
}

void GmfReader::expect_below(Keyword keyword, const std::uint32_t* indices,
                             std::uint64_t per_record, std::size_t limit, Keyword counted) {
  const Section* const section = find(keyword);
  if (!section) return;
  const std::uint64_t total = section->count * per_record;
  const auto* const wrong =
      std::find_if(indices, indices + total, [&](std::uint32_t i) { return i >= limit; });
  if (wrong == indices + total) return;
  const auto at = static_cast<std::uint64_t>(wrong - indices);
  section_ = *section;
  record_ = at / per_record;
  in_.set_end(size_);  // goes to the number again, for its place in the message
  in_.go_to(section_.begin);
  for (std::uint64_t n = record_ * section_.numbers() + at % per_record + 1; n > 0; --n) integer();
  fail("expected an index up to ", limit, ", the count of ", name_of(counted), ", in ",
       record_name(section_, record_), ", found ", std::uint64_t{*wrong} + 1,
       "; correct the index or the count");
}

void GmfReader::finish() {
  const Keyword main = target_.mesh ? Keyword::vertices : Keyword::field_at_vertices;
  const Section* const place = find(main);
  if (!place || place->count == 0)
    fail("expected the section " + std::string(name_of(main)) + ", found " +
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
  cells(Keyword::edges, mesh.edges);
  cells(Keyword::triangles, mesh.triangles);
  cells(Keyword::tetrahedra, mesh.tetrahedra);
  for (const auto& [keyword, indices, marked] : marked_lists)
    expect_below(keyword, (mesh.*indices).data(), 1, entity_count(mesh, marked), marked);
}

}  // namespace ductile::meshadapt::gmf
