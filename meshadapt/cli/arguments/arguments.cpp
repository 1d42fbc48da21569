#include "arguments.hpp"

#include <algorithm>
#include <cmath>

#include "io/number_in.hpp"

namespace ductile::cli {

namespace {

/// True if a word asks for an option; "-" and "-.vtu" are files, "-1" is a number.
bool looks_like_option(std::string_view word) {
  if (word.size() < 2 || word[0] != '-' || word[1] == '.') return false;
  const bool begins_as_number = word[1] >= '0' && word[1] <= '9';
  return !begins_as_number || !number_in<double>(word);
}

const Option* find(std::span<const Option> options, std::string_view word) {
  for (const Option& option : options)
    for (const std::string_view name : {option.name, option.alias})
      if (!name.empty() && without_dashes(word) == without_dashes(name)) return &option;
  return nullptr;
}

/// The option whose name is closest to a word that may be a typing error: at most one letter in
/// three differs, and at most two.
std::string_view nearest_name(std::span<const Option> options, std::string_view word) {
  std::string_view nearest;
  std::size_t least = 3;
  for (const Option& option : options) {
    if (option.help.empty()) continue;
    for (const std::string_view name : {option.name, option.alias}) {
      const std::string_view typed = without_dashes(word), known = without_dashes(name);
      const bool mixed = std::ranges::is_permutation(typed, known);  // "hzis" for "hsiz"
      const std::size_t distance = mixed ? 1 : edit_distance(typed, known);
      if (distance >= least || distance > known.size() / 3) continue;
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

[[noreturn]] void refuse_unknown(std::span<const Option> options, std::string_view word) {
  const std::string_view nearest = nearest_name(options, word);
  throw UnknownOption(word, nearest.empty() ? "" : "did you mean " + std::string(nearest) + "?");
}

}  // namespace

UnknownOption::UnknownOption(std::string_view option, std::string_view hint)
    : UsageError("unknown option " + std::string(option) + (hint.empty() ? "" : "; ") +
                 std::string(hint)),
      name(option) {}

void refuse_value(std::string_view name, const std::string& expected, const std::string& found) {
  throw UsageError("option " + std::string(name) + ": expected " + expected + ", found '" + found +
                   "'");
}

std::string_view without_dashes(std::string_view word) {
  word.remove_prefix(std::min(word.find_first_not_of('-'), word.size()));
  return word;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

Arguments::Arguments(std::span<const Option> options, std::span<const std::string> words) {
  for (std::size_t at = 0; at < words.size(); ++at) {
    if (words[at] == "--") {
      operands_.insert(operands_.end(), words.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                       words.end());
      return;
    }
    if (looks_like_option(words[at]))
      take(options, words, at);
    else
      operands_.push_back(words[at]);
  }
}

void Arguments::take(std::span<const Option> options, std::span<const std::string> words,
                     std::size_t& at) {
  const std::string& word = words[at];
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  const Option* option = find(options, name);
  if (!option) refuse_unknown(options, name);
  std::string value;
  if (option->value.empty()) {
    if (equals != std::string::npos) throw UsageError("option " + name + " takes no value");
  } else if (equals != std::string::npos) {
    value = word.substr(equals + 1);
  } else if (option->value.starts_with('[')) {
    if (at + 1 < words.size() && number_in<double>(words[at + 1])) value = words[++at];
    values_of_[std::string(option->name)].push_back(value);
    return;
  } else if (at + 1 < words.size() &&
             !(looks_like_option(words[at + 1]) && find(options, words[at + 1]))) {
    value = words[++at];
  }
  if (!option->value.empty() && value.empty())
    throw UsageError("option " + name + ": expected " + std::string(option->value) +
                     " after it, found nothing");
  values_of_[std::string(option->name)].push_back(value);
}

bool Arguments::has(std::string_view name) const { return values_of_.contains(name); }

std::optional<std::string> Arguments::text(std::string_view name) const {
  const auto found = values_of_.find(name);
  if (found == values_of_.end()) return std::nullopt;
  return found->second.back();
}

std::vector<std::string> Arguments::texts(std::string_view name) const {
  const auto found = values_of_.find(name);
  return found == values_of_.end() ? std::vector<std::string>{} : found->second;
}

std::optional<double> Arguments::number(std::string_view name, const char* expected) const {
  const std::optional<std::string> value = text(name);
  if (!value) return std::nullopt;
  const std::optional<double> parsed = number_in<double>(*value);
  if (!parsed || !std::isfinite(*parsed)) refuse_value(name, expected, *value);
  return parsed;
}

std::optional<double> Arguments::positive(std::string_view name) const {
  constexpr const char* expected = "a number above 0";
  const std::optional<double> parsed = number(name, expected);
  if (parsed && *parsed <= 0) refuse_value(name, expected, *text(name));
  return parsed;
}

std::optional<int> Arguments::integer(std::string_view name, int least, int most) const {
  const std::optional<std::string> value = text(name);
  if (!value) return std::nullopt;
  return whole_number(name, *value, least, most);
}

int whole_number(std::string_view name, const std::string& value, int least, int most) {
  const std::optional<int> parsed = number_in<int>(value);
  if (!parsed || *parsed < least || *parsed > most)
    refuse_value(name,
                 "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
                 value);
  return *parsed;
}

std::string help_lines(std::span<const Option> options) {
  constexpr std::size_t width = 22;
  std::string text;
  for (const Option& option : options) {
    if (option.help.empty()) continue;
    if (option.name.empty()) {
      text.append("\n").append(option.help).append(":\n");
      continue;
    }
    std::string left(option.name);
    if (!option.alias.empty()) left.append(", ").append(option.alias);
    if (!option.value.empty()) left.append(" ").append(option.value);
    left.resize(std::max(width, left.size()), ' ');
    text.append("  ").append(left).append(" ").append(option.help).append("\n");
  }
  return text;
}

}  // namespace ductile::cli
