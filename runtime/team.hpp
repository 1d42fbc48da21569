/// @file
/// Team: threads that wait for the loops of one thread, the leader (private to the runtime). Work
/// is passed on along a tree: each thread calls four others and waits for them when it is done
/// itself, so a message takes as many steps as the tree is high, and no thread writes to many.
/// Nobody waits for a thread that has not begun: it may sleep, or have no core to run on, which
/// takes longer than most loops. Its call is taken back, once the others have done its share.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

/// Which threads a loop runs on: those that begin before its work is done, or each of them.
enum class Turnout : std::uint8_t { whoever_comes, everyone };

class Team {
 public:
  /// A loop's work, without its type, called with the number of the thread.
  struct Task {
    void (*work)(void* context, int thread) = nullptr;  // null: the thread is to go home
    void* context = nullptr;
    Turnout turnout = Turnout::everyone;
    /// It runs on the first so many of the team, or on all if there are fewer.
    std::uint32_t threads = ~std::uint32_t{0};
  };

  explicit Team(const Executor& executor);

  /// The calling thread's, if it leads one for such an executor; null otherwise.
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

  /// Leader only: runs the task on the calling thread and the others; returns when all are done.
  void run(const Task& task);

  /// On each other thread: does what comes until it is sent home.
  void serve(int thread);

 private:
  enum class State : std::uint32_t { idle, asleep, called, busy, awaited };

  /// One thread's, and where its caller leaves a task for it.
  struct alignas(128) Seat {
    std::atomic<State> state{State::idle};
    Task task;
  };

  std::span<Seat> called_by(std::size_t caller, const Task& task) const;
  void call(std::size_t caller, const Task& task);
  void join(std::size_t caller, const Task& task);
  void join_one(Seat& seat, const Task& task) const;
  void take_call(Seat& seat) const;

  const Executor& executor_;
  const std::chrono::nanoseconds spin_;
  const std::unique_ptr<Seat[]> seats_;
  std::size_t size_ = 0;  // written before the first call
};

}  // namespace ductile::runtime
