#include "system.hpp"

#include <sys/resource.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "ductile/runtime/process.hpp"

namespace ductile::cli {

namespace {

/// Bytes of writable addresses, used or not, which is what systems limit; 0 if unknown.
std::size_t writable_addresses() {
  std::ifstream statm("/proc/self/statm");
  std::size_t size = 0, resident = 0, shared = 0, text = 0, unused = 0, data = 0;
  statm >> size >> resident >> shared >> text >> unused >> data;
  return statm ? data * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace

void limit_memory(std::size_t bytes) {
  const std::size_t held = runtime::peak_memory(), more = bytes > held ? bytes - held : 0;
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>(writable_addresses() + more, limit.rlim_cur);
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
