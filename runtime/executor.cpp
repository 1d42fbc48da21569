#include "ductile/runtime/executor.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "binding.hpp"
#include "cgroup.hpp"

namespace ductile::runtime {

int available_cores() {
  const int cores = std::max(1, omp_get_num_procs());  // respects the affinity mask
  const double limit = cgroup_cpu_limit("/sys/fs/cgroup", "/proc/self/cgroup");
  return limit > 0 && limit < cores ? static_cast<int>(std::ceil(limit)) : cores;
}

Executor::Executor(const ExecutorOptions& options) : options_(options) {
  if (options.threads < 0 || options.threads > 4096)
    throw std::invalid_argument("Executor: threads must be between 0 (automatic) and 4096");
  if (options.threads == 0) options_.threads = available_cores();
  places_ = detail::make_places(options.placement);
}

}  // namespace ductile::runtime
