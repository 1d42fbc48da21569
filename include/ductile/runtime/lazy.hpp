/// @file
/// Lazy<T>: a value that is seldom needed, made when a thread first asks for it. Others that ask
/// meanwhile wait; from then on asking costs one load. What is made must not depend on who asks.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>

namespace ductile::runtime {

template <class T>
class Lazy {
 public:
  /// The value, made by `make()` unless that was done before. What `make` throws reaches the
  /// caller, and the next one to ask tries again. `make` must not ask for the value itself, nor run
  /// a loop on threads that may. Thread safety: any thread.
  template <class Make>
  const T& get(Make&& make) {
    if (!is_made()) {
      const std::scoped_lock lock(mutex_);
      if (!is_made()) {
        value_.emplace(make());
        made_.store(true, std::memory_order_release);  // pairs with is_made
      }
    }
    return *value_;
  }

  /// The value, or nullptr if nobody has asked yet. Thread safety: any thread.
  const T* made() const { return is_made() ? &*value_ : nullptr; }

 private:
  bool is_made() const { return made_.load(std::memory_order_acquire); }

  std::mutex mutex_;
  std::atomic<bool> made_ = false;
  std::optional<T> value_;
};

}  // namespace ductile::runtime
