#include "steal_signal.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>

namespace ductile::runtime {

namespace {

// A signal's disposition belongs to the process, and so does this record. The mutex guards it,
// except `handler` and `before`, which the signal handler reads: they change only while the handler
// is not installed.
struct Loan {
  std::mutex mutex;
  int users = 0;
  int number = 0;
  StealSignal::Handler handler = nullptr;
  struct sigaction before = {};
};
constinit Loan loan;

bool has_handler(const struct sigaction& action) {
  return (action.sa_flags & SA_SIGINFO) != 0 ||
         (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN);
}

void pass_on(int number, siginfo_t* info, void* context) {
  if (!has_handler(loan.before)) return;
  if ((loan.before.sa_flags & SA_SIGINFO) != 0) {
    loan.before.sa_sigaction(number, info, context);
  } else {
    loan.before.sa_handler(number);
  }
}

extern "C" void on_steal_signal(int number, siginfo_t* info, void* context) {
  const int error_before = errno;
  if (info->si_code == SI_QUEUE && info->si_pid == getpid()) {
    loan.handler(info->si_value.sival_ptr);
  } else {
    pass_on(number, info, context);
  }
  errno = error_before;
}

/// Does the calling thread block the signal? It may wait for it by sigwait() or a signalfd, which
/// no handler shows.
bool is_blocked(int number) {
  sigset_t blocked;
  sigemptyset(&blocked);
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  return sigismember(&blocked, number) == 1;
}

/// The highest unhandled signal, otherwise the highest, among those that the calling thread does
/// not block. 0 if there are none.
int choose_number() {
  int highest = 0;
  for (int number = SIGRTMAX; number >= SIGRTMIN; --number) {
    struct sigaction action = {};
    if (is_blocked(number) || sigaction(number, nullptr, &action) != 0) continue;
    if (!has_handler(action)) return number;
    highest = std::max(highest, number);
  }
  return highest;
}

}  // namespace

StealSignal::StealSignal(Handler handler) noexcept {
  const std::lock_guard lock(loan.mutex);
  if (loan.users == 0) {
    const int number = choose_number();
    struct sigaction action = {};
    action.sa_sigaction = on_steal_signal;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigfillset(&action.sa_mask);
    if (number == 0 || sigaction(number, nullptr, &loan.before) != 0) return;
    loan.handler = handler;
    if (sigaction(number, &action, nullptr) != 0) return;
    loan.number = number;
  } else if (is_blocked(loan.number)) {
    return;
  }
  ++loan.users;
  number_ = loan.number;
}

StealSignal::~StealSignal() {
  if (number_ == 0) return;
  const std::lock_guard lock(loan.mutex);
  if (--loan.users == 0) sigaction(loan.number, &loan.before, nullptr);
}

bool StealSignal::send(pthread_t to, void* what) const noexcept {
  sigval value = {};
  value.sival_ptr = what;
  return pthread_sigqueue(to, number_, value) == 0;
}

StealSignal::Reception::Reception(const StealSignal& signal) noexcept {
  sigset_t wanted;
  sigemptyset(&wanted);
  sigaddset(&wanted, signal.number_);
  pthread_sigmask(SIG_UNBLOCK, &wanted, &before_);
}

StealSignal::Reception::~Reception() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace ductile::runtime
