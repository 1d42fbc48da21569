/// @file
/// FreshMemory: has the system give pages of memory many at a time, by all threads. Otherwise it
/// gives them one by one as they are first written, with an interrupt of the program for each: 1.4
/// us on one virtual machine, 11 on another, where a page among many takes 0.65.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

class FreshMemory {
 public:
  /// All of this memory, which is valid until touch(), is about to be written. As many pages as it
  /// could fill are asked for, from the one on that it begins in. What they hold stays. Throws
  /// std::bad_alloc.
  void add(void* memory, std::size_t bytes);

  /// Gets the pages of all that was added. Where the system cannot do that, which is not Linux or
  /// before 5.14, they come as they are written. Thread safety: one caller; runs on the executor.
  void touch(const Executor& executor);

 private:
  struct Pages {
    std::byte* begin;
    std::size_t count;
  };
  std::vector<Pages> parts_;
};

/// Whether memory that malloc or new gave, which often has had it before, is worth touching: there
/// is some of it, and its last page is not there. Thread safety: any thread.
bool is_fresh(void* memory, std::size_t bytes);

/// Gets pages as FreshMemory does, for the thread that is about to write them.
/// Thread safety: any thread.
void get_pages(void* memory, std::size_t bytes);

/// Gets the pages of memory if it is fresh. Thread safety: as FreshMemory::touch().
void touch_pages(const Executor& executor, void* memory, std::size_t bytes);

/// Calls write(begin, end) with parts of the n elements at `first`, each on the thread that gets
/// its pages before, if the elements are fresh. Thread safety: as FreshMemory::touch().
template <class T, class Write>
void write_first(const Executor& executor, T* first, std::size_t n, Write&& write,
                 const LoopOptions& options) {
  const bool fresh = is_fresh(first, n * sizeof(T));
  parallel_for_ranges(
      executor, n,
      [&](std::size_t begin, std::size_t end) {
        if (fresh) get_pages(first + begin, (end - begin) * sizeof(T));
        write(first + begin, first + end);
      },
      options);
}

/// n elements that may hold anything and are all about to be set. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
std::unique_ptr<T[]> make_unset(const Executor& executor, std::size_t n) {
  auto elements = std::make_unique_for_overwrite<T[]>(n);
  touch_pages(executor, elements.get(), n * sizeof(T));
  return elements;
}

}  // namespace ductile::runtime
