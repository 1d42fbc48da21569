/// @file
/// The commands of the program `ductile`: one table that main() and help read.
#pragma once

#include <span>
#include <string_view>

#include "arguments.hpp"
#include "ductile/runtime/executor.hpp"
#include "mmg_options.hpp"
#include "system.hpp"

namespace ductile::cli {

/// Exit statuses of the program.
inline constexpr int done = 0, failed = 1, misused = 2;

struct Command {
  const char* name;
  const char* operands;  ///< as in "MESH [-o OUT]"
  const char* summary;   ///< one line, a sentence without its full stop
  const char* details;   ///< further lines; may be empty
  std::span<const Option> options;
  int (*run)(const Arguments& arguments);  ///< returns the exit status; throws Error
  /// The advice for an option, without dashes, that the command does not have; may be empty.
  std::string_view (*instead)(std::string_view option) = instead_of_mmg_option;
};

extern const Command adapt_command, info_command, metric_command, move_command, transfer_command,
    view_command, convert_command;

/// The values of --threads, 0 for as many as there are cores, and of -v. Throw UsageError.
inline int threads_of(const Arguments& arguments) {
  return arguments.integer("--threads", 1, 4096).value_or(0);
}
inline int verbosity_of(const Arguments& arguments) {
  return arguments.integer("-v", -1, 10).value_or(1);
}

/// Runs the long part of a command and returns its exit status, body(executor). The executor's
/// threads are a team meanwhile (runtime::with_team), so that idle ones soon sleep, and reuse
/// memory.
template <class Body>
int run_in_team(const runtime::ExecutorOptions& options, Body&& body) {
  const runtime::Executor executor(options);
  reuse_memory(executor.threads());
  int status = failed;
  runtime::with_team(executor, [&] { status = body(executor); });
  return status;
}

/// Runs `adapt` with -lag. Throws UsageError for options that do not go with it.
int run_lag(const Arguments& arguments);

/// A program with commands.
struct Program {
  const char* name;                          ///< as messages begin
  const char* summary;                       ///< a sentence without its subject and full stop
  std::span<const Command* const> commands;  ///< in the order of help
  const char* launcher = "";                 ///< what starts it, for help, with a space at its end
  bool speaks = true;  ///< prints help and errors; of several processes only one does
};

/// Runs a program on the arguments of main(): prints errors, also that memory has run out, and
/// returns the exit status.
int run_program(const Program& program, int argument_count, const char* const* argument) noexcept;
/// The same for `ductile`.
int run_program(int argument_count, const char* const* argument) noexcept;

}  // namespace ductile::cli
