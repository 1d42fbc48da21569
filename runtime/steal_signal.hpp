/// @file
/// StealSignal: borrows a real-time signal while loops steal by signal (private to the runtime). It
/// takes a signal without a handler when the first such loop starts, and restores its disposition
/// after the last one ends. If all signals have handlers, it shares one and forwards signals that
/// no thief sent. It never takes a signal that the calling thread blocks, because the program may
/// wait for it: sigwait(), a signalfd, a timer.
#pragma once

#include <csignal>

namespace ductile::runtime {

class StealSignal {
 public:
  /// Called in the handler, on the thread that received the signal, with the value sent. May only
  /// touch lock-free atomics.
  using Handler = void (*)(void* sent);

  /// Does not throw; check available(). None is available if the calling thread blocks them all, or
  /// blocks the one that another loop has borrowed.
  explicit StealSignal(Handler handler) noexcept;
  ~StealSignal();
  StealSignal(const StealSignal&) = delete;
  StealSignal& operator=(const StealSignal&) = delete;

  bool available() const { return number_ != 0; }

  /// Interrupts a thread; false if the system has no room for another signal.
  /// Thread safety: any thread. A signal sent is handled before the loan ends, or not at all.
  bool send(pthread_t to, void* what) const noexcept;

  /// Lets the calling thread receive the signal during its lifetime.
  class Reception {
   public:
    explicit Reception(const StealSignal& signal) noexcept;
    ~Reception();
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

   private:
    sigset_t before_;
  };

 private:
  int number_ = 0;  // 0: none available
};

}  // namespace ductile::runtime
