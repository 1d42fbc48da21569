/// @file
/// threads_to_be_had: how many threads OpenMP may be asked for (private to the runtime). Its
/// libraries end the process where a thread or memory for it cannot be had, and wait for ever in a
/// forked child for threads that only the parent has. Results do not depend on the number.
#pragma once

namespace ductile::runtime {

/// The number wanted, or 1: then the caller runs alone, without a parallel region. Threads that the
/// calling thread did not have in its last region are tried out first; another process may take
/// the last one meanwhile. Throws std::bad_alloc.
int threads_to_be_had(int wanted);

/// Whether a region of so many threads is to be begun: of one only to be apart from a region that
/// the calling thread is within.
bool takes_a_region(int threads) noexcept;

}  // namespace ductile::runtime
