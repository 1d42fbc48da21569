#include "ductile/runtime/executor.hpp"

#include <omp.h>

#include <stdexcept>

namespace ductile::runtime {

int available_cores() { return omp_get_num_procs(); }

Executor::Executor(const ExecutorOptions& options) : options_(options) {
  if (options.threads < 0 || options.threads > 4096)
    throw std::invalid_argument("Executor: threads must be between 0 (automatic) and 4096");
  if (options.threads == 0) options_.threads = available_cores();
}

}  // namespace ductile::runtime
