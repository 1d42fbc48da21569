#include <algorithm>
#include <cstdint>
#include <new>
#include <optional>
#include <string>

#include "ductile/meshadapt/files.hpp"
#include "file_bytes.hpp"
#include "gmf_ascii.hpp"
#include "gmf_binary.hpp"
#include "gmf_left_out.hpp"
#include "gmf_mesh.hpp"
#include "gmf_sections.hpp"
#include "gmf_skip.hpp"
#include "mesh/flatten.hpp"

namespace ductile::meshadapt {
namespace {

using gmf::AsciiCursor;
using gmf::BinaryCursor;
using gmf::Keyword;
using gmf::LeftOut;
using gmf::Role;
using gmf::SectionReader;
using gmf::Target;

// ---- Text ----

void read_version(AsciiCursor& in) {
  const std::string_view first = in.word();
  if (first == "View")
    in.fail(
        "expected a mesh, found a view of Gmsh's (.pos), which has values but no mesh; give "
        "a .msh with the field in it, as Gmsh, meshio and ductile write it");
  if (gmf::keyword_named(first) != Keyword::version)
    in.fail(
        "expected MeshVersionFormatted, the beginning of a Medit file, found something else; "
        "give a .mesh, .meshb, .msh, .vtu, .vtk, .sol or .solb file");
  in.enter(Keyword::version, 1);
  const std::int64_t version = in.integer();
  if (version < 0 || version > 4)  // bamg and FreeFEM write 0
    in.fail("expected version 1 to 4, found " + std::to_string(version) +
            "; write the file in one of them");
}

/// Goes past a section that is not read; refuses one of cells that a mesh here cannot have.
void leave_out(AsciiCursor& in, const SectionReader<AsciiCursor>& sections, std::string_view name,
               LeftOut& left_out) {
  const Keyword keyword = gmf::keyword_named(name);
  const bool has_count = keyword != Keyword::none && gmf::has_count(keyword);
  std::optional<std::uint64_t> count;
  if (has_count) count = gmf::count_ahead(in);
  if (gmf::role_of(keyword) == Role::other_cells)
    sections.refuse_other_cells(keyword, count.value_or(1));
  left_out.add(in.where(), name, count ? " (" + std::to_string(*count) + ")" : "");
  if (count && gmf::has_text(keyword)) {
    in.word();
    gmf::skip_lines(in, *count);
  }
  name == "Geometry" ? gmf::skip_geometry(in) : gmf::skip_section(in);
}

void read_section(AsciiCursor& in, SectionReader<AsciiCursor>& sections, std::string_view word,
                  LeftOut& left_out) {
  const Keyword keyword = gmf::keyword_named(word);
  if (keyword == Keyword::none) {
    const std::string_view similar = gmf::similar_name(word);
    if (!similar.empty() || !gmf::is_section_name(word)) in.fail_keyword(word, similar);
  }
  if (keyword == Keyword::version)
    in.fail("expected one MeshVersionFormatted, found a second; remove one");
  if (keyword == Keyword::dimension) return sections.read_dimension();
  sections.wants(keyword) ? sections.read(keyword) : leave_out(in, sections, word, left_out);
}

void read_text(const FileBytes& bytes, const Target& target) {
  AsciiCursor in(bytes);
  SectionReader sections(in, target);
  LeftOut left_out;
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
    if (gmf::keyword_named(word) == Keyword::end) {
      if (!in.word().empty())
        in.fail("expected nothing after the keyword End, found more; remove it");
      break;
    }
    read_section(in, sections, word, left_out);
  }
  target.warn_of(left_out);
  sections.finish();
}

// ---- Binary ----

/// The next section is found by its link, whatever is in this one.
void leave_out(BinaryCursor& in, SectionReader<BinaryCursor>& sections, Keyword keyword,
               LeftOut& left_out) {
  const std::string where = in.where();
  if (gmf::role_of(keyword) == Role::other_cells)
    sections.refuse_other_cells(keyword,
                                gmf::has_count(keyword) ? sections.read_count(keyword) : 1);
  else if (gmf::has_count(keyword) && in.section_bytes() == 0 && in.chain_ended_without_end())
    sections.read_count(keyword);  // which is not there: this may have been End
  const std::string name(gmf::name_of(keyword));
  left_out.add(where, name.empty() ? "keyword " + std::to_string(in.code()) : name,
               " (" + std::to_string(in.section_bytes()) + " bytes)");
}

void read_section(BinaryCursor& in, SectionReader<BinaryCursor>& sections, Keyword keyword,
                  LeftOut& left_out) {
  if (keyword == Keyword::dimension) return sections.read_dimension();
  sections.wants(keyword) ? sections.read(keyword) : leave_out(in, sections, keyword, left_out);
}

void read_binary(const FileBytes& bytes, const Target& target) {
  BinaryCursor in(bytes);
  SectionReader sections(in, target);
  LeftOut left_out;
  for (;;) {
    const Keyword keyword = in.next_section();
    if (keyword == Keyword::none || keyword == Keyword::end) break;
    read_section(in, sections, keyword, left_out);
  }
  target.warn_of(left_out);
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

void read_either(const FileBytes& bytes, const Target& target) {
  BinaryCursor::recognises(bytes) ? read_binary(bytes, target) : read_text(bytes, target);
}

}  // namespace

AnyMesh read_gmf(const FileBytes& bytes, Warnings* warnings) {
  AnyMesh mesh;
  mesh.name = bytes.name;
  read_either(bytes, {&mesh, nullptr, warnings});
  flatten(mesh, warnings);
  return mesh;
}

AnyField read_field(const std::filesystem::path& path, Warnings* warnings,
                    const ReadFieldOptions& options) {
  AnyField field;
  field.name = path.string();
  try {
    read_either(read_bytes(path), {nullptr, &field, warnings, options.infinite});
  } catch (const std::bad_alloc&) {
    throw Error(path.string() +
                ": not enough memory to read the file; allow more or use a larger machine");
  }
  return field;
}

}  // namespace ductile::meshadapt
