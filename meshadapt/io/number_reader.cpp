#include "number_reader.hpp"

#include <utility>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 24;
  std::string text(word.substr(0, longest));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "'" + text + (word.size() > longest ? "...'" : "'");
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

NumberReader::NumberReader(std::string_view text, std::string name, char comment)
    : begin_(text.data()),
      end_(begin_ + text.size()),
      file_end_(end_),
      at_(begin_),
      last_(begin_),
      comment_(comment),
      name_(std::move(name)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) at_ += byte_order_mark.size();
}

// ---- Words and lines ----

std::string_view NumberReader::peek_word() {
  skip_space();
  const char* after = at_;
  while (!ends_word(after)) ++after;
  return {at_, static_cast<std::size_t>(after - at_)};
}

std::string_view NumberReader::word() {
  const std::string_view result = peek_word();
  last_ = at_;
  at_ += result.size();
  return result;
}

std::string_view NumberReader::line() {
  last_ = at_;
  const char* const newline = std::find(at_, end_, '\n');
  std::string_view result(at_, static_cast<std::size_t>(newline - at_));
  at_ = newline == end_ ? end_ : newline + 1;
  if (result.ends_with('\r')) result.remove_suffix(1);
  return result;
}

void NumberReader::skip_line() { at_ = std::find_if(at_, end_, ends_line); }

char NumberReader::first_on_line() const {
  const char* const at =
      std::find_if(at_, end_, [](char c) { return ends_line(c) || !is_space(c); });
  return at == end_ || ends_line(*at) || *at == comment_ ? '\0' : *at;
}

void NumberReader::skip_quoted() {
  skip_space();
  if (at_ == end_) return;
  at_ = std::find_if(at_ + 1, end_, [](char c) { return c == '"' || ends_line(c); });
  if (at_ != end_ && *at_ == '"') ++at_;
}

std::string NumberReader::quoted_text() {
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

bool NumberReader::skip_behind(std::string_view text) {
  const char* const found = std::search(at_, end_, text.begin(), text.end());
  at_ = found == end_ ? end_ : found + text.size();
  return found != end_;
}

// ---- Numbers ----

std::int64_t NumberReader::integer_within(const char* what, std::int64_t least, std::int64_t most) {
  const auto value = integer<std::int64_t>(what);
  if (value >= least && value <= most) return value;
  fail(std::string("expected ") + what + ", from " + std::to_string(least) + " to " +
       std::to_string(most) + ", found " + std::to_string(value) + "; correct it");
}

std::string_view NumberReader::bytes(std::size_t count, const char* what) {
  last_ = at_;
  if (left() < count) fail_end(what);
  at_ += count;
  return {last_, count};
}

void NumberReader::expect_room(std::uint64_t count, const Record& record,
                               const std::string& what) const {
  // A number in text takes a digit and a space at least; the last one may end the file.
  const std::uint64_t each = binary_ ? record.bytes : 2 * record.numbers;
  const std::uint64_t possible = each == 0 ? count : (left() + (binary_ ? 0 : 1)) / each;
  if (count <= possible) return;
  fail("expected at most " + std::to_string(possible) + " " + what + " in the rest of the " +
       (end_ == file_end_ ? "file" : "section") + ", found a count of " + std::to_string(count) +
       "; correct the count, or the file is cut short");
}

// ---- Messages ----

std::string NumberReader::where() const {
  if (binary_) return name_ + ": byte " + std::to_string(last_ - begin_) + ": ";
  auto line = std::count(begin_, last_, '\n');
  if (line == 0) line = std::count(begin_, last_, '\r');  // as lines end on old machines
  return name_ + ":" + std::to_string(line + 1) + ": ";
}

void NumberReader::fail(const std::string& text) const { throw InputError(where() + text); }

void NumberReader::fail_end(const std::string& what) const {
  fail("expected " + what +
       ", found the end of the file; the file is cut short, write or copy it again");
}

void NumberReader::fail_number(const std::string& what, const char* kind) {
  const std::string_view found = binary_ ? std::string_view() : peek_word();
  if (found.empty()) fail_end(what);
  fail("expected " + what + ", " + kind + ", found " + quoted(found) + "; correct it");
}

}  // namespace ductile::meshadapt
