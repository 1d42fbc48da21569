#include "number_cursor.hpp"

#include <cmath>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 24;
  std::string text(word.substr(0, longest));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "'" + text + (word.size() > longest ? "...'" : "'");
}

NumberCursor::NumberCursor(const FileBytes& bytes)
    : begin_(bytes.begin()), end_(bytes.end()), at_(begin_), last_(begin_), name_(bytes.name) {}

std::string_view NumberCursor::peek_word() {
  skip_space();
  const char* after = at_;
  while (after != end_ && !is_space(*after)) ++after;
  return {at_, static_cast<std::size_t>(after - at_)};
}

std::string_view NumberCursor::word() {
  const std::string_view result = peek_word();
  last_ = at_;
  at_ += result.size();
  return result;
}

std::string_view NumberCursor::line() {
  last_ = at_;
  const char* const newline = std::find(at_, end_, '\n');
  std::string_view result(at_, static_cast<std::size_t>(newline - at_));
  at_ = newline == end_ ? end_ : newline + 1;
  if (result.ends_with('\r')) result.remove_suffix(1);
  return result;
}

std::string NumberCursor::quoted_text() {
  std::string_view text = line();
  const std::size_t open = text.find('"');
  if (open != std::string_view::npos) {
    text.remove_prefix(open + 1);
    return std::string(text.substr(0, text.find('"')));
  }
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return std::string(text);
}

bool NumberCursor::skip_behind(std::string_view text) {
  const char* const found = std::search(at_, end_, text.begin(), text.end());
  at_ = found == end_ ? end_ : found + text.size();
  return found != end_;
}

void NumberCursor::expect_room(std::uint64_t count, std::uint64_t numbers,
                               std::uint64_t number_bytes, const char* what) const {
  // A number in text takes a digit and a space at least; the last one may end the file.
  const std::uint64_t each = numbers * (binary_ ? number_bytes : 2);
  const std::uint64_t possible = each == 0 ? count : (left() + (binary_ ? 0 : 1)) / each;
  if (count <= possible) return;
  fail("expected at most " + std::to_string(possible) + " " + what +
       " in the rest of the file, found a count of " + std::to_string(count) +
       "; correct the count, or the file is cut short");
}

std::int64_t NumberCursor::text_integer(const char* what, std::int64_t least, std::uint64_t most) {
  std::string_view found = word();
  if (found.empty()) fail_end(what);
  std::string_view digits = found;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [after, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || after != digits.data() + digits.size() || value < least ||
      (value > 0 && static_cast<std::uint64_t>(value) > most))
    fail(std::string("expected ") + what + ", a whole number, found " + quoted(found) +
         "; correct it");
  return value;
}

double NumberCursor::text_real(const char* what) {
  const std::string_view found = word();
  if (found.empty()) fail_end(what);
  std::string_view digits = found;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [after, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number =
      error != std::errc::invalid_argument && after == digits.data() + digits.size();
  if (is_number && error == std::errc::result_out_of_range) {
    // from_chars does not say whether it is too small, which is 0, or too large.
    const std::size_t exponent = digits.find_first_of("eE");
    if (exponent != std::string_view::npos && digits.substr(exponent + 1).starts_with('-'))
      return 0;
    return digits.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
  }
  if (!is_number)
    fail(std::string("expected ") + what + ", a number, found " + quoted(found) + "; correct it");
  return value;
}

std::string NumberCursor::where() const {
  if (binary_) return name_ + ": byte " + std::to_string(last_ - begin_) + ": ";
  std::size_t line = 1;
  for (const char* c = begin_; c != last_; ++c) line += *c == '\n' ? 1U : 0U;
  return name_ + ":" + std::to_string(line) + ": ";
}

void NumberCursor::fail(const std::string& text) const { throw InputError(where() + text); }

void NumberCursor::fail_end(const char* what) const {
  fail(std::string("expected ") + what +
       ", found the end of the file; the file is cut short, write or copy it again");
}

}  // namespace ductile::meshadapt
