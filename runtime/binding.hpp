/// @file
/// Binding of an executor's threads to processing units (private to the runtime). It lasts for a
/// loop: a thread is bound when it enters a team and gets back its previous mask when it leaves, so
/// nothing leaks to the caller, to OpenMP's threads, or beyond the life of an Executor.
#pragma once

#include <memory>
#include <vector>

#include "ductile/runtime/executor.hpp"

namespace ductile::runtime::detail {

/// The processing units for threads 0, 1, 2, ..., or null if threads are not to be bound or the
/// topology is hidden. Units are reused if there are more threads. Throws std::bad_alloc only.
std::shared_ptr<const Places> make_places(Placement placement);

/// The operating system's numbers of these units.
std::vector<unsigned> processors(const Places& places);

/// Binds the calling thread until destruction; does nothing if the system refuses.
class ScopedBinding {
 public:
  ScopedBinding(const Places* places, int thread) noexcept {
    if (places != nullptr) [[unlikely]]
      bind(*places, thread);
  }
  ~ScopedBinding() {
    if (before_ != nullptr) [[unlikely]]
      restore();
  }
  ScopedBinding(const ScopedBinding&) = delete;
  ScopedBinding& operator=(const ScopedBinding&) = delete;

 private:
  void bind(const Places& places, int thread) noexcept;
  void restore() noexcept;

  const Places* places_ = nullptr;
  void* before_ = nullptr;  // the previous mask, null if not bound
};

}  // namespace ductile::runtime::detail
