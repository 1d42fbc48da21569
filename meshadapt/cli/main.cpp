#include <string>
#include <vector>

#include "command.hpp"

int main(int argument_count, char** argument) {
  const std::vector<std::string> words(argument + 1, argument + argument_count);
  return ductile::cli::run_program(words);
}
