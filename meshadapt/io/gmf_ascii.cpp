#include "gmf_ascii.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt::gmf {
namespace {

constexpr std::size_t longest_quote = 24;

/// A word of the file for a message: never long, never a control character.
std::string quoted(std::string_view word) {
  std::string text(word.substr(0, longest_quote));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "'" + text + (word.size() > longest_quote ? "...'" : "'");
}

/// Whether a decimal number that no double can hold is too small rather than too large.
bool is_tiny(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const auto first =
      static_cast<std::int64_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  if (exponent_at == number.size()) return first > point;
  std::string_view exponent = number.substr(exponent_at + 1);
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t power = 0;
  const auto [after, error] =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  if (error != std::errc{}) return exponent.starts_with('-');
  return point - first < -power;
}

/// The wrong dimension shows as a wrong count of vertices.
std::string dimension_hint(Keyword keyword) {
  return keyword == Keyword::vertices ? " or the Dimension" : "";
}

}  // namespace

AsciiCursor::AsciiCursor(const FileBytes& bytes)
    : begin_(bytes.begin()), end_(bytes.end()), at_(begin_), last_(begin_), name_(bytes.name) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (std::string_view(begin_, bytes.size).starts_with(byte_order_mark))
    at_ += byte_order_mark.size();
}

std::string_view AsciiCursor::peek() {
  skip_space();
  const char* after = at_;
  while (!at_word_end(after)) ++after;
  return {at_, static_cast<std::size_t>(after - at_)};
}

std::string_view AsciiCursor::word() {
  const std::string_view result = peek();
  last_ = at_;
  at_ += result.size();
  return result;
}

/// Exponents written with D by Fortran, numbers too small for a double (0 then) and, if they may
/// be, infinite or too large for one; else an error.
double AsciiCursor::unusual_real(bool infinite) {
  at_ = last_;
  const std::string_view found = peek();
  std::string_view digits = found;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  std::string number(digits.substr(0, 4096));
  std::replace_if(
      number.begin(), number.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  double value = 0;
  const char* const number_end = number.data() + number.size();
  const auto [after, error] = std::from_chars(number.data(), number_end, value);
  const bool is_number =
      error != std::errc::invalid_argument && after == number_end && number.size() == digits.size();
  if (is_number && error == std::errc::result_out_of_range && is_tiny(number))
    value = 0;
  else if (is_number && error == std::errc::result_out_of_range && infinite)
    value = number.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
  else if (is_number && error == std::errc::result_out_of_range)
    fail("expected a number below 1.8e308 in " + record_name(section_, record_) + ", found " +
         quoted(found) + "; correct it");
  else if (!is_number || std::isnan(value) || (!infinite && std::isinf(value)))
    fail_word(infinite ? "a number" : "a finite number");
  at_ = last_ + found.size();
  return value;
}

void AsciiCursor::fail_word(const char* expected) {
  at_ = last_;
  const std::string_view found = peek();
  const std::string name(name_of(section_.keyword));
  const std::string what = section_.shape.numbers() == 0
                               ? std::string(expected) + " after " + name
                               : std::string(expected) + " in " + record_name(section_, record_);
  if (found.empty())
    fail_at(end_, "expected " + what +
                      ", found the end of the file; the file is cut short, write or copy it again");
  if (keyword_named(found) != Keyword::none && section_.shape.numbers() != 0)
    fail("expected " + what + ", found the keyword " + std::string(found) +
         "; correct the count of " + name + dimension_hint(section_.keyword));
  fail("expected " + what + ", found " + quoted(found) + "; correct it");
}

Place AsciiCursor::enter_records(Shape shape) {
  // A number takes a digit and a space at least; the last one may end the file.
  const auto left = static_cast<std::uint64_t>(end_ - at_) + 1;
  const std::uint64_t possible = left / (2 * shape.numbers());
  if (section_.count > possible)
    fail("expected at most " + std::to_string(possible) + " " +
         std::string(name_of(section_.keyword)) + " in the rest of the file, found a count of " +
         std::to_string(section_.count) + "; correct the count, or the file is cut short");
  section_.shape = shape;
  section_.begin = static_cast<std::size_t>(at_ - begin_);
  return section_;
}

std::string AsciiCursor::where(const char* at) const {
  std::size_t line = 1;
  for (const char* c = begin_; c != at; ++c)
    line += static_cast<std::size_t>(*c == '\n' || (*c == '\r' && (c + 1 == at || c[1] != '\n')));
  return std::string(name_) + ":" + std::to_string(line) + ": ";
}

void AsciiCursor::fail_at(const char* at, const std::string& text) const {
  throw InputError(where(at) + text);
}

void AsciiCursor::fail_number(const std::string& expected, const std::string& found) const {
  fail("expected " + expected + " in " + record_name(section_, record_) + ", found " + found +
       "; correct it");
}

void AsciiCursor::fail_keyword(std::string_view found, std::string_view similar) const {
  const std::string name(name_of(section_.keyword));
  const bool is_number = found.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
  fail("expected a keyword after " + name + ", found " + quoted(found) +
       (is_number ? "; the section has more lines than its count says, correct that" +
                        dimension_hint(section_.keyword)
        : similar.empty() ? "; correct it, or remove the section"
                          : "; did you mean " + std::string(similar) + "?"));
}

void AsciiCursor::fail_in(const Place& place, std::size_t record, int field,
                          const std::string& text) const {
  AsciiCursor walk = *this;
  walk.at_ = begin_ + place.begin;
  const std::uint64_t before = record * place.shape.numbers() + static_cast<std::uint64_t>(field);
  for (std::uint64_t number = 0; number < before; ++number) walk.word();
  walk.skip_space();
  fail_at(walk.at_, text);
}

}  // namespace ductile::meshadapt::gmf
