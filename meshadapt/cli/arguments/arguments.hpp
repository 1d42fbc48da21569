/// @file
/// Arguments: a command line taken apart by a table of options. One or two dashes mean the same, so
/// that Mmg's form (-hmin 0.1) and GNU's (--hmin=0.1) both work. A UsageError tells what was
/// expected and, for an unknown option, which one is close to it. The program, the benchmarks and
/// the campaign share it; it needs no library.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ductile::meshadapt {}

namespace ductile::cli {

using namespace meshadapt;  // the program is about what the library does
namespace fs = std::filesystem;

/// The command line is wrong.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// There is no such option.
struct UnknownOption : UsageError {
  UnknownOption(std::string_view option, std::string_view hint);
  std::string name;  ///< as it was typed, with its dashes
};

struct Option {
  std::string_view name;     ///< with its dashes, as help shows it
  std::string_view value;    ///< what follows it, e.g. FILE; empty for a flag; [N]: maybe a number
  std::string_view help;     ///< one line; empty: not shown
  std::string_view alias{};  ///< another name, with its dashes
};

/// A row that begins a group of options in help.
constexpr Option heading(std::string_view words) { return {{}, {}, words}; }

class Arguments {
 public:
  /// Throws UsageError. `words` are what follows the command's name.
  Arguments(std::span<const Option> options, std::span<const std::string> words);

  /// The words that are no options, in order.
  const std::vector<std::string>& operands() const { return operands_; }

  /// The last value given to the option of this name (as in the table).
  bool has(std::string_view name) const;
  std::optional<std::string> text(std::string_view name) const;
  /// All values given to it, in order.
  std::vector<std::string> texts(std::string_view name) const;
  /// Throw UsageError unless the value is such a number, inside the range.
  std::optional<double> positive(std::string_view name) const;
  std::optional<double> number(std::string_view name, const char* expected = "a number") const;
  std::optional<int> integer(std::string_view name, int least, int most) const;

 private:
  void take(std::span<const Option> options, std::span<const std::string> words, std::size_t& at);

  std::vector<std::string> operands_;
  std::map<std::string, std::vector<std::string>, std::less<>> values_of_;  // [as in the table]
};

/// The number that the option of this name was given. Throws UsageError unless it is a whole one in
/// the range.
int whole_number(std::string_view name, const std::string& value, int least, int most);

/// A value of this option is not what was expected. Throws UsageError.
[[noreturn]] void refuse_value(std::string_view name, const std::string& expected,
                               const std::string& found);

/// The lines of a help page for all options that have a help text.
std::string help_lines(std::span<const Option> options);

/// The word without the dashes that it begins with.
std::string_view without_dashes(std::string_view word);

/// Least number of letters to insert, remove, replace or exchange with the next to turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace ductile::cli
