/// @file
/// What the runtime knows of its process: how much memory it holds and may hold, its own, whatever
/// its parent held before; and what happens when a signal would end it.
#pragma once

#include <cstddef>

namespace ductile::runtime {

/// Bytes that this process holds now; 0 where that is not told. Thread safety: any thread.
std::size_t held_memory();
/// The most bytes that this process has held so far; 0 where that is not told. Thread safety: any
/// thread.
std::size_t peak_memory();

/// Bytes that this process may hold: the machine's memory, what it swaps out included, or less
/// where cgroups or RLIMIT_DATA allow less; 0 where that is not told. Thread safety: any thread.
std::size_t most_memory();

// Of the signals that end a process (SIGINT, SIGTERM, SIGHUP and the like) those count whose action
// is the default one. Signals that a program handles or ignores itself are left to it. As long as
// there is one of these objects, the others have a handler of the runtime's.

/// While there is one, no such signal ends the process; those that came do when the last is gone.
/// Thread safety: any thread.
class HeldSignals {
 public:
  HeldSignals() noexcept;
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
};

/// A file that such a signal removes before it ends the process. Thread safety: any thread.
class VanishingFile {
 public:
  /// Which need not exist. Of more than 64 at a time, or without memory, some may stay.
  explicit VanishingFile(const char* name) noexcept;
  ~VanishingFile();
  VanishingFile(const VanishingFile&) = delete;
  VanishingFile& operator=(const VanishingFile&) = delete;

 private:
  std::size_t slot_;
};

}  // namespace ductile::runtime
