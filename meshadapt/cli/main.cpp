#include "command.hpp"

int main(int argument_count, char** argument) {
  return ductile::cli::run_program(argument_count, argument);
}
