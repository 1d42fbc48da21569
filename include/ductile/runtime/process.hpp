/// @file
/// Facts about this process: how much memory it holds and may hold (not counting its parent's), and
/// what happens when a signal would end it.
#pragma once

#include <cstddef>

namespace ductile::runtime {

/// Bytes that this process holds now; 0 if unknown. Thread safety: any thread.
std::size_t held_memory();
/// The most bytes that this process has held so far; 0 if unknown. Thread safety: any thread.
std::size_t peak_memory();

/// Bytes that this process may hold: the machine's memory plus swap, or less if cgroups or
/// RLIMIT_DATA allow less; 0 if unknown. Thread safety: any thread.
std::size_t most_memory();

// These classes handle signals that end a process (SIGINT, SIGTERM, SIGHUP and the like) if their
// action is the default. Signals that a program handles or ignores itself are left alone. The
// runtime's handler is installed while any of these objects exists.

/// Delays such signals during its lifetime; they take effect when the last object is gone.
/// Thread safety: any thread.
class HeldSignals {
 public:
  HeldSignals() noexcept;
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
};

/// A file that is removed if such a signal ends the process. Thread safety: any thread.
class VanishingFile {
 public:
  /// The file need not exist. Beyond 64 files at a time, or without memory, some may stay.
  explicit VanishingFile(const char* name) noexcept;
  ~VanishingFile();
  VanishingFile(const VanishingFile&) = delete;
  VanishingFile& operator=(const VanishingFile&) = delete;

 private:
  std::size_t slot_;
};

}  // namespace ductile::runtime
