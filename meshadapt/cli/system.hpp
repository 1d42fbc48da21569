/// @file
/// What the program asks of the operating system.
#pragma once

#include <cstddef>

namespace ductile::cli {

/// From here on, taking more memory than this, what the process holds now included, fails, with
/// std::bad_alloc. Addresses that threads hold for their stacks are not taken for memory.
void limit_memory(std::size_t bytes);

/// Whether a person is likely to watch standard error.
bool stderr_is_terminal();

/// What is freed is used again rather than given back and asked for anew: kernels take and free the
/// same arrays in turns. Few threads share one heap, which takes least memory; more would wait for
/// each other there. With glibc; otherwise nothing. Thread safety: no other thread runs meanwhile.
void reuse_memory(int threads);

}  // namespace ductile::cli
