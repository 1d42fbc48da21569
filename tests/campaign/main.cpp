// campaign: random adaptations by the program, each checked by code that shares nothing with it.

#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "campaign.hpp"

namespace ductile::campaign {
namespace {

constexpr std::array<cli::Option, 12> options{{
    {"--program", "FILE", "ductile, to be tried"},
    {"--minutes", "N", "how long (default: 1)"},
    {"--seed", "S", "other seeds, other cases (default: 1)"},
    {"--kind", "NAME", "cases of one kind only"},
    {"--case", "N", "one case, with all checks; its folder is kept"},
    {"--first", "N", "number of the first case (default: 0)"},
    {"--cases", "N", "no more than N cases"},
    {"--limit", "SECONDS", "a run that takes longer is a fault (default: 20)"},
    {"--restless", "SHARE", "of cases that may change at the third call (default: 0.05)"},
    {"--workers", "N", "cases side by side (default: one per core)"},
    {"--folder", "FOLDER", "where failing cases are kept (default: campaign)"},
    {"--help", "", "says this and lists the kinds", "-h"},
}};

/// Value of an option that may be any 64-bit number.
std::uint64_t count(const cli::Arguments& arguments, const char* name, std::uint64_t otherwise) {
  const auto value = arguments.text(name);
  if (!value) return otherwise;
  std::uint64_t number = 0;
  const char* const end = value->data() + value->size();
  const auto [stop, error] = std::from_chars(value->data(), end, number);
  if (error != std::errc() || stop != end) cli::refuse_value(name, "a whole number", *value);
  return number;
}

Campaign campaign_from(const cli::Arguments& arguments) {
  if (!arguments.operands().empty())
    throw cli::UsageError("expected options only, found '" + arguments.operands()[0] + "'");
  Campaign campaign;
  Settings& settings = campaign.settings;
  settings.program = arguments.text("--program").value_or("ductile");
  settings.limit_s = arguments.positive("--limit").value_or(settings.limit_s);
  settings.all_checks = arguments.has("--case");
  campaign.minutes = arguments.number("--minutes").value_or(campaign.minutes);
  campaign.seed = count(arguments, "--seed", campaign.seed);
  campaign.kind = arguments.text("--kind").value_or("");
  campaign.first = count(arguments, "--case", count(arguments, "--first", campaign.first));
  campaign.count = settings.all_checks ? 1 : count(arguments, "--cases", campaign.count);
  campaign.restless_allowed = arguments.number("--restless").value_or(campaign.restless_allowed);
  campaign.workers = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  campaign.workers = arguments.integer("--workers", 1, 4096).value_or(campaign.workers);
  if (settings.all_checks) campaign.workers = 1;
  campaign.folder = std::filesystem::absolute(arguments.text("--folder").value_or("campaign"));
  if (settings.program.has_parent_path())
    settings.program = std::filesystem::absolute(settings.program);
  return campaign;
}

void print_help() {
  std::printf(
      "Random adaptations, each checked; exit status 1 if any is wrong.\n\nOptions:\n%s\nKinds:",
      cli::help_lines(options).c_str());
  for (const std::string& name : kind_names()) std::printf(" %s", name.c_str());
  std::printf("\n");
}

}  // namespace
}  // namespace ductile::campaign

int main(int count, char** words) {
  using namespace ductile::campaign;
  try {
    const ductile::cli::Arguments arguments(options,
                                            std::vector<std::string>(words + 1, words + count));
    if (arguments.has("--help")) {
      print_help();
      return 0;
    }
    return run_campaign(campaign_from(arguments)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "campaign: %s\n", error.what());
    return 2;
  }
}
