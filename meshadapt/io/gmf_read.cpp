#include <algorithm>
#include <cstdint>
#include <new>
#include <string>

#include "ductile/meshadapt/gmf.hpp"
#include "file_bytes.hpp"
#include "gmf_ascii.hpp"
#include "gmf_binary.hpp"
#include "gmf_sections.hpp"

namespace ductile::meshadapt {
namespace {

using gmf::AsciiCursor;
using gmf::BinaryCursor;
using gmf::Keyword;
using gmf::Role;
using gmf::SectionReader;
using gmf::Target;

std::string left_out(Keyword keyword, std::uint64_t count) {
  std::string text(gmf::name_of(keyword));
  if (gmf::has_count(keyword)) text += " (" + std::to_string(count) + ")";
  return text + " is not used by Ductile; left out";
}

// ---- Text ----

void read_version(AsciiCursor& in) {
  const std::string_view first = in.word();
  if (gmf::keyword_named(first) != Keyword::version)
    in.fail(
        "expected MeshVersionFormatted, the beginning of a Medit file, found something else; "
        "give a .mesh, .meshb, .sol or .solb file");
  in.enter(Keyword::version, 1);
  const std::int64_t version = in.integer();
  if (version < 1 || version > 4)
    in.fail("expected version 1 to 4, found " + std::to_string(version) +
            "; write the file in one of them");
}

/// Goes past the lines of a section of text, which may have any words in them; a keyword alone, or
/// before a number, is the next section.
void skip_lines(AsciiCursor& in, std::uint64_t count) {
  for (; count > 0 && !in.peek().empty(); --count) {
    if (gmf::keyword_named(in.peek()) != Keyword::none) {
      AsciiCursor ahead = in;
      ahead.word();
      const char next = ahead.rest_of_line_begins_with();
      if (next == '\0' || (next >= '0' && next <= '9')) return;
    }
    in.skip_line();
  }
}

/// Goes on to the next keyword; numbers on the way are not looked at.
void skip_section(AsciiCursor& in, Keyword keyword) {
  for (;;) {
    const std::string_view next = in.peek();
    const bool is_number = next.find_first_of("0123456789") != std::string_view::npos &&
                           next.find_first_not_of("+-.0123456789eEdD") == std::string_view::npos;
    const bool goes_on =
        gmf::has_text(keyword) ? gmf::keyword_named(next) == Keyword::none : is_number;
    if (next.empty() || !goes_on) return;
    in.word();
  }
}

/// The keyword that was taken from the text; an error if it is none.
Keyword known_keyword(const AsciiCursor& in, std::string_view word) {
  const Keyword keyword = gmf::keyword_named(word);
  if (keyword == Keyword::none) in.fail_keyword(word, gmf::similar_name(word));
  if (keyword == Keyword::version)
    in.fail("expected one MeshVersionFormatted, found a second; remove one");
  return keyword;
}

void read_section(AsciiCursor& in, SectionReader<AsciiCursor>& sections, const Target& target,
                  Keyword keyword) {
  if (keyword == Keyword::dimension) return sections.read_dimension();
  if (sections.wants(keyword)) return sections.read(keyword);
  const std::string where = in.where();
  const std::uint64_t count = gmf::has_count(keyword) ? sections.read_count(keyword) : 1;
  if (gmf::role_of(keyword) == Role::other_cells) sections.refuse_other_cells(keyword, count);
  if (gmf::has_text(keyword)) skip_lines(in, count);
  skip_section(in, keyword);
  target.warn(where + left_out(keyword, count));
}

void read_text(const FileBytes& bytes, const Target& target) {
  AsciiCursor in(bytes);
  SectionReader sections(in, target);
  read_version(in);
  for (;;) {
    const std::string_view word = in.word();
    if (word.empty()) {
      if (in.ends_within_a_line())
        in.fail(
            "expected the keyword End or the end of a line, found the end of the file; the "
            "file is cut short, write or copy it again");
      target.warn(in.where() +
                  "expected the keyword End, found the end of the file; it is "
                  "complete only if nothing was cut off");
      break;
    }
    const Keyword keyword = known_keyword(in, word);
    if (keyword == Keyword::end) {
      if (!in.word().empty())
        in.fail("expected nothing after the keyword End, found more; remove it");
      break;
    }
    read_section(in, sections, target, keyword);
  }
  sections.finish();
}

// ---- Binary ----

void read_section(BinaryCursor& in, SectionReader<BinaryCursor>& sections, const Target& target,
                  Keyword keyword) {
  if (keyword == Keyword::dimension) return sections.read_dimension();
  if (sections.wants(keyword)) return sections.read(keyword);
  if (gmf::name_of(keyword).empty())
    return target.warn(in.where() + std::to_string(in.section_bytes()) +
                       " bytes of a section unknown to Ductile; left out");
  const std::string where = in.where();
  const std::uint64_t count = gmf::has_count(keyword) ? sections.read_count(keyword) : 1;
  if (gmf::role_of(keyword) == Role::other_cells) sections.refuse_other_cells(keyword, count);
  target.warn(where + left_out(keyword, count));
}

void read_binary(const FileBytes& bytes, const Target& target) {
  BinaryCursor in(bytes);
  SectionReader sections(in, target);
  for (;;) {
    const Keyword keyword = in.next_section();
    if (keyword == Keyword::none || keyword == Keyword::end) break;
    read_section(in, sections, target, keyword);
  }
  if (in.chain_ended_without_end())
    target.warn(in.where() +
                "the file ends without the keyword End; it is complete only if "
                "nothing was cut off");
  if (const std::size_t left = in.bytes_after_end())
    in.fail("expected nothing after the keyword End, found " + std::to_string(left) +
            " bytes; remove them or write the file again");
  sections.finish();
}

// ---- Both ----

void read_gmf(const std::filesystem::path& path, const Target& target) {
  try {
    const FileBytes bytes = read_bytes(path);
    BinaryCursor::recognises(bytes) ? read_binary(bytes, target) : read_text(bytes, target);
  } catch (const std::bad_alloc&) {
    throw Error(path.string() +
                ": not enough memory to read the file; allow more or use a larger machine");
  }
}

/// A flat mesh given in space becomes one of the plane.
void flatten(AnyMesh& mesh, Warnings* warnings) {
  if (mesh.dimension != 3 || mesh.tetrahedra.size() != 0 || mesh.triangles.size() == 0) return;
  const double height = mesh.coordinates[2];
  const std::size_t count = mesh.vertex_count();
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    if (mesh.coordinates[3 * vertex + 2] != height) return;
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    for (std::size_t axis = 0; axis < 2; ++axis)
      mesh.coordinates[2 * vertex + axis] = mesh.coordinates[3 * vertex + axis];
  mesh.coordinates.resize(2 * count);
  mesh.dimension = 2;
  if (warnings)
    warnings->push_back(mesh.name + ": Dimension is 3, but all vertices lie in z = " +
                        std::to_string(height) + "; taken as a mesh of dimension 2");
}

}  // namespace

AnyMesh read_mesh(const std::filesystem::path& path, Warnings* warnings) {
  AnyMesh mesh;
  mesh.name = path.string();
  read_gmf(path, {&mesh, nullptr, warnings});
  flatten(mesh, warnings);
  return mesh;
}

AnyField read_field(const std::filesystem::path& path, Warnings* warnings) {
  AnyField field;
  field.name = path.string();
  read_gmf(path, {nullptr, &field, warnings});
  return field;
}

}  // namespace ductile::meshadapt
