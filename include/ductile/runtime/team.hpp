/// @file
/// with_team: keeps the threads of an Executor together while a program runs one loop after the
/// other. Without it, each loop starts and joins OpenMP's threads, which takes microseconds; here
/// a thread that has done its part waits for the next loop, and a loop takes a message to each
/// thread and one back. Who runs short loops by the thousand, as adapt() does, gains most.
#pragma once

#include <type_traits>

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
/// begins itself, run on it alone. What body() throws reaches the caller. Inside a loop or another
/// team, for one thread, or while loops are recorded, body() is called and that is all. Thread
/// safety: any thread; each that calls it has a team of its own.
template <class Body>
void with_team(const Executor& executor, Body&& body) {
  using Plain = std::remove_reference_t<Body>;
  run_with_team(
      executor, [](void* context) { (*static_cast<Plain*>(context))(); },
      const_cast<std::remove_const_t<Plain>*>(&body));
}

}  // namespace ductile::runtime
