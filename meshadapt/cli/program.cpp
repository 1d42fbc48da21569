#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "mmg_options.hpp"
#include "version.hpp"

namespace ductile::cli {

namespace {

constexpr std::array<const Command*, 6> all_commands{&adapt_command,  &info_command,
                                                     &metric_command, &transfer_command,
                                                     &view_command,   &convert_command};

const Command* find_command(std::string_view name) {
  for (const Command* command : all_commands)
    if (command->name == name) return command;
  return nullptr;
}

void print_overview(std::FILE* to) {
  std::fprintf(to, "ductile %s: adapts triangle and tetrahedral meshes to a metric.\n\nCommands:\n",
               version);
  for (const Command* command : all_commands)
    std::fprintf(to, "  ductile %-8s %s\n", std::string(command->name).c_str(),
                 std::string(command->summary).c_str());
  std::fprintf(to,
               "  ductile help COMMAND  shows its options\n"
               "  ductile --version     says which version this is\n\nMeshes:\n");
  for (const meshadapt::MeshFormat& format : meshadapt::mesh_formats())
    std::fprintf(to, "  %-8s %s%s%s\n", std::string(format.ending).c_str(),
                 std::string(format.what).c_str(), format.holds_fields ? ", with fields" : "",
                 !format.is_read      ? " (written only)"
                 : !format.is_written ? " (read only)"
                                      : "");
  std::fprintf(to,
               "\n"
               "Exit status: 0 the output is valid and written; 1 it could not be done;\n"
               "2 the command line or the input is wrong.\n");
}

}  // namespace

void print_help(const Command& command, std::string_view program) {
  std::printf("%s %s %s\n%s.\n", std::string(program).c_str(), std::string(command.name).c_str(),
              std::string(command.operands).c_str(), std::string(command.summary).c_str());
  if (!command.details.empty()) std::printf("%s\n", std::string(command.details).c_str());
  std::printf("\nOptions (one or two dashes mean the same):\n");
  std::printf("%s", help_lines(command.options).c_str());
  std::printf("  %-22s %s\n", "-h, --help", "shows its options");
}

namespace {

[[noreturn]] void refuse_command(const std::string& name) {
  std::string message = "unknown command '" + name + "'";
  for (const Command* command : all_commands)
    if (edit_distance(name, command->name) <= 2)
      message += "; did you mean '" + std::string(command->name) + "'?";
  throw UsageError(message + " (ductile help lists the commands)");
}

bool asks_for_help(std::span<const std::string> words) {
  for (const std::string& word : words) {
    if (word == "--") return false;
    if (word == "-h" || word == "--help" || word == "-help") return true;
  }
  return false;
}

int run_help(std::span<const std::string> words) {
  if (words.empty()) {
    print_overview(stdout);
  } else {
    const Command* command = find_command(words[0]);
    if (!command) refuse_command(words[0]);
    print_help(*command);
  }
  return done;
}

/// Adds the alternative to the error about an option of Mmg that is refused.
Arguments arguments_of(const Command& command, std::span<const std::string> words) {
  try {
    return Arguments(command.options, words);
  } catch (const UnknownOption& error) {
    const std::string_view instead = instead_of_mmg_option(without_dashes(error.name));
    if (instead.empty()) throw;
    throw UnknownOption(error.name, instead);
  }
}

int dispatch(std::span<const std::string> words) {
  if (words.empty()) {
    print_overview(stderr);
    return misused;
  }
  const std::string& name = words[0];
  if (name == "--version" || name == "-version") {
    std::printf("ductile %s\n", version);
    return done;
  }
  if (name == "help" || name == "--help" || name == "-h") return run_help(words.subspan(1));
  const Command* command = find_command(name);
  if (!command) refuse_command(name);
  if (asks_for_help(words.subspan(1))) return run_help(words.first(1));
  return command->run(arguments_of(*command, words.subspan(1)));
}

/// Takes no memory, because it may have run out.
int tell(const char* message, int status) noexcept {
  std::fprintf(stderr, "ductile: %s\n", message);
  return status;
}

int run_words(std::span<const std::string> words) {
  try {
    const int status = dispatch(words);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      return tell("standard output took no more: is the disk full?", failed);
    return status;
  } catch (const UsageError& error) {
    const bool known = !words.empty() && find_command(words[0]);
    const std::string message = (known ? words[0] + ": " : std::string()) + error.what() +
                                (known ? " (ductile help " + words[0] + " lists the options)" : "");
    return tell(meshadapt::printable(message).c_str(), misused);
  } catch (const meshadapt::InputError& error) {
    return tell(error.in_file(), misused);
  }
}

}  // namespace

std::span<const Command* const> commands() { return all_commands; }

int run_program(int argument_count, const char* const* argument) noexcept {
  try {
    return run_words(std::vector<std::string>(argument + 1, argument + argument_count));
  } catch (const std::bad_alloc&) {
    return tell("out of memory; allow more (-m) or take a smaller mesh", failed);
  } catch (const std::exception& error) {
    return tell(error.what(), failed);
  }
}

}  // namespace ductile::cli
