/// @file
/// StealSignal: the loan of a real-time signal while loops steal by signal (private to the
/// runtime). The number is one without a handler, chosen when the first loop asks; it is given
/// back, with the disposition it had, when the last one is over. If all numbers have handlers, one
/// is shared: signals that no thief sent go on to the handler that was there. One that the calling
/// thread blocks is never taken, as the program may wait for it: sigwait(), a signalfd, a timer.
#pragma once

#include <csignal>

namespace ductile::runtime {

class StealSignal {
 public:
  /// Called in the handler, on the thread that got the signal, with what was sent. Touches
  /// lock-free atomics only.
  using Handler = void (*)(void* sent);

  /// Throws nothing: ask available(). There is none where the calling thread blocks them all, or
  /// the one that another loop has on loan.
  explicit StealSignal(Handler handler) noexcept;
  ~StealSignal();
  StealSignal(const StealSignal&) = delete;
  StealSignal& operator=(const StealSignal&) = delete;

  bool available() const { return number_ != 0; }

  /// Interrupts a thread; false if the system has no room for another signal.
  /// Thread safety: any thread. A signal sent is handled before the loan ends, or not at all.
  bool send(pthread_t to, void* what) const noexcept;

  /// Lets the calling thread receive the signal until destruction.
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
  int number_ = 0;  // 0: none to be had
};

}  // namespace ductile::runtime
