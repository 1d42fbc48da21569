/// @file
/// NumberCursor: goes through a file that has numbers as text, as bytes, or as both in turn, as
/// those of Gmsh and VTK. Nothing is read beyond its end, whatever it holds.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

#include "file_bytes.hpp"

namespace ductile::meshadapt {

/// A word of a file for a message: never long, never a control character.
std::string quoted(std::string_view word);

/// Thread safety: one thread; several cursors may go through the same bytes.
class NumberCursor {
 public:
  /// `bytes` must outlive the cursor.
  explicit NumberCursor(const FileBytes& bytes);

  // ---- Text ----
  /// The next word, what white space ends; empty at the end of the file.
  std::string_view word();
  std::string_view peek_word();
  /// The rest of the line, without what ends it, which is taken too.
  std::string_view line();
  /// What stands in quotation marks next on this line, or the rest of it without those.
  std::string quoted_text();
  /// Goes to the byte behind the next place of `text`; false, and to the end, if there is none.
  bool skip_behind(std::string_view text);

  // ---- How numbers are written from here on ----
  void set_text() { binary_ = false; }
  void set_binary(bool swapped) {
    binary_ = true;
    swapped_ = swapped;
  }
  bool is_binary() const { return binary_; }

  // ---- Numbers: throw InputError if there is none, or one that does not fit; `what` says which
  // ----
  template <class Int>
  Int integer(const char* what) {
    if (binary_) return bytes<Int>(what);
    return static_cast<Int>(
        text_integer(what, std::numeric_limits<Int>::min(), std::numeric_limits<Int>::max()));
  }
  double real(const char* what) { return binary_ ? bytes<double>(what) : text_real(what); }
  double single_real(const char* what) {
    return binary_ ? static_cast<double>(bytes<float>(what)) : text_real(what);
  }
  /// Throws InputError unless the rest of the file can hold `count` records of so many numbers of
  /// `number_bytes` bytes each, two bytes each in text.
  void expect_room(std::uint64_t count, std::uint64_t numbers, std::uint64_t number_bytes,
                   const char* what) const;

  // ---- Places and messages ----
  const char* at() const { return at_; }
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  /// "FILE:LINE: ", or "FILE: byte N: " among binary numbers.
  std::string where() const;
  [[noreturn]] void fail(const std::string& text) const;
  [[noreturn]] void fail_end(const char* what) const;
  const std::string& name() const { return name_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void skip_space() {
    while (at_ != end_ && is_space(*at_)) ++at_;
  }
  template <class Number>
  Number bytes(const char* what);
  std::int64_t text_integer(const char* what, std::int64_t least, std::uint64_t most);
  double text_real(const char* what);

  const char* begin_;
  const char* end_;
  const char* at_;
  const char* last_;  ///< start of what was taken last
  bool binary_ = false;
  bool swapped_ = false;
  std::string name_;
};

template <class Number>
Number NumberCursor::bytes(const char* what) {
  last_ = at_;
  if (left() < sizeof(Number)) fail_end(what);
  unsigned char raw[sizeof(Number)];
  std::memcpy(raw, at_, sizeof(Number));
  at_ += sizeof(Number);
  if (swapped_) std::reverse(std::begin(raw), std::end(raw));
  Number value;
  std::memcpy(&value, raw, sizeof(Number));
  return value;
}

}  // namespace ductile::meshadapt
