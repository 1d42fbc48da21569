/// @file
/// Team: threads that wait for the loops of one thread, the leader (private to the runtime). Work
/// is passed along a tree: each thread calls four others and waits for them after its own share, so
/// a message takes as many steps as the tree has levels, and no thread writes to many. Nobody waits
/// for a thread that has not begun: it may be asleep or have no core, which takes longer than most
/// loops. Its call is taken back once the others have done its share.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

/// The threads that a loop runs on: those that begin before its work is done, or all of them.
enum class Turnout : std::uint8_t { whoever_comes, everyone };

class Team {
 public:
  /// A loop's type-erased work, called with the number of the thread.
  struct Task {
    void (*work)(void* context, int thread) = nullptr;  // null: the thread ends its service
    void* context = nullptr;
    Turnout turnout = Turnout::everyone;
    /// Runs on this many threads of the team, or on all if there are fewer.
    std::uint32_t threads = ~std::uint32_t{0};
  };

  explicit Team(const Executor& executor);

  /// The calling thread's team if it leads one for such an executor; null otherwise.
  static Team* of(const Executor& executor) noexcept;

  /// Makes this the calling thread's team during its lifetime.
  class Leading {
   public:
    /// The team has `size` threads, of which OpenMP may give fewer than the executor has.
    Leading(Team& team, int size) noexcept;
    ~Leading();  // dismisses the other threads
    Leading(const Leading&) = delete;
    Leading& operator=(const Leading&) = delete;

   private:
    Team& team_;
  };

  /// Leader only: runs the task on the calling thread and the others; returns when all are done.
  void run(const Task& task);

  /// Called on each other thread: runs tasks until it is dismissed.
  void serve(int thread);

 private:
  enum class State : std::uint32_t { idle, asleep, called, busy, awaited };

  /// One thread's state, and the slot where its caller leaves a task.
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
  std::size_t size_ = 0;  // set before the first call
};

}  // namespace ductile::runtime
