#include "options.hpp"

#include <charconv>
#include <sstream>

namespace ductile::bench::irregular {

const char* const help_text =
    "Measures serial codes and Ductile on irregular algorithms, alternating, and checks what they\n"
    "give. Programs of PBBS and Galois that are on the PATH run beside them.\n"
    "\n"
    "  --quick          size 2000, one repetition: does everything work?\n"
    "  --only NAME      this algorithm; may be repeated\n"
    "  --size N         vertices or points, 10 to 50000000; may be repeated. Otherwise 100000 and "
    "1000000\n"
    "  --threads LIST   numbers of threads, as 1,2,4. Otherwise 1,2\n"
    "  --repetitions R  runs of each, of which the median counts. Otherwise 5, and fewer where an\n"
    "                   input takes over 20 s\n"
    "  --json FILE      writes what was measured: algorithm, input, threads, seconds, "
    "serial_seconds\n";

namespace {

std::size_t number(const std::string& option, const std::string& word, std::size_t least,
                   std::size_t most) {
  std::size_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc() && stop == end && value >= least && value <= most) return value;
  throw UsageError(option + ": expected a number from " + std::to_string(least) + " to " +
                   std::to_string(most) + ", found '" + word + "'");
}

std::vector<int> thread_counts(const std::string& option, const std::string& list) {
  std::vector<int> counts;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');)
    counts.push_back(static_cast<int>(number(option, word, 1, 4096)));
  if (counts.empty()) throw UsageError(option + ": expected numbers, as 1,2");
  return counts;
}

}  // namespace

Options options_from(const std::vector<std::string>& words) {
  Options options;
  std::vector<std::size_t> sizes;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& option = words[i];
    if (option == "--help" || option == "-h") {
      options.help = true;
      continue;
    }
    if (option == "--quick") {
      options.sizes = {2000};
      options.repetitions = 1;
      continue;
    }
    if (i + 1 == words.size() || option.compare(0, 2, "--") != 0)
      throw UsageError("expected an option and its value, found '" + option + "'; see --help");
    const std::string& value = words[++i];
    if (option == "--only")
      options.only.push_back(value);
    else if (option == "--size")
      sizes.push_back(number(option, value, 10, 50000000));
    else if (option == "--threads")
      options.threads = thread_counts(option, value);
    else if (option == "--repetitions")
      options.repetitions = static_cast<int>(number(option, value, 1, 1000));
    else if (option == "--json")
      options.json = value;
    else
      throw UsageError("there is no option '" + option + "'; see --help");
  }
  if (!sizes.empty()) options.sizes = sizes;
  return options;
}

}  // namespace ductile::bench::irregular
