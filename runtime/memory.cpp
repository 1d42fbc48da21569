#include "ductile/runtime/process.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <string>

#include "cgroup.hpp"

namespace ductile::runtime {
namespace {

/// The kilobytes after a name in a file with lines such as "VmHWM:  1234 kB", in bytes; 0 if
/// missing.
std::size_t bytes_told(const char* file, const std::string& name) {
  std::ifstream lines(file);
  for (std::string word; lines >> word;) {
    std::size_t kilobytes = 0;
    if (word == name + ":" && lines >> kilobytes) return kilobytes * 1024;
    lines.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return 0;
}

/// Lowers `limit` to `other` if that is a limit and lower.
void keep_least(std::size_t& limit, double other) {
  constexpr double most = 1e18;
  if (other > 0 && other < most && (limit == 0 || other < static_cast<double>(limit)))
    limit = static_cast<std::size_t>(other);
}

}  // namespace

std::size_t held_memory() { return bytes_told("/proc/self/status", "VmRSS"); }

std::size_t peak_memory() {
  if (const std::size_t peak = bytes_told("/proc/self/status", "VmHWM")) return peak;
  rusage usage{};  // for a child it includes what its parent held
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return static_cast<std::size_t>(usage.ru_maxrss);
#else
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
}

std::size_t most_memory() {
  constexpr const char* of_machine = "/proc/meminfo";
  std::size_t most = bytes_told(of_machine, "MemTotal");
  keep_least(most, cgroup_memory_limit("/sys/fs/cgroup", "/proc/self/cgroup"));
  if (most > 0) most += bytes_told(of_machine, "SwapTotal");
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    keep_least(most, static_cast<double>(limit.rlim_cur));
  return most;
}

}  // namespace ductile::runtime
