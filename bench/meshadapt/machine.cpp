#include "machine.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace ductile::bench {

namespace {

/// Processing units of the affinity mask.
std::vector<int> usable_units() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  std::vector<int> units;
  if (sched_getaffinity(0, sizeof mask, &mask) != 0) return units;
  for (int unit = 0; unit < CPU_SETSIZE; ++unit)
    if (CPU_ISSET(static_cast<unsigned>(unit), &mask)) units.push_back(unit);
  return units;
}

/// Binds the calling thread; a refusal leaves it where it is.
void bind_to(int unit) {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  CPU_SET(static_cast<unsigned>(unit), &mask);
  sched_setaffinity(0, sizeof mask, &mask);
}

constexpr int batch_count = 7, turns_in_batch = 400;

/// Two threads pass a number back and forth. The first is a new thread, too, so that the caller
/// keeps its affinity. The best batch counts, because others were interrupted.
double round_trip_ns(int unit, int other_unit) {
  constexpr int turns = 2 * batch_count * turns_in_batch;
  alignas(128) std::atomic<int> turn{0};
  double best_ns = 1e12;
  const auto wait_for = [&](int mine) {
    for (int spins = 0; turn.load() != mine; ++spins)
      if (spins > 10000) std::this_thread::yield();  // the other one may have no core
  };
  std::thread other([&] {
    bind_to(other_unit);
    for (int mine = 1; mine < turns; mine += 2) {
      wait_for(mine);
      turn.store(mine + 1);
    }
  });
  std::thread one([&] {
    bind_to(unit);
    for (int batch = 0; batch < batch_count; ++batch) {
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < turns_in_batch; ++i) {
        const int mine = 2 * (batch * turns_in_batch + i);
        wait_for(mine);
        turn.store(mine + 1);
      }
      const std::chrono::duration<double, std::nano> taken =
          std::chrono::steady_clock::now() - start;
      best_ns = std::min(best_ns, taken.count() / turns_in_batch);
    }
  });
  one.join();
  other.join();
  return best_ns;
}

const char* word_for(double ns) {
  if (ns <= 0) return "-";
  if (ns < 75) return "one core";
  return ns < 250 ? "near" : "far";
}

/// The value behind a key of /proc/cpuinfo or /proc/self/status.
std::string value_in(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.compare(0, key.size(), key) == 0) {
      const std::size_t start = line.find_first_not_of(" \t:", key.size());
      return start == std::string::npos ? "" : line.substr(start);
    }
  return "";
}

}  // namespace

CoreDistance core_distance(int threads) {
  const std::vector<int> units = usable_units();
  constexpr std::size_t most = 16;
  const std::size_t count = std::min({units.size(), static_cast<std::size_t>(threads), most});
  CoreDistance distance;
  for (std::size_t i = 1; i < count; ++i) {
    const double ns = round_trip_ns(units[0], units[i]);
    distance.nearest_ns = i == 1 ? ns : std::min(distance.nearest_ns, ns);
    distance.farthest_ns = std::max(distance.farthest_ns, ns);
  }
  return distance;
}

std::string placement_of(const CoreDistance& distance) {
  const std::string nearest = word_for(distance.nearest_ns);
  const std::string farthest = word_for(distance.farthest_ns);
  return nearest == farthest ? nearest : nearest + " to " + farthest;
}

/// Writing "5" makes Linux set VmHWM to the memory held now (proc(5)), so freed memory is returned
/// first.
void reset_peak_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";
}

std::size_t peak_memory() {
  const std::string kilobytes = value_in("/proc/self/status", "VmHWM");
  if (!kilobytes.empty()) return std::stoul(kilobytes) * 1024;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string machine_line() {
  const std::string name = value_in("/proc/cpuinfo", "model name");
  const auto setting = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return std::string("; ") + variable + " " + (value == nullptr ? "not set" : value);
  };
  return (name.empty() ? "unknown processor" : name) + "; " +
         std::to_string(usable_units().size()) +
         " processing units to use; compiler " DUCTILE_COMPILER + setting("OMP_WAIT_POLICY") +
         setting("GOMP_SPINCOUNT");
}

}  // namespace ductile::bench
