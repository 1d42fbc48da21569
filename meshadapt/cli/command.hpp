/// @file
/// The commands of the program `ductile`: one table that main() and help read.
#pragma once

#include <span>
#include <string_view>

#include "arguments.hpp"

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
};

extern const Command adapt_command, info_command, metric_command, transfer_command, view_command,
    convert_command;

/// Prints the help of a command for a program of this name.
void print_help(const Command& command, std::string_view program = "ductile");

/// All commands, in the order of help.
std::span<const Command* const> commands();

/// Runs the program on the arguments of main(), prints errors (also if memory runs out) and returns
/// the exit status.
int run_program(int argument_count, const char* const* argument) noexcept;

}  // namespace ductile::cli
