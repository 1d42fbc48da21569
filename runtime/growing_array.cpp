#include "ductile/runtime/growing_array.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"

// Sanitizers check malloc's memory, not mappings.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DUCTILE_MOVES_PAGES 1
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#undef DUCTILE_MOVES_PAGES
#endif
#endif
#endif

namespace ductile::runtime {
namespace detail {

void GrowingMemory::reserve_from_malloc(std::size_t bytes) {
  auto* const place = static_cast<std::byte*>(std::realloc(data_, bytes));
  if (place == nullptr) throw std::bad_alloc();
  std::memset(place + bytes_, 0, bytes - bytes_);
  data_ = place;
  bytes_ = bytes;
}

#ifdef DUCTILE_MOVES_PAGES

namespace {

/// Below this size malloc is used. Unmapping pages interrupts all threads, which for few pages
/// takes longer than their use: up to 2 ms on a virtual machine whose host defers it until spinning
/// threads call it.
constexpr std::size_t small = std::size_t{1} << 16U;

std::size_t whole_pages(std::size_t bytes) {
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return (bytes + page - 1) / page * page;
}

/// Reserves addresses generously, which costs nothing unless the user has limited them.
std::size_t with_room_to_grow(std::size_t bytes) {
  constexpr std::size_t times = 32, most = std::numeric_limits<std::size_t>::max();
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
  return limited || bytes > most / times ? bytes : times * bytes;
}

/// Reserved addresses without access; null if there are none.
std::byte* map_space(std::size_t bytes) {
  void* const place =
      mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return place == MAP_FAILED ? nullptr : static_cast<std::byte*>(place);
}

}  // namespace

GrowingMemory::~GrowingMemory() {
  if (is_mapped()) {
    munmap(data_, space_);
  } else {
    std::free(data_);
  }
}

void GrowingMemory::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  if (is_mapped()) return reserve_pages(bytes);
  if (bytes <= small) return reserve_from_malloc(std::clamp(2 * bytes_, bytes, small));
  GrowingMemory mapped;
  mapped.reserve_pages(bytes);
  get_pages(mapped.data_, bytes_);  // at once, because only one thread writes them
  std::copy_n(data_, bytes_, mapped.data_);
  swap(mapped);
}

void GrowingMemory::reserve_pages(std::size_t bytes) {
  const std::size_t wanted = whole_pages(bytes);
  if (wanted > space_) move_to_larger_space(wanted);
  const auto may_write = [&](std::size_t end) {
    return mprotect(data_ + bytes_, end - bytes_, PROT_READ | PROT_WRITE) == 0;
  };
  // In few steps, because each takes some microseconds; but not far, because programs may lock all
  // their writable memory.
  std::size_t end = std::min(4 * wanted, space_);
  if (!may_write(end) && !may_write(end = wanted)) throw std::bad_alloc();
  bytes_ = end;
}

/// Should be rare, because pages are moved one by one.
void GrowingMemory::move_to_larger_space(std::size_t wanted) {
  std::size_t space = with_room_to_grow(wanted);
  std::byte* place = map_space(space);
  if (place == nullptr) place = map_space(space = wanted);
  if (place == nullptr) throw std::bad_alloc();
  std::size_t gone = bytes_;  // bytes moved away from the old place
  if (bytes_ > 0 &&
      mremap(data_, bytes_, bytes_, MREMAP_MAYMOVE | MREMAP_FIXED, place) == MAP_FAILED) {
    // Linux before 6.17 refuses if the pages belong to several mappings, as after the first move.
    gone = 0;
    if (mprotect(place, bytes_, PROT_READ | PROT_WRITE) != 0) {
      munmap(place, space);
      throw std::bad_alloc();
    }
    std::copy_n(data_, bytes_, place);
  }
  if (space_ > gone) munmap(data_ + gone, space_ - gone);
  data_ = place;
  space_ = space;
}

void GrowingMemory::add_pages(std::size_t bytes, FreshMemory& fresh) {
  constexpr std::size_t ahead = std::size_t{1} << 13U;  // for arrays that grow in small steps
  if (bytes <= added_ || !is_mapped()) return;
  const std::size_t end = std::min(bytes_, whole_pages(bytes + ahead));
  fresh.add(data_ + added_, end - added_);
  added_ = end;
}

#else

GrowingMemory::~GrowingMemory() { std::free(data_); }

void GrowingMemory::add_pages(std::size_t, FreshMemory&) {}

void GrowingMemory::reserve(std::size_t bytes) {
  if (bytes > bytes_) reserve_from_malloc(bytes);
}

#endif

}  // namespace detail

#ifdef DUCTILE_MOVES_PAGES

void SpentMemory::give_back(const Executor& executor) {
  constexpr std::size_t least = std::size_t{1} << 18U;
  const auto threads = static_cast<std::size_t>(executor.threads());
  std::size_t all = 0;
  for (const Part& part : parts_) all += part.memory.is_mapped() ? part.used : 0;
  // In large parts, because each interrupts all threads; the largest first.
  const std::size_t most = detail::whole_pages(std::max(all / threads, least));
  std::vector<std::span<std::byte>> parts;
  for (const auto& [memory, used] : parts_)
    for (std::size_t at = 0; memory.is_mapped() && at < used; at += most)
      parts.emplace_back(memory.data() + at, std::min(most, used - at));
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  const auto give_back = [&](std::size_t i) {
    madvise(parts[i].data(), parts[i].size(), MADV_DONTNEED);
  };
  // Unmapping is fast without pages; otherwise it frees them here.
  if (all > most) parallel_for(executor, parts.size(), give_back, {.grain = 1});
  parts_.clear();
}

#else

void SpentMemory::give_back(const Executor&) { parts_.clear(); }

#endif

}  // namespace ductile::runtime
