/// @file
/// A library to be loaded before a program (LD_PRELOAD): sends the program a signal before its n-th
/// step of renaming files. The environment gives n and the signal:
///   DUCTILE_KILL_AT=n  DUCTILE_KILL_WITH=signal  DUCTILE_KILL_COUNT=file (the number of steps)
#include <dlfcn.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

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

}  // namespace

extern "C" {

/// New files beside places of outputs are opened exclusively.
std::FILE* fopen(const char* path, const char* mode) {
  if (std::strchr(mode, 'x') != nullptr) step();
  return next<std::FILE* (*)(const char*, const char*)>("fopen")(path, mode);
}

int rename(const char* from, const char* to) noexcept {
  step();
  return next<int (*)(const char*, const char*)>("rename")(from, to);
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

}  // extern "C"
