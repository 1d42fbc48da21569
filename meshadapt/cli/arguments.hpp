/// @file
/// Arguments: a command line taken apart by a table of options. One or two dashes mean the same, so
/// what Mmg's users type (-hmin 0.1) and GNU's long form (--hmin=0.1) both work. Whatever is wrong
/// is told by a UsageError that says what was expected and, for an unknown option, which it may be
/// a slip of, or what to do instead if it is one of Mmg's.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/meshadapt/error.hpp"

namespace ductile::cli {

/// The command line is wrong.
class UsageError : public meshadapt::InputError {
 public:
  using meshadapt::InputError::InputError;
};

struct Option {
  std::string_view name;     ///< with its dashes, as help shows it
  std::string_view value;    ///< what follows it, e.g. FILE; empty for a flag; [N]: maybe a number
  std::string_view help;     ///< one line; empty: not shown
  std::string_view alias{};  ///< another name, with its dashes
};

class Arguments {
 public:
  /// Throws UsageError. `words` are what follows the command's name.
  Arguments(std::span<const Option> options, std::span<const std::string> words);

  /// What is no option, in order.
  const std::vector<std::string>& operands() const { return operands_; }

  /// The last value given to the option of this name (as in the table).
  bool has(std::string_view name) const;
  std::optional<std::string> text(std::string_view name) const;
  /// All that were given to it, in order.
  std::vector<std::string> texts(std::string_view name) const;
  /// Throw UsageError unless the value is such a number, inside the range.
  std::optional<double> positive(std::string_view name) const;
  std::optional<double> number(std::string_view name) const;
  /// A length that a metric may ask for.
  std::optional<double> size(std::string_view name) const;
  std::optional<int> integer(std::string_view name, int least, int most) const;

 private:
  void take(std::span<const Option> options, std::span<const std::string> words, std::size_t& at);

  std::vector<std::string> operands_;
  std::map<std::string, std::vector<std::string>, std::less<>> values_of_;  // [as in the table]
};

/// Least number of letters to insert, remove, replace or exchange with the next to turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace ductile::cli
