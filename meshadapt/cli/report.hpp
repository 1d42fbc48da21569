/// @file
/// Text for people and JSON for programs.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "ductile/meshadapt/statistics.hpp"

namespace ductile::cli {

// ---- Text ----

/// The text that std::printf() writes, up to 500 bytes.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// 1234567 as "1,234,567".
std::string with_commas(std::size_t number);
/// "1 vertex", "1,234 vertices".
std::string counted(std::size_t number, const char* one, const char* many);

/// The text with a '?' for each byte that is not UTF-8; names of files may have such bytes.
std::string as_utf8(const std::string& text);

inline std::string as_text(std::integral auto number) { return std::to_string(number); }
inline std::string as_text(const std::string& text) { return text; }
inline std::string as_text(const fs::path& path) { return path.string(); }

/// Lists the items, each as `text_of` words it, separated by ", ".
template <class Items, class Text = std::identity>
std::string listed(const Items& items, Text text_of = {}) {
  std::string list;
  for (const auto& item : items)
    list += (list.empty() ? "" : ", ") + as_text(std::invoke(text_of, item));
  return list;
}

/// Several lines: figures and a histogram, each line indented by two blanks.
std::string to_text(const MeshStatistics& statistics);

// ---- JSON ----

/// A value as JSON has it.
struct Json {
  Json() = default;             // null
  Json(double number);          // the shortest that reads back the same; null if it is not finite
  Json(std::string_view text);  // a string with its quotes
  Json(const std::string& string) : Json(std::string_view(string)) {}
  Json(const char* string) : Json(std::string_view(string)) {}
  Json(std::same_as<bool> auto holds) : text(holds ? "true" : "false") {}
  template <std::integral Number>
  requires(!std::same_as<Number, bool>) Json(Number number) : text(std::to_string(number)) {}
  template <class Value>
  Json(const std::optional<Value>& value) {
    if (value) *this = Json(*value);
  }

  std::string text = "null";
};

Json json_list(const std::vector<Json>& values);
Json json_object(const std::vector<Json>& keys_and_values);
/// An object of keys, each before its value.
template <class... KeysAndValues>
Json json_object(const char* key, const KeysAndValues&... others) {
  return json_object(std::vector<Json>{key, others...});
}
/// One object with the members of several, those of each on a line.
Json json_lines(const std::vector<Json>& objects);

Json to_json(const MeshStatistics& statistics);

}  // namespace ductile::cli
