/// @file
/// The commands of the program `ductile`: one table that main() and help read.
#pragma once

#include <span>
#include <string_view>

#include "arguments.hpp"
#include "mmg_options.hpp"

namespace ductile::cli {

/// Exit statuses of the program.
inline constexpr int done = 0, failed = 1, misused = 2;

struct Command {
  std::string_view name;
  std::string_view operands;  ///< as in "MESH [-o OUT]"
  std::string_view summary;   ///< one line, a sentence without its full stop
  std::string_view details;   ///< further lines
  std::span<const Option> options;
  int (*run)(const Arguments& arguments);  ///< returns the exit status; throws Error
  /// The advice for an option, without dashes, that the command does not have; may be empty.
  std::string_view (*instead)(std::string_view option) = instead_of_mmg_option;
};

extern const Command adapt_command, info_command, metric_command, move_command, transfer_command,
    view_command, convert_command;

/// A program with commands.
struct Program {
  std::string_view name;                     ///< as messages begin
  std::string_view summary;                  ///< a sentence without its subject and full stop
  std::span<const Command* const> commands;  ///< in the order of help
  std::string_view launcher{};               ///< what starts it, for help, with a space at its end
  bool speaks = true;  ///< prints help and errors; of several processes only one does
};

/// Runs a program on the arguments of main(): prints errors, also that memory has run out, and
/// returns the exit status.
int run_program(const Program& program, int argument_count, const char* const* argument) noexcept;
/// The same for `ductile`.
int run_program(int argument_count, const char* const* argument) noexcept;

}  // namespace ductile::cli
