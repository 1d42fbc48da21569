/// @file
/// with_team: keeps the threads of an Executor together while a program runs one loop after the
/// other. Without it, each loop starts and joins OpenMP's threads, which takes microseconds; here
/// a thread that has done its part waits for the next loop, and a loop takes a message to each
/// thread and one back. Who runs short loops by the thousand, as adapt() does, gains most; so does
/// every program on a machine that others use too, see loops in parallel_for.hpp. Algorithms of the
/// runtime that run many loops, such as colour() and run_rounds(), form a team by themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

/// What with_team() calls, without its type.
using TeamBody = void (*)(void* context);

/// with_team() without types.
void run_with_team(const Executor& executor, TeamBody body, void* context);

/// Calls body() on the calling thread; all loops that it starts there with this executor, or a copy
/// of it, run on threads that stay together until body() is done. What loops do is the same as
/// without a team. Threads that wait for the next loop spin for 50 microseconds, in large teams for
/// up to 200, or not at all where there are more of them than cores, and then sleep. With a
/// placement they are bound, the calling one too, until body() is done. Meanwhile the thread is
/// within a parallel region of OpenMP's: loops of other executors, and parallel regions that body()
/// begins itself, run on it alone. What body() returns is returned, and what it throws reaches the
/// caller. Inside a loop or another team, or for one thread, body() is called and that is all.
/// Thread safety: any thread; each that calls it has a team of its own.
template <class Body>
auto with_team(const Executor& executor, Body&& body) {
  using Plain = std::remove_reference_t<Body>;
  using Result = std::decay_t<std::invoke_result_t<Plain&>>;
  if constexpr (std::is_void_v<Result>) {
    run_with_team(
        executor, [](void* context) { (*static_cast<Plain*>(context))(); },
        const_cast<std::remove_const_t<Plain>*>(&body));
  } else {
    std::optional<Result> result;
    with_team(executor, [&] { result.emplace(body()); });
    return *std::move(result);
  }
}

namespace detail {

/// with_team() for loops over so many items: few are done before a team has come together.
template <class Body>
auto with_team_for(std::size_t items, const Executor& executor, Body&& body) {
  constexpr std::size_t few = 256;
  return items < few ? body() : with_team(executor, body);
}

}  // namespace detail

}  // namespace ductile::runtime
