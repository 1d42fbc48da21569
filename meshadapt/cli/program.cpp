#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "version.hpp"

namespace ductile::cli {

namespace {

constexpr std::array<const Command*, 7> all_commands{
    &adapt_command,    &info_command, &metric_command, &move_command,
    &transfer_command, &view_command, &convert_command};

const Command* find_command(const Program& program, std::string_view name) {
  for (const Command* command : program.commands)
    if (command->name == name) return command;
  return nullptr;
}

void print_overview(const Program& program, std::FILE* to) {
  std::fprintf(to, "%s %s: %s.\n\nCommands:\n", program.name, version, program.summary);
  for (const Command* command : program.commands)
    std::fprintf(to, "  %s %-8s %s\n", program.name, command->name, command->summary);
  std::fprintf(to,
               "  %s help COMMAND  shows its options\n"
               "  %s --version     says which version this is\n\nMeshes:\n",
               program.name, program.name);
  for (const MeshFormat& format : mesh_formats())
    std::fprintf(to, "  %-8s %s%s%s\n", format.ending.data(), format.what.data(),
                 format.holds_fields ? ", with fields" : "",
                 !format.is_read      ? " (written only)"
                 : !format.is_written ? " (read only)"
                                      : "");
  std::fprintf(to,
               "\n"
               "Exit status: 0 the output is valid and written; 1 it could not be done;\n"
               "2 the command line or the input is wrong.\n");
}

void print_help(const Program& program, const Command& command) {
  std::printf("%s%s %s %s\n%s.\n%s%s\nOptions (one or two dashes mean the same):\n%s",
              program.launcher, program.name, command.name, command.operands, command.summary,
              command.details, *command.details == '\0' ? "" : "\n",
              help_lines(command.options).c_str());
  std::printf("  %-22s %s\n", "-h, --help", "shows this help");
}

/// Messages say what is wrong and then, behind a semicolon, what to do. This adds to the latter.
std::string with_advice(const std::string& message, const std::string& advice) {
  return message.find("; ") == std::string::npos ? message + "; " + advice
                                                 : message + " (" + advice + ")";
}

[[noreturn]] void refuse_command(const Program& program, const std::string& name) {
  std::string message = "unknown command '" + name + "'";
  for (const Command* command : program.commands)
    if (edit_distance(name, command->name) <= 2)
      message += "; did you mean '" + std::string(command->name) + "'?";
  if (format_of(name) != nullptr && find_command(program, "adapt") != nullptr)
    message += "; did you mean '" + std::string(program.name) + " adapt " + name + "'?";
  throw UsageError(with_advice(message, std::string(program.name) + " help lists the commands"));
}

bool asks_for_help(std::span<const std::string> words) {
  for (const std::string& word : words) {
    if (word == "--") return false;
    if (word == "-h" || word == "--help" || word == "-help") return true;
  }
  return false;
}

int run_help(const Program& program, std::span<const std::string> words) {
  const Command* command = words.empty() ? nullptr : find_command(program, words[0]);
  if (!words.empty() && !command) refuse_command(program, words[0]);
  if (!program.speaks) return done;
  if (command)
    print_help(program, *command);
  else
    print_overview(program, stdout);
  return done;
}

/// Adds the command's advice to the error about an unknown option.
Arguments arguments_of(const Command& command, std::span<const std::string> words) {
  try {
    return Arguments(command.options, words);
  } catch (const UnknownOption& error) {
    const std::string_view instead = command.instead(without_dashes(error.name));
    if (instead.empty()) throw;
    throw UnknownOption(error.name, instead);
  }
}

int dispatch(const Program& program, std::span<const std::string> words) {
  if (words.empty()) {
    if (program.speaks) print_overview(program, stderr);
    return misused;
  }
  const std::string& name = words[0];
  if (name == "--version" || name == "-version") {
    if (program.speaks) std::printf("%s %s\n", program.name, version);
    return done;
  }
  if (name == "help" || name == "--help" || name == "-h")
    return run_help(program, words.subspan(1));
  const Command* command = find_command(program, name);
  if (!command) refuse_command(program, name);
  if (asks_for_help(words.subspan(1))) return run_help(program, words.first(1));
  return command->run(arguments_of(*command, words.subspan(1)));
}

/// Prints a line with what is wrong and, if the message has any, one with what to do. Allocates
/// nothing, because memory may have run out.
int tell(const Program& program, const char* message, int status) noexcept {
  if (!program.speaks) return status;
  const std::string_view text(message);
  const std::size_t end = std::min(text.find("; "), text.size());
  const bool advises = end < text.size();
  std::fprintf(stderr, "%s: error: %.*s%s%s\n", program.name, static_cast<int>(end), message,
               advises ? "\n  " : "", advises ? message + end + 2 : "");
  return status;
}

int run_words(const Program& program, std::span<const std::string> words) {
  try {
    const int status = dispatch(program, words);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return tell(program, "standard output took no more: is the disk full?", failed);
    return status;
  } catch (const UsageError& error) {
    const bool known = !words.empty() && find_command(program, words[0]);
    std::string message = error.what();
    if (known)
      message = with_advice(words[0] + ": " + message,
                            std::string(program.name) + " help " + words[0] + " lists the options");
    return tell(program, printable(message).c_str(), misused);
  } catch (const InputError& error) {
    return tell(program, error.in_file(), misused);
  }
}

}  // namespace

int run_program(const Program& program, int argument_count, const char* const* argument) noexcept {
  try {
    return run_words(program, std::vector<std::string>(argument + 1, argument + argument_count));
  } catch (const std::bad_alloc&) {
    return tell(program, "out of memory; allow more (-m) or take a smaller mesh", failed);
  } catch (const std::exception& error) {
    return tell(program, error.what(), failed);
  }
}

int run_program(int argument_count, const char* const* argument) noexcept {
  return run_program(
      {"ductile", "adapts triangle and tetrahedral meshes to a metric", all_commands},
      argument_count, argument);
}

}  // namespace ductile::cli
