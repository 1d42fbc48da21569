/// @file
/// A library to be loaded before a program (LD_PRELOAD): sends the program a signal before its n-th
/// step of renaming files. The environment gives n and the signal:
///   DUCTILE_KILL_AT=n  DUCTILE_KILL_WITH=signal  DUCTILE_KILL_COUNT=file (the number of steps)
///   DUCTILE_NAMED=1: as if the file system had no files without names
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace {

long steps = 0;

void step() {
  ++steps;
  const char* const at = std::getenv("DUCTILE_KILL_AT");
  if (at != nullptr && std::atol(at) == steps)
    ::kill(::getpid(), std::atoi(std::getenv("DUCTILE_KILL_WITH")));
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

__attribute__((destructor)) void end() {
  const char* const name = std::getenv("DUCTILE_KILL_COUNT");
  if (name == nullptr) return;
  if (std::FILE* const file = std::fopen(name, "w")) {
    std::fprintf(file, "%ld\n", steps);
    std::fclose(file);
  }
}

int open_with(const char* system, const char* path, int flags, unsigned mode) {
  if ((flags & O_TMPFILE) == O_TMPFILE && std::getenv("DUCTILE_NAMED") != nullptr)
    return errno = EOPNOTSUPP, -1;
  return next<int (*)(const char*, int, ...)>(system)(path, flags, mode);
}

}  // namespace

extern "C" {

int rename(const char* from, const char* to) noexcept {
  step();
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int link(const char* from, const char* to) noexcept {
  step();
  return next<int (*)(const char*, const char*)>("link")(from, to);
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  step();
  return next<int (*)(int, const char*, int, const char*, int)>("linkat")(from_folder, from,
                                                                          to_folder, to, flags);
}

int unlink(const char* path) noexcept {
  step();
  return next<int (*)(const char*)>("unlink")(path);
}

int remove(const char* path) noexcept {
  step();
  return next<int (*)(const char*)>("remove")(path);
}

int fsync(int file) {
  step();
  return next<int (*)(int)>("fsync")(file);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const unsigned mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, unsigned) : 0;
  va_end(rest);
  return open_with("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const unsigned mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, unsigned) : 0;
  va_end(rest);
  return open_with("open64", path, flags, mode);
}

}  // extern "C"
