#include <span>
#include <string>
#include <vector>

#include "command.hpp"
#include "system.hpp"

int main(int argument_count, char** argument) {
  ductile::cli::wait_briefly(argument);
  ductile::cli::reuse_memory();
  const std::vector<std::string> words(argument + 1, argument + argument_count);
  return ductile::cli::run_program(words);
}
