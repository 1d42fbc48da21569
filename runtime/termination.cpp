#include "ductile/runtime/process.hpp"

#include <signal.h>  // NOLINT(modernize-deprecated-headers): sigaction is POSIX's
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>

namespace ductile::runtime {
namespace {

/// Signals by which users end a process or a system limits it, not those of program faults.
constexpr std::array signals{SIGHUP,  SIGINT,  SIGQUIT, SIGPIPE,   SIGALRM, SIGTERM,
                             SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF};

// Handlers belong to the process, and so does this record. Guarded by the mutex.
constinit std::mutex mutex;
constinit int users = 0;
constinit std::array<bool, signals.size()> is_ours{};

// Read and written by the handler.
constinit std::atomic<pid_t> owner{0};  // the files of a forked child belong to its parent
constinit std::atomic<int> holders{0};
constinit std::atomic<bool> ending{false};
constinit std::array<std::atomic<bool>, signals.size()> waiting{};
constinit std::array<std::atomic<char*>, 64> names{};

static_assert(std::atomic<char*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free &&
              std::atomic<int>::is_always_lock_free && std::atomic<pid_t>::is_always_lock_free);

void end_by(int number) {
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  sigaction(number, &action, nullptr);
  raise(number);  // takes effect now, or when the handler returns
}

void let_wait(int number) {
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (signals[i] == number) waiting[i] = true;
}

/// A thread that starts to hold signals now waits for the end; one that started earlier is found
/// here, because all accesses of `ending` and `holders` are totally ordered.
extern "C" void ductile_on_ending_signal(int number) {
  const int error_before = errno;
  if (getpid() != owner) {
    end_by(number);
  } else {
    ending = true;
    if (holders > 0) {
      let_wait(number);
      ending = false;
    } else {
      for (const auto& name : names)
        if (const char* const file = name) unlink(file);
      end_by(number);
    }
  }
  errno = error_before;
}

void take_signals() {
  const std::lock_guard lock(mutex);
  if (users++ > 0 && owner == getpid()) return;
  owner = getpid();
  struct sigaction action = {};
  action.sa_handler = ductile_on_ending_signal;
  action.sa_flags = SA_RESTART;
  sigfillset(&action.sa_mask);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    struct sigaction before = {};
    is_ours[i] = sigaction(signals[i], nullptr, &before) == 0 &&
                 (before.sa_flags & SA_SIGINFO) == 0 &&
                 (before.sa_handler == SIG_DFL || before.sa_handler == ductile_on_ending_signal) &&
                 sigaction(signals[i], &action, nullptr) == 0;
  }
}

void give_signals_back() {
  const std::lock_guard lock(mutex);
  if (--users > 0) return;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    struct sigaction now = {};
    if (!is_ours[i] || sigaction(signals[i], nullptr, &now) != 0) continue;
    if (now.sa_handler != ductile_on_ending_signal) continue;  // another handler has replaced ours
    now = {};
    now.sa_handler = SIG_DFL;
    sigaction(signals[i], &now, nullptr);
  }
}

}  // namespace

HeldSignals::HeldSignals() noexcept {
  take_signals();
  ++holders;
  while (ending) std::this_thread::yield();
}

HeldSignals::~HeldSignals() {
  const bool last = --holders == 0;
  while (ending) std::this_thread::yield();  // a handler may be about to defer its signal
  give_signals_back();
  for (std::size_t i = 0; last && i < signals.size(); ++i)
    if (waiting[i].exchange(false)) raise(signals[i]);
}

VanishingFile::VanishingFile(const char* name) noexcept : slot_(names.size()) {
  take_signals();
  char* const copy = strdup(name);
  for (std::size_t i = 0; copy != nullptr && i < names.size(); ++i) {
    char* none = nullptr;
    if (!names[i].compare_exchange_strong(none, copy)) continue;
    slot_ = i;
    return;
  }
  std::free(copy);
}

VanishingFile::~VanishingFile() {
  if (slot_ < names.size()) {
    const HeldSignals held;  // the handler does not read the name meanwhile
    std::free(names[slot_].exchange(nullptr));
  }
  give_signals_back();
}

}  // namespace ductile::runtime
