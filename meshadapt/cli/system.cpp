#include "system.hpp"

#include <sys/resource.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
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

void reuse_memory(int threads) {
#ifdef __GLIBC__
  const bool few = threads <= 4;
  mallopt(M_MMAP_THRESHOLD, 32 << 20);               // larger arrays in pages of their own
  mallopt(M_TRIM_THRESHOLD, (few ? 10 : 32) << 20);  // more, free at a heap's end, is given back
  if (few) mallopt(M_ARENA_MAX, 1);                  // one heap: what a thread frees serves all
#else
  static_cast<void>(threads);
#endif
}

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace ductile::cli
