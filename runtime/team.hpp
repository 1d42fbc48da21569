/// @file
/// Team: threads that wait for the loops of one thread, the leader (private to the runtime). Work
/// is passed on along a tree: each thread calls four others, and has done its part when they have,
/// too. So a message takes as many steps as the tree is high, and no thread writes to many.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

class Team {
 public:
  /// What a loop does on each thread, without its type.
  using Work = void (*)(void* context, int thread);

  explicit Team(const Executor& executor);

  /// The calling thread's, if it leads one for such an executor and runs no loop; null otherwise.
  static Team* of(const Executor& executor) noexcept;

  /// Makes this the calling thread's team until destruction.
  class Leading {
   public:
    /// The team has `size` threads, of which OpenMP may give fewer than the executor has.
    Leading(Team& team, int size) noexcept;
    ~Leading();  // sends the other threads home
    Leading(const Leading&) = delete;
    Leading& operator=(const Leading&) = delete;

   private:
    Team& team_;
  };

  /// Leader only: calls work(thread) on each thread, and returns when all are done.
  template <class Function>
  void run(Function& function) {
    run([](void* context, int thread) { (*static_cast<Function*>(context))(thread); }, &function);
  }

  /// On each other thread: does what comes until it is sent home.
  void serve(int thread);

 private:
  /// One thread's mailbox. Its caller writes `called`, it writes `done`; each counts loops.
  struct Seat {
    alignas(128) std::atomic<std::uint32_t> called{0};
    Work work = nullptr;
    void* context = nullptr;
    alignas(128) std::atomic<std::uint32_t> done{0};
  };

  void run(Work work, void* context);
  void call(std::size_t caller, std::uint32_t loop, Work work, void* context);
  void await(std::size_t caller, std::uint32_t loop);
  void wait_until(const std::atomic<std::uint32_t>& counter, std::uint32_t loop) const;

  const Executor& executor_;
  const int spins_;
  const std::unique_ptr<Seat[]> seats_;
  std::size_t size_ = 0;  // written before the first call
  std::uint32_t loops_ = 0;
};

}  // namespace ductile::runtime
