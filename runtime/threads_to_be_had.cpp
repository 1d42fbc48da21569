#include "threads_to_be_had.hpp"

#include <fcntl.h>
#include <omp.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <vector>

namespace ductile::runtime {
namespace {

// ---- Forked children ----

// Written while a process forks, and by its child.
constinit bool had_threads = false, is_alone = false;

/// Does this process have, or may it have, other threads than the calling one? Reads the 20th field
/// of its stat, the 18th after the name in brackets. Allocates no memory, because fork() may be
/// called anywhere.
bool has_threads() noexcept {
  const int file = ::open("/proc/self/stat", O_RDONLY | O_CLOEXEC);
  if (file < 0) return true;
  std::array<char, 1024> text{};
  const ssize_t size = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  const char* at = size > 0 ? std::strrchr(text.data(), ')') : nullptr;
  for (int field = 0; at != nullptr && field < 18; ++field) at = std::strchr(at + 1, ' ');
  return at == nullptr || std::atoi(at) != 1;
}

void before_fork() noexcept { had_threads = has_threads(); }
void in_child() noexcept { is_alone = is_alone || had_threads; }

/// Registered early, because other code may use OpenMP's threads too.
[[maybe_unused]] const int registered = ::pthread_atfork(before_fork, nullptr, in_child);

// ---- Threads that cannot be had ----

/// Number of threads in the calling thread's last region, which its OpenMP library keeps.
thread_local int kept = 1;
/// Number of calls that run alone before threads are tried again.
thread_local int calls_alone = 0;

extern "C" void* wait_at_gate(void* gate) {
  const std::lock_guard lock(*static_cast<std::mutex*>(gate));
  return nullptr;
}

/// Tries all at once, so that all stacks exist together.
bool can_make_threads(std::size_t count) {
  std::vector<pthread_t> threads;
  threads.reserve(count);
  std::mutex gate;
  {
    const std::lock_guard lock(gate);
    for (pthread_t thread{}; threads.size() < count; threads.push_back(thread))
      if (::pthread_create(&thread, nullptr, wait_at_gate, &gate) != 0) break;
  }
  for (const pthread_t thread : threads) ::pthread_join(thread, nullptr);
  return threads.size() == count;
}

/// About the memory that OpenMP libraries take for a team.
bool has_memory_for(std::size_t threads) {
  constexpr std::size_t of_team = 8192, of_each = 1024;
  void* const memory = std::malloc(of_team + of_each * threads);
  std::free(memory);
  return memory != nullptr;
}

/// A nested region has its own threads, which it does not keep.
bool is_nested() noexcept { return omp_get_level() > 0; }

}  // namespace

int threads_to_be_had(int wanted) {
  if (wanted <= 1 || is_alone) return 1;
  if (is_nested() && omp_get_active_level() >= omp_get_max_active_levels()) return wanted;
  const int possible = std::min(wanted, omp_get_thread_limit());
  const int before = is_nested() ? 1 : kept;
  if (possible > before) {
    if (calls_alone > 0) return --calls_alone, 1;
    if (!has_memory_for(static_cast<std::size_t>(possible)) ||
        !can_make_threads(static_cast<std::size_t>(possible - before))) {
      calls_alone = 100;
      return 1;
    }
  }
  if (!is_nested()) kept = possible;
  return wanted;
}

bool takes_a_region(int threads) noexcept { return threads > 1 || omp_in_parallel() != 0; }

}  // namespace ductile::runtime
