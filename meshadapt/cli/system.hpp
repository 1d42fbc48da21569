/// @file
/// Requests of the program to the operating system.
#pragma once

#include <cstddef>

namespace ductile::cli {

/// Limits the memory of the process, including what it holds now: from here on, allocating more
/// throws std::bad_alloc. Addresses reserved for stacks of threads do not count.
void limit_memory(std::size_t bytes);

/// True if a person is likely to watch standard error.
bool stderr_is_terminal();

/// Makes the heap reuse freed memory instead of returning it to the system, because kernels
/// allocate and free the same arrays alternately. Up to four threads share one heap, which takes
/// least memory; more would wait for each other. Does nothing without glibc. Thread safety: no
/// other thread runs meanwhile.
void reuse_memory(int threads);

}  // namespace ductile::cli
