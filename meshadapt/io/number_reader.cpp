#include "number_reader.hpp"

#include <array>
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

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\n\v\f\r";
  text.remove_prefix(std::min(text.find_first_not_of(blank), text.size()));
  return text.substr(0, text.find_last_not_of(blank) + 1);
}

std::string_view from_first_word(std::string_view text, char comment) {
  NumberReader in(text, "", comment);
  in.peek_word();
  return {in.at(), in.left()};
}

NumberKind number_kind(std::string_view name) {
  struct Named {
    NumberKind kind;
    std::string_view names;
  };
  constexpr std::array<Named, 10> kinds{
      {{{8, true, true}, " Float64 float64 double "},
       {{4, true, true}, " Float32 float32 float "},
       {{8, false, true}, " Int64 vtktypeint64 vtkIdType64 long "},
       {{4, false, true}, " Int32 int32 int vtkIdType "},
       {{2, false, true}, " Int16 int16 short "},
       {{1, false, true}, " Int8 int8 char "},
       {{8, false, false}, " UInt64 vtktypeuint64 unsigned_long "},
       {{4, false, false}, " UInt32 uint32 uint unsigned_int "},
       {{2, false, false}, " UInt16 uint16 ushort unsigned_short "},
       {{1, false, false}, " UInt8 uint8 uchar unsigned_char "}}};
  for (const auto& [kind, names] : kinds)
    if (names.find(" " + std::string(name) + " ") != std::string_view::npos) return kind;
  return {};
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
  return std::string(trimmed(text));
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
  fail("expected ", what, ", from ", least, " to ", most, ", found ", value, "; correct it");
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

void NumberReader::fail_with(const std::string& text) const { throw InputError(where() + text); }

void NumberReader::fail_end(const std::string& what) const {
  fail("expected ", what,
       ", found the end of the file; the file is cut short, write or copy it again");
}

void NumberReader::fail_number(const std::string& what, const char* kind) {
  const std::string_view found = binary_ ? std::string_view() : peek_word();
  if (found.empty()) fail_end(what);
  fail("expected ", what, ", ", kind, ", found ", quoted(found), "; correct it");
}

// ---- What is left out ----

void LeftOut::add_name(std::string_view name, const std::string& note) {
  constexpr std::size_t longest_name = 40, most_names = 12;
  std::string text(name.substr(0, longest_name));
  if (name.size() > longest_name) text += "...";
  text += note;
  if (std::find(names_.begin(), names_.end(), text) != names_.end()) return;
  if (names_.size() < most_names)
    names_.push_back(text);
  else
    ++more_;
}

void LeftOut::tell(Warnings* warnings) const {
  if (names_.empty() || !warnings) return;
  std::string list;
  for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
  if (more_ > 0) list += " and " + std::to_string(more_) + " more";
  warnings->push_back(
      printable(first_ + "sections that Ductile does not use are left out: " + list));
}

}  // namespace ductile::meshadapt
