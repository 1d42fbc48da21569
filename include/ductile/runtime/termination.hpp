/// @file
/// What happens when a signal would end the process: SIGINT, SIGTERM, SIGHUP and the like, of those
/// whose action is the default one. HeldSignals lets them wait for what may not be left half done,
/// and a VanishingFile is removed before they end the process. Signals that a program handles or
/// ignores itself are left to it. Meanwhile the others have a handler of the runtime's, which goes
/// with the last of these objects.
#pragma once

#include <cstddef>

namespace ductile::runtime {

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
