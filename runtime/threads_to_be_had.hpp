/// @file
/// threads_to_be_had: how many threads OpenMP can safely be asked for (private to the runtime). Its
/// libraries end the process if a thread or its memory is unavailable, and wait for ever in a
/// forked child for threads that only the parent has. Results do not depend on the number.
#pragma once

namespace ductile::runtime {

/// The number wanted, or 1: the caller then runs alone, without a parallel region. Threads that the
/// calling thread did not have in its last region are tried first; another process may still take
/// the last one meanwhile. Throws std::bad_alloc.
int threads_to_be_had(int wanted);

/// Should a region of so many threads be started? A region of one is needed only to separate it
/// from an enclosing region.
bool takes_a_region(int threads) noexcept;

}  // namespace ductile::runtime
