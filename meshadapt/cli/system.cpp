#include "system.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace ductile::cli {

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return static_cast<std::size_t>(usage.ru_maxrss);
#else
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
}

void limit_memory(std::size_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
}

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace ductile::cli
