/// @file
/// AsciiCursor: goes through the text of a GMF file number by number. Numbers and keywords are
/// separated by white space, '#' starts a comment. The functions in the inner loops are inline;
/// what builds a message is not. Lines are counted only for a message.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "file_bytes.hpp"
#include "gmf_place.hpp"

namespace ductile::meshadapt::gmf {

/// Thread safety: one thread; several cursors may go through the same bytes.
class AsciiCursor {
 public:
  /// `bytes` must outlive the cursor.
  explicit AsciiCursor(const FileBytes& bytes);

  // ---- Numbers ----
  /// The next number; throws InputError if there is none, or one that does not fit.
  std::int64_t integer();
  double real() { return real(false); }
  double real_or_infinite() { return real(true); }
  std::int64_t small_integer() { return integer(); }
  std::int64_t count() { return integer(); }

  // ---- Words ----
  /// The next keyword or number as it stands; empty at the end of the file.
  std::string_view word();
  /// The next word without taking it.
  std::string_view peek();
  /// The first letter of what follows on this line; 0: nothing does.
  char rest_of_line_begins_with() const;
  /// Takes the rest of the line.
  void skip_line();
  /// Takes a string in quotation marks, which ends with its line if not before.
  void skip_quoted();
  /// Whether text ends in the middle of a line, as where a file was cut.
  bool ends_within_a_line() const { return end_ != begin_ && !ends_line(end_[-1]); }

  // ---- Sections ----
  /// What is read next, for messages.
  void enter(Keyword keyword, std::uint64_t count) { section_ = {keyword, count, 0, {}}; }
  /// From here on records of the section are read. Throws InputError unless the bytes left can hold
  /// them all; ask before making room for them.
  Place enter_records(Shape shape);
  void record(std::size_t number) { record_ = number; }
  /// To be called after the last record.
  void leave() {}

  // ---- Messages ----
  [[noreturn]] void fail(const std::string& text) const { fail_at(last_, text); }
  /// About the number taken last.
  [[noreturn]] void fail_number(const std::string& expected, const std::string& found) const;
  /// About a word that should be a keyword; `similar` may be empty.
  [[noreturn]] void fail_keyword(std::string_view found, std::string_view similar) const;
  /// About one number of a section that was read before.
  [[noreturn]] void fail_in(const Place& place, std::size_t record, int field,
                            const std::string& text) const;
  std::string where() const { return where(last_); }

 private:
  void skip_space();
  void skip_plus();
  bool at_word_end(const char* at) const { return at == end_ || is_space(*at) || *at == '#'; }
  static bool ends_line(char c) { return c == '\n' || c == '\r'; }
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string where(const char* at) const;
  [[noreturn]] void fail_at(const char* at, const std::string& text) const;
  [[noreturn]] void fail_word(const char* expected);
  double real(bool infinite);
  double unusual_real(bool infinite);

  const char* begin_;
  const char* end_;
  const char* at_;
  const char* last_;  ///< start of the number or word taken last
  std::size_t record_ = 0;
  Place section_;
  std::string_view name_;
};

inline char AsciiCursor::rest_of_line_begins_with() const {
  const char* at = at_;
  while (at != end_ && !ends_line(*at) && is_space(*at)) ++at;
  return at == end_ || ends_line(*at) || *at == '#' ? '\0' : *at;
}

inline void AsciiCursor::skip_line() {
  while (at_ != end_ && !ends_line(*at_)) ++at_;
}

inline void AsciiCursor::skip_quoted() {
  skip_space();
  const char* const opened = at_;
  while (at_ != end_ && !ends_line(*at_) && (at_ == opened || *at_ != '"')) ++at_;
  if (at_ != end_ && *at_ == '"') ++at_;
}

inline void AsciiCursor::skip_space() {
  while (at_ != end_) {
    if (is_space(*at_)) {
      ++at_;
    } else if (*at_ == '#') {
      skip_line();
    } else {
      return;
    }
  }
}

/// std::from_chars knows no plus sign.
inline void AsciiCursor::skip_plus() {
  if (end_ - at_ > 1 && *at_ == '+' && at_[1] != '-') ++at_;
}

inline std::int64_t AsciiCursor::integer() {
  skip_space();
  last_ = at_;
  skip_plus();
  std::int64_t value = 0;
  const auto [after, error] = std::from_chars(at_, end_, value);
  if (error != std::errc{} || !at_word_end(after)) [[unlikely]]
    fail_word("an integer");
  at_ = after;
  return value;
}

inline double AsciiCursor::real(bool infinite) {
  skip_space();
  last_ = at_;
  skip_plus();
  double value = 0;
  const auto [after, error] = std::from_chars(at_, end_, value);
  if (error != std::errc{} || !at_word_end(after) || value - value != 0) [[unlikely]]
    return unusual_real(infinite);
  at_ = after;
  return value;
}

}  // namespace ductile::meshadapt::gmf
