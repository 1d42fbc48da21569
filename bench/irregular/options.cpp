#include "options.hpp"

#include <array>
#include <sstream>

namespace ductile::bench::irregular {

namespace {

constexpr std::array<cli::Option, 7> options{{
    {"--quick", "", "size 2000, one repetition: does everything work?"},
    {"--only", "NAME", "this algorithm; may be given again"},
    {"--size", "N", "vertices or points; may be given again (default: 100000 and 1000000)"},
    {"--threads", "LIST", "numbers of threads, as 1,2,4 (default: 1,2)"},
    {"--repetitions", "R",
     "runs of each, of which the median counts (default: 5; fewer where an input takes over 20 s)"},
    {"--json", "FILE",
     "writes what was measured: algorithm, input, threads, seconds, serial_seconds"},
    {"--help", "", "says this", "-h"},
}};

std::vector<int> thread_counts(const std::string& list) {
  std::vector<int> counts;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    counts.push_back(cli::whole_number("--threads", word, 1, 4096));
  if (counts.empty()) throw UsageError("option --threads: expected numbers, as 1,2");
  return counts;
}

}  // namespace

std::span<const cli::Option> known_options() { return options; }

Options options_from(const std::vector<std::string>& words) {
  const cli::Arguments arguments(options, words);
  if (!arguments.operands().empty())
    throw UsageError("expected options only, found '" + arguments.operands()[0] + "'");
  Options chosen;
  chosen.help = arguments.has("--help");
  chosen.only = arguments.texts("--only");
  if (arguments.has("--quick")) {
    chosen.sizes = {2000};
    chosen.repetitions = 1;
  }
  const std::vector<std::string> sizes = arguments.texts("--size");
  if (!sizes.empty()) chosen.sizes.clear();
  for (const std::string& size : sizes)
    chosen.sizes.push_back(
        static_cast<std::size_t>(cli::whole_number("--size", size, 10, 50000000)));
  if (const auto list = arguments.text("--threads")) chosen.threads = thread_counts(*list);
  chosen.repetitions = arguments.integer("--repetitions", 1, 1000).value_or(chosen.repetitions);
  chosen.json = arguments.text("--json").value_or("");
  return chosen;
}

}  // namespace ductile::bench::irregular
