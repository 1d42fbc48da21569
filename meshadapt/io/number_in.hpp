/// @file
/// number_in: the number that a word is. Files and the command line share it. Any thread.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace ductile::meshadapt {

/// The number that the whole word is; nothing if it is none or, for integers, does not fit. A plus
/// sign may come first. A real number that is too small for a double is 0, one that is too large is
/// infinite; exponents may be written with D, as in Fortran.
template <class Number>
std::optional<Number> number_in(std::string_view word);

/// Decides whether a decimal number that no double holds is too small rather than too large.
inline bool is_tiny(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const auto first =
      static_cast<std::int64_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  if (exponent_at == number.size()) return first > point;
  const std::string_view exponent = number.substr(exponent_at + 1);
  const auto power = number_in<std::int64_t>(exponent);
  return power ? point - first < -*power : exponent.starts_with('-');
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const char* const end = word.data() + word.size();
  const auto [after, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc{} && after == end) return value;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range && after == end)
      return is_tiny(word) ? 0 : word.starts_with('-') ? -HUGE_VAL : HUGE_VAL;
    const std::size_t exponent = word.find_first_of("dD");
    if (exponent != std::string_view::npos && after == word.data() + exponent && word.size() < 4096)
      return number_in<Number>(std::string(word).replace(exponent, 1, "e"));
  }
  return std::nullopt;
}

}  // namespace ductile::meshadapt
