#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "system.hpp"

namespace {

/// Is one thread asked for, which waits for nobody? Words are not checked yet; the last one counts.
bool is_alone(std::span<const std::string> words) {
  constexpr std::string_view name = "-threads";
  bool alone = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view option = std::string_view(words[i]).substr(words[i].starts_with("--"));
    if (option == name) alone = i + 1 < words.size() && words[i + 1] == "1";
    if (option.starts_with("-threads=")) alone = option.substr(name.size()) == "=1";
  }
  return alone;
}

}  // namespace

int main(int argument_count, char** argument) {
  const std::vector<std::string> words(argument + 1, argument + argument_count);
  if (!is_alone(words)) ductile::cli::wait_briefly(argument);
  ductile::cli::reuse_memory();
  return ductile::cli::run_program(words);
}
