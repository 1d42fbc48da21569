#include "gmf_skip.hpp"

#include <algorithm>
#include <string>

#include "gmf_keywords.hpp"

namespace ductile::meshadapt::gmf {
namespace {

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

/// True if the next word begins a section: nothing, a number or a string follows on its line.
bool section_ahead(const NumberReader& in) {
  NumberReader ahead = in;
  if (!is_section_name(ahead.word())) return false;
  const char next = ahead.first_on_line();
  return next == '\0' || is_digit(next) || std::string_view("\"+-.").find(next) < 4;
}

}  // namespace

bool is_section_name(std::string_view word) {
  return !word.empty() && is_letter(word[0]) && !is_no_number(word) &&
         std::all_of(word.begin(), word.end(),
                     [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-'; });
}

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

void skip_geometry(NumberReader& in) {
  if (in.peek_word() == "\"\"") {
    in.word();
    const Keyword next = keyword_named(in.peek_word());
    if (next == Keyword::version || next == Keyword::dimension)
      while (!in.peek_word().empty() && keyword_named(in.word()) != Keyword::end) continue;
  }
  skip_section(in);
}

}  // namespace ductile::meshadapt::gmf
