/// @file
/// NumberReader: goes through a file word by word and number by number. Numbers are text, or bytes
/// in either byte order; files of Gmsh and VTK mix both. Nothing is read beyond the end. The
/// functions in inner loops are inline; lines are counted for messages only.
#pragma once

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "file_bytes.hpp"
#include "number_in.hpp"

namespace ductile::meshadapt {

/// A word of a file for a message: never long, without control characters.
std::string quoted(std::string_view word);
std::string lower(std::string_view text);
/// The text without white space at its ends.
std::string_view trimmed(std::string_view text);
/// The text from its first word on, behind white space and comments.
std::string_view from_first_word(std::string_view text, char comment);

/// A kind of number, as files name them; 0 bytes if there is none of that name.
struct NumberKind {
  std::size_t bytes = 0;
  bool is_real = false, is_signed = false;
};
/// By its name in VTK's XML, "Float64", in VTK's legacy files, where vtkIdType has 4 bytes, or in
/// PLY, "double".
NumberKind number_kind(std::string_view name);

/// Returns visit(Number{}) with a number of this kind.
auto visit_number(NumberKind kind, auto&& visit) {
  if (kind.is_real) return kind.bytes == 8 ? visit(double{}) : visit(float{});
  switch (kind.bytes) {
    case 8:
      return kind.is_signed ? visit(std::int64_t{}) : visit(std::uint64_t{});
    case 4:
      return kind.is_signed ? visit(std::int32_t{}) : visit(std::uint32_t{});
    case 2:
      return kind.is_signed ? visit(std::int16_t{}) : visit(std::uint16_t{});
    default:
      return kind.is_signed ? visit(std::int8_t{}) : visit(std::uint8_t{});
  }
}

/// The number that these bytes hold; with `swapped`, in the byte order of other machines.
template <class Number>
Number loaded(const char* bytes, bool swapped) {
  unsigned char raw[sizeof(Number)];
  std::memcpy(raw, bytes, sizeof(Number));
  if (swapped) std::reverse(std::begin(raw), std::end(raw));
  Number value;
  std::memcpy(&value, raw, sizeof(Number));
  return value;
}

inline void append_text(std::string& text, std::string_view part) { text += part; }
inline void append_text(std::string& text, std::integral auto number) {
  text += std::to_string(number);
}

/// One text of parts: texts and whole numbers.
template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::string text;
  (append_text(text, parts), ...);
  return text;
}

/// Thread safety: one thread; several readers may go through the same bytes.
class NumberReader {
 public:
  static constexpr char no_comments = '\n';

  /// `bytes` must outlive the reader. `comment` begins a comment, which ends with its line.
  explicit NumberReader(const FileBytes& bytes, char comment = no_comments)
      : NumberReader({bytes.begin(), bytes.size}, bytes.name, comment) {}
  NumberReader(std::string_view text, std::string name, char comment = no_comments);

  // ---- Words and lines ----
  /// The next word, which ends at white space or a comment; empty at the end of the file.
  std::string_view word();
  /// The next word without taking it.
  std::string_view peek_word();
  /// Takes the rest of the line and its end, and returns it without that.
  std::string_view line();
  /// Takes the rest of the line, but not its end.
  void skip_line();
  /// The first character of the rest of the line; 0 if nothing or a comment follows.
  char first_on_line() const;
  /// Takes a string in quotation marks, which ends with its line at the latest.
  void skip_quoted();
  /// The text in quotation marks next on this line, which is taken; or all of the line.
  std::string quoted_text();
  /// Goes behind the next place of `text`, or to the end, and returns false, if there is none.
  bool skip_behind(std::string_view text);

  // ---- Numbers, as text or, after set_binary(), as bytes ----
  void set_text() { binary_ = false; }
  void set_binary(bool swapped) {
    binary_ = true;
    swapped_ = swapped;
  }
  bool is_binary() const { return binary_; }

  /// Takes the next number; returns false, and takes nothing, unless there is one that fits.
  template <class Number>
  bool take(Number& value);
  /// Takes a number that must be there; throws InputError otherwise. `what` names it in the error.
  template <class Int>
  Int integer(const char* what) {
    Int value{};
    if (!take(value)) [[unlikely]]
      fail_number(what, "a whole number");
    return value;
  }
  /// Takes an integer within a range, like integer().
  std::int64_t integer_within(const char* what, std::int64_t least, std::int64_t most);
  double real(const char* what) {
    double value = 0;
    if (!take(value)) [[unlikely]]
      fail_number(what, "a number");
    return value;
  }
  /// Returns a coordinate that was taken; throws InputError unless it is finite.
  double finite(double x) const {
    if (!std::isfinite(x)) fail("expected a finite coordinate, found another; correct it");
    return x;
  }
  /// The next `count` bytes as they are.
  std::string_view bytes(std::size_t count, const char* what);

  struct Record {
    std::uint64_t numbers;
    std::uint64_t bytes;  ///< if they are binary
  };
  /// Throws InputError unless the rest of the file can hold so many records; ask before making room
  /// for them.
  void expect_room(std::uint64_t count, const Record& record, const std::string& what) const;

  // ---- Places ----
  const char* at() const { return at_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }
  /// Goes back to what was taken last.
  void take_back() { at_ = last_; }
  /// Goes to a byte of the file, of which messages speak then.
  void go_to(std::size_t position) { at_ = last_ = begin_ + position; }
  /// Ends reading at this byte, for example where a section ends.
  void set_end(std::size_t position) { end_ = begin_ + position; }
  bool ends_within_a_line() const { return end_ != begin_ && !ends_line(end_[-1]); }

  // ---- Messages, about what was taken last ----
  /// "FILE:LINE: ", or "FILE: byte N: " among binary numbers.
  std::string where() const;
  template <class... Parts>
  [[noreturn, gnu::noinline]] void fail(const Parts&... parts) const {
    fail_with(text_of(parts...));
  }
  /// The end of the file was found where `what` was expected.
  [[noreturn]] void fail_end(const std::string& what) const;
  const std::string& name() const { return name_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  static bool ends_line(char c) { return c == '\n' || c == '\r'; }
  bool ends_word(const char* at) const { return at == end_ || is_space(*at) || *at == comment_; }
  void skip_space() {
    while (at_ != end_)
      if (is_space(*at_))
        ++at_;
      else if (*at_ == comment_)
        skip_line();
      else
        return;
  }
  /// Takes a number that is written in another way, such as 1D-3; not inline, so that take() is.
  template <class Number>
  [[gnu::noinline]] bool take_unusual(Number& value);
  [[noreturn]] void fail_with(const std::string& text) const;
  [[noreturn]] void fail_number(const std::string& what, const char* kind);

  const char* begin_;
  const char* end_;
  const char* file_end_;
  const char* at_;
  const char* last_;  ///< start of what was taken last
  char comment_;
  bool binary_ = false;
  bool swapped_ = false;
  std::string name_;
};

template <class Number>
[[gnu::flatten]] bool NumberReader::take(Number& value) {
  if (binary_) {
    last_ = at_;
    if (left() < sizeof(Number)) return false;
    value = loaded<Number>(at_, swapped_);
    at_ += sizeof(Number);
    return true;
  }
  skip_space();
  last_ = at_;
  const auto [after, error] = std::from_chars(at_, end_, value);
  if (error == std::errc{} && ends_word(after)) [[likely]] {
    at_ = after;
    return true;
  }
  return take_unusual(value);
}

template <class Number>
bool NumberReader::take_unusual(Number& value) {
  const std::string_view found = peek_word();
  const auto unusual = number_in<Number>(found);
  if (!unusual) return false;
  value = *unusual;
  at_ += found.size();
  return true;
}

/// Collects the sections of a file that are not read, for one warning about all of them. Thread
/// safety: one thread.
class LeftOut {
 public:
  /// Adds the section that a reader is at; `note` may say how large it is.
  void add(const auto& reader, std::string_view name, const std::string& note = "") {
    if (names_.empty()) first_ = reader.where();  // which counts lines
    add_name(name, note);
  }
  /// Adds the warning "FILE:LINE: sections that Ductile does not use are left out: ...", if there
  /// were any. `warnings` may be null.
  void tell(Warnings* warnings) const;

 private:
  void add_name(std::string_view name, const std::string& note);

  std::string first_;               ///< the place of the first
  std::vector<std::string> names_;  ///< the first few, each once
  std::size_t more_ = 0;            ///< others
};

}  // namespace ductile::meshadapt
