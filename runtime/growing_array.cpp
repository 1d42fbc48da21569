#include "ductile/runtime/growing_array.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "ductile/runtime/parallel_for.hpp"

// Sanitizers watch what malloc gives, not mappings.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DUCTILE_MOVES_PAGES 1
#include <sys/mman.h>
#include <unistd.h>
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#undef DUCTILE_MOVES_PAGES
#endif
#endif
#endif

namespace ductile::runtime::detail {

#ifdef DUCTILE_MOVES_PAGES

namespace {

std::size_t whole_pages(std::size_t bytes) {
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return (bytes + page - 1) / page * page;
}

}  // namespace

GrowingMemory::~GrowingMemory() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

void GrowingMemory::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  const std::size_t wanted = whole_pages(bytes);
  void* const place = data_ != nullptr ? mremap(data_, bytes_, wanted, MREMAP_MAYMOVE)
                                       : mmap(nullptr, wanted, PROT_READ | PROT_WRITE,
                                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(place);
  bytes_ = wanted;
}

void GrowingMemory::release(const Executor& executor) {
  const std::size_t part = whole_pages(std::size_t{1} << 18U), whole = bytes_ / part;
  // Unmapping what has no pages any more takes no time. If it could not be, this takes it.
  if (executor.threads() > 1)
    parallel_for(executor, whole,
                 [this, part](std::size_t i) { madvise(data_ + i * part, part, MADV_DONTNEED); });
  *this = GrowingMemory();
}

#else

GrowingMemory::~GrowingMemory() { std::free(data_); }

void GrowingMemory::release(const Executor&) { *this = GrowingMemory(); }

void GrowingMemory::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  auto* const place = static_cast<std::byte*>(std::realloc(data_, bytes));
  if (place == nullptr) throw std::bad_alloc();
  std::memset(place + bytes_, 0, bytes - bytes_);
  data_ = place;
  bytes_ = bytes;
}

#endif

}  // namespace ductile::runtime::detail
