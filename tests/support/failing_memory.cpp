/// @file
/// A library to be loaded before a program (LD_PRELOAD): makes the program's n-th request for
/// memory fail, once or from then on. The environment gives n, and a file for the number of
/// requests:
///   DUCTILE_FAIL_AT=n  DUCTILE_FAIL=once|on  DUCTILE_FAIL_COUNT=file
/// Requests, including those of forked children, are counted from the initialisation of libraries
/// on, which comes before main().
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// The C library's own names, for libraries that replace malloc.
extern "C" {
void* libc_malloc(std::size_t bytes) asm("__libc_malloc");
void* libc_calloc(std::size_t count, std::size_t bytes) asm("__libc_calloc");
void* libc_realloc(void* memory, std::size_t bytes) asm("__libc_realloc");
void* libc_memalign(std::size_t alignment, std::size_t bytes) asm("__libc_memalign");
}

namespace {

constinit std::atomic<long> own_requests{0};
constinit std::atomic<long>* requests = &own_requests;  // in memory that children share
constinit std::atomic<bool> counting{false};
long fails_at = 0;  // 0: never
bool fails_on = false;

bool fails() {
  if (!counting.load(std::memory_order_relaxed)) return false;
  const long number = requests->fetch_add(1, std::memory_order_relaxed) + 1;
  const bool now = fails_at > 0 && (fails_on ? number >= fails_at : number == fails_at);
  if (now) errno = ENOMEM;
  return now;
}

__attribute__((constructor)) void begin() {
  if (const char* at = std::getenv("DUCTILE_FAIL_AT")) fails_at = std::atol(at);
  if (const char* how = std::getenv("DUCTILE_FAIL")) fails_on = std::strcmp(how, "on") == 0;
  const long place = ::syscall(SYS_mmap, nullptr, sizeof *requests, PROT_READ | PROT_WRITE,
                               MAP_SHARED | MAP_ANONYMOUS, -1, 0L);
  if (place > 0) requests = reinterpret_cast<std::atomic<long>*>(place);
  counting = true;
}

__attribute__((destructor)) void end() {
  counting = false;
  const char* const name = std::getenv("DUCTILE_FAIL_COUNT");
  if (name == nullptr) return;
  const int file = ::open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file >= 0) {
    ::dprintf(file, "%ld\n", requests->load());
    ::close(file);
  }
}

}  // namespace

extern "C" {

void* malloc(std::size_t bytes) { return fails() ? nullptr : libc_malloc(bytes); }

void* calloc(std::size_t count, std::size_t bytes) {
  return fails() ? nullptr : libc_calloc(count, bytes);
}

void* realloc(void* memory, std::size_t bytes) {
  return fails() ? nullptr : libc_realloc(memory, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  return fails() ? nullptr : libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return memalign(alignment, bytes); }

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  if (fails()) return ENOMEM;
  *memory = libc_memalign(alignment, bytes);
  return *memory == nullptr ? ENOMEM : 0;
}

// NOLINTNEXTLINE(readability-function-size): the system's function has this many parameters.
void* mmap(void* place, std::size_t bytes, int protection, int flags, int file, off_t offset) {
  using Map = void* (*)(void*, std::size_t, int, int, int, off_t);
  static const Map map = reinterpret_cast<Map>(::dlsym(RTLD_NEXT, "mmap"));
  return fails() ? MAP_FAILED : map(place, bytes, protection, flags, file, offset);
}

int mprotect(void* place, std::size_t bytes, int protection) {
  using Protect = int (*)(void*, std::size_t, int);
  static const Protect protect = reinterpret_cast<Protect>(::dlsym(RTLD_NEXT, "mprotect"));
  return fails() ? -1 : protect(place, bytes, protection);
}

}  // extern "C"
