#include <algorithm>
#include <new>
#include <optional>

#include "formats.hpp"
#include "gmf_reader.hpp"
#include "mesh/flatten.hpp"

namespace ductile::meshadapt::gmf {
namespace {

constexpr const char* damaged = "; the file is cut short or damaged, write or copy it again";

/// The wrong dimension shows as a wrong count of vertices.
std::string dimension_hint(Keyword keyword) {
  return keyword == Keyword::vertices ? " or the Dimension" : "";
}

// ---- Sections that are not read, whatever is in them: numbers, quoted strings, lines of words
// ----

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_number(std::string_view word) {
  return std::any_of(word.begin(), word.end(), is_digit) &&
         word.find_first_not_of("+-.0123456789eEdD") == std::string_view::npos;
}

/// True for words that are written for infinite and undefined numbers.
bool is_no_number(std::string_view word) {
  std::string lower(word.substr(0, 9));
  for (char& c : lower) c = static_cast<char>(c | 0x20);
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

/// True if a word may name a section of another program: letters, digits, '_' and '-' after a
/// letter.
bool is_section_name(std::string_view word) {
  return !word.empty() && is_letter(word[0]) && !is_no_number(word) &&
         std::all_of(word.begin(), word.end(),
                     [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-'; });
}

/// True if the next word begins a section: nothing, a number or a string follows on its line.
bool section_ahead(const NumberReader& in) {
  NumberReader ahead = in;
  if (!is_section_name(ahead.word())) return false;
  const char next = ahead.first_on_line();
  return next == '\0' || is_digit(next) || std::string_view("\"+-.").find(next) < 4;
}

/// Goes past this many lines of a section of text, which may have any words in them; a keyword
/// alone, or before a number, is the next section.
void skip_lines(NumberReader& in, std::uint64_t count) {
  for (; count > 0 && !in.peek_word().empty(); --count) {
    if (keyword_named(in.peek_word()) != Keyword::none) {
      NumberReader ahead = in;
      ahead.word();
      const char next = ahead.first_on_line();
      if (next == '\0' || is_digit(next)) return;
    }
    in.skip_line();
  }
}

/// Goes on to the next section, or to the end of the file.
void skip_section(NumberReader& in) {
  for (;;) {
    const std::string_view next = in.peek_word();
    if (next.empty() || section_ahead(in)) return;
    if (next.starts_with('"'))
      in.skip_quoted();
    else if (is_number(next))
      in.word();
    else
      in.skip_line();
  }
}

/// Does the same behind the word Geometry, which a name in quotation marks follows. If that is
/// empty, bamg writes the geometry here, up to its keyword End.
void skip_geometry(NumberReader& in) {
  if (in.peek_word() == "\"\"") {
    in.word();
    const Keyword next = keyword_named(in.peek_word());
    if (next == Keyword::version || next == Keyword::dimension)
      while (!in.peek_word().empty() && keyword_named(in.word()) != Keyword::end) continue;
  }
  skip_section(in);
}

}  // namespace

void GmfReader::read() {
  in_.is_binary() ? read_binary() : read_text();
  finish();
}

// ---- Text ----

void GmfReader::read_text_version() {
  const std::string_view first = in_.word();
  if (first == "View")
    fail(
        "expected a mesh, found a view of Gmsh's (.pos), which has values but no mesh; give "
        "a .msh with the field in it, as Gmsh, meshio and ductile write it");
  if (keyword_named(first) != Keyword::version)
    fail(
        "expected MeshVersionFormatted, the beginning of a Medit file, found something else; "
        "give a .mesh, .meshb, .msh, .vtu, .vtk, .sol or .solb file");
  section_.keyword = Keyword::version;
  const std::int64_t version = integer(true);
  if (version < 0 || version > 4)  // bamg and FreeFEM write 0
    fail("expected version 1 to 4, found ", version, "; write the file in one of them");
}

/// Goes past a section that is not read; refuses cells that a mesh here cannot have.
void GmfReader::leave_out_text(std::string_view name) {
  const Keyword keyword = keyword_named(name);
  std::optional<std::uint64_t> count;
  if (keyword != Keyword::none && has_count(keyword))
    count = number_in<std::uint64_t>(in_.peek_word());
  if (role_of(keyword) == Role::other_cells) refuse_other_cells(keyword, count.value_or(1));
  left_out_.add(*this, name, count ? " (" + std::to_string(*count) + ")" : "");
  if (count && has_text(keyword)) {
    in_.word();
    skip_lines(in_, *count);
  }
  name == "Geometry" ? skip_geometry(in_) : skip_section(in_);
}

void GmfReader::read_text_section(std::string_view name) {
  const Keyword keyword = keyword_named(name);
  if (keyword == Keyword::none) {
    const std::string_view similar = similar_name(name);
    if (!similar.empty() || !is_section_name(name)) fail_keyword(name, similar);
  }
  if (keyword == Keyword::version)
    fail("expected one MeshVersionFormatted, found a second; remove one");
  if (keyword == Keyword::dimension) return read_dimension();
  wants(keyword) ? read_section(keyword) : leave_out_text(name);
}

void GmfReader::read_text() {
  read_text_version();
  for (;;) {
    const std::string_view word = in_.word();
    if (word.empty()) {
      if (in_.ends_within_a_line())
        fail(
            "expected the keyword End or the end of a line, found the end of the file; the "
            "file is cut short, write or copy it again");
      warn(where() +
           "expected the keyword End, found the end of the file; it is "
           "complete only if nothing was cut off");
      break;
    }
    if (keyword_named(word) == Keyword::end) {
      if (!in_.word().empty())
        fail("expected nothing after the keyword End, found more; remove it");
      break;
    }
    read_text_section(word);
  }
  left_out_.tell(target_.warnings);
}

void GmfReader::fail_keyword(std::string_view found, std::string_view similar) const {
  const bool is_number = found.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
  fail("expected a keyword after ", name_of(section_.keyword), ", found ", quoted(found),
       is_number ? "; the section has more lines than its count says, correct that" +
                       dimension_hint(section_.keyword)
       : similar.empty() ? "; correct it, or remove the section"
                         : "; did you mean " + std::string(similar) + "?");
}

// ---- Binary ----

bool GmfReader::begins_as_binary(const FileBytes& bytes) {
  return bytes.size >= 4 && (loaded<std::int32_t>(bytes.begin(), false) == 1 ||
                             loaded<std::int32_t>(bytes.begin(), true) == 1);
}

void GmfReader::read_binary_version() {
  in_.set_binary(in_.integer<std::int32_t>("the number 1") != 1);
  section_.keyword = Keyword::version;
  const std::int64_t version = small_integer();
  if (version < 1 || version > 4)
    fail("expected version 1 to 4, found ", version, "; write the file in one of them");
  sizes_.version = static_cast<int>(version);
}

Keyword GmfReader::next_section() {
  section_ = {};
  in_.set_end(size_);
  if (ended_ || next_ == 0) return Keyword::none;
  in_.go_to(next_);
  code_ = in_.integer<std::int32_t>("a keyword");
  if (code_ < 1 || code_ > 1000) fail("expected the number of a keyword, found ", code_, damaged);
  section_.keyword = static_cast<Keyword>(code_);
  ended_ = section_.keyword == Keyword::end;
  if (ended_) return Keyword::end;
  const std::int64_t next = sizes_.position() == 8
                                ? in_.integer<std::int64_t>("the position of the next section")
                                : in_.integer<std::int32_t>("the position of the next section");
  const std::size_t least = in_.position();
  if (next != 0 &&
      (next < static_cast<std::int64_t>(least) || static_cast<std::uint64_t>(next) >= size_))
    fail("expected the position of the next section, from byte ", least, " to ", size_ - 1,
         ", found ", next, damaged);
  next_ = static_cast<std::size_t>(next);
  in_.set_end(next_ == 0 ? size_ : next_);
  return section_.keyword;
}

/// The next section is found by its position, whatever is in this one.
void GmfReader::leave_out_binary(Keyword keyword) {
  const bool ends_the_chain = next_ == 0 && in_.left() == 0;
  if (role_of(keyword) == Role::other_cells)
    refuse_other_cells(keyword, has_count(keyword) ? read_count(keyword) : 1);
  else if (has_count(keyword) && ends_the_chain)
    read_count(keyword);  // it is not there: this may have been End
  const std::string name(name_of(keyword));
  left_out_.add(*this, name.empty() ? "keyword " + std::to_string(code_) : name,
                " (" + std::to_string(in_.left()) + " bytes)");
}

void GmfReader::expect_nothing_after_end() {
  // A position may follow End; Mmg leaves it out in solutions.
  const std::size_t left = ended_ ? in_.left() : 0;
  if (left == 0 || left == sizes_.position()) return;
  in_.go_to(in_.position());
  fail("expected nothing after the keyword End, found ", left,
       " bytes; remove them or write the file again");
}

void GmfReader::expect_section_end() {
  if (!in_.is_binary() || in_.left() == 0) return;
  const std::size_t end = in_.position() + in_.left();
  in_.go_to(in_.position());
  fail("expected the section to end here, as its count says, found its end at byte ", end, damaged);
}

void GmfReader::read_binary() {
  read_binary_version();
  for (;;) {
    const Keyword keyword = next_section();
    if (keyword == Keyword::none || keyword == Keyword::end) break;
    if (keyword == Keyword::dimension)
      read_dimension();
    else
      wants(keyword) ? read_section(keyword) : leave_out_binary(keyword);
  }
  left_out_.tell(target_.warnings);
  if (!ended_)
    warn(where() +
         "the file ends without the keyword End; it is complete only if nothing was cut off");
  expect_nothing_after_end();
}

// ---- Messages ----

std::string GmfReader::where() const {
  std::string text = in_.where();
  if (!in_.is_binary() || section_.keyword == Keyword::none) return text;
  const std::string name(name_of(section_.keyword));
  return text.replace(text.size() - 2, 2,
                      ", " + (name.empty() ? "keyword " + std::to_string(code_) : name) + ": ");
}

void GmfReader::fail_number(const std::string& expected, const std::string& found) const {
  fail("expected ", expected, " in ", record_name(section_, record_), ", found ", found,
       in_.is_binary() ? damaged : "; correct it");
}

void GmfReader::fail_word(const std::string& expected) {
  const std::string name(name_of(section_.keyword));
  const std::string what =
      expected +
      (section_.numbers() == 0 ? " after " + name : " in " + record_name(section_, record_));
  if (in_.is_binary())
    fail("expected " + what + ", found the end of " + (next_ == 0 ? "the file" : "the section") +
         damaged);
  in_.take_back();
  const std::string_view found = in_.peek_word();
  if (found.empty()) in_.fail_end(what);
  if (keyword_named(found) != Keyword::none && section_.numbers() != 0)
    fail("expected ", what, ", found the keyword ", found, "; correct the count of ", name,
         dimension_hint(section_.keyword));
  fail("expected ", what, ", found ", quoted(found), "; correct it");
}

}  // namespace ductile::meshadapt::gmf

namespace ductile::meshadapt {

MeshWithFields read_gmf(const FileBytes& bytes, Warnings* warnings) {
  MeshWithFields file;
  file.mesh.name = bytes.name;
  const gmf::Target target{&file.mesh, nullptr, warnings};
  gmf::GmfReader(bytes, target).read();
  flatten(file.mesh, warnings);
  return file;
}

AnyField read_field(const std::filesystem::path& path, Warnings* warnings,
                    const ReadFieldOptions& options) {
  AnyField field;
  field.name = path.string();
  try {
    const gmf::Target target{nullptr, &field, warnings, options.infinite};
    gmf::GmfReader(read_bytes(path), target).read();
  } catch (const std::bad_alloc&) {
    throw Error(path.string() +
                ": not enough memory to read the file; allow more or use a larger machine");
  }
  return field;
}

}  // namespace ductile::meshadapt
