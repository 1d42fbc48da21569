#include "ductile/runtime/arrays.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23
#endif
#endif

namespace ductile::runtime {

#ifdef __linux__

namespace {

std::size_t page_size() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

constexpr std::size_t most_at_once = 64;  // pages

/// Testing for residency costs more than it gains for few pages, which mostly are resident.
bool are_few_pages(std::size_t bytes) { return bytes < 256 * page_size(); }

std::size_t offset_in_page(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory) % page_size();
}

}  // namespace

void FreshMemory::add(void* memory, std::size_t bytes) {
  auto* const begin = static_cast<std::byte*>(memory);
  if (bytes >= page_size()) parts_.push_back({begin - offset_in_page(begin), bytes / page_size()});
}

void FreshMemory::touch(const Executor& executor) {
  constexpr std::size_t least = 8;
  std::size_t all = 0;
  for (const Pages& part : parts_) all += part.count;
  const auto threads = static_cast<std::size_t>(executor.threads());
  const std::size_t block = std::clamp(all / (2 * threads), least, most_at_once);
  std::vector<Pages> blocks;
  for (auto [begin, count] : std::exchange(parts_, {}))
    for (; count > 0; begin += blocks.back().count * page_size(), count -= blocks.back().count)
      blocks.push_back({begin, std::min(block, count)});
  parallel_for(
      executor, blocks.size(),
      [&](std::size_t i) { detail::get_pages(blocks[i].begin, blocks[i].count * page_size()); },
      {.grain = 1, .serial_below = 3});
}

namespace detail {

bool is_fresh(void* memory, std::size_t bytes) {
  if (are_few_pages(bytes)) return false;
  auto* const last = static_cast<std::byte*>(memory) + bytes - page_size();
  unsigned char is_resident = 1;
  return mincore(last - offset_in_page(last), 1, &is_resident) == 0 && (is_resident & 1U) == 0;
}

void get_pages(void* memory, std::size_t bytes) {
  auto* const begin = static_cast<std::byte*>(memory);
  const std::size_t before = offset_in_page(begin);
  madvise(begin - before, before + bytes, MADV_POPULATE_WRITE);
}

void touch_pages(const Executor& executor, void* memory, std::size_t bytes) {
  if (!is_fresh(memory, bytes)) return;
  auto* const first = static_cast<std::byte*>(memory);
  const auto get = [=](std::size_t, std::size_t begin, std::size_t end) {
    get_pages(first + begin, end - begin);
  };
  parallel_for_blocks(executor, bytes, most_at_once * page_size(), get);
}

}  // namespace detail

#else

void FreshMemory::add(void*, std::size_t) {}
void FreshMemory::touch(const Executor&) {}
namespace detail {
bool is_fresh(void*, std::size_t) { return false; }
void get_pages(void*, std::size_t) {}
void touch_pages(const Executor&, void*, std::size_t) {}
}  // namespace detail

#endif

}  // namespace ductile::runtime
