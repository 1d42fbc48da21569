/// @file
/// Atomic operations on ordinary data shared by threads: count, mark, lower to a minimum,
/// lock a word, make a value once. Within one phase of a loop, a word is accessed through
/// these functions only.
#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>

namespace ductile::runtime {

// Counts, marks and minima use relaxed order: between two barriers only the words themselves carry
// information. The barrier at the end of the loop, which every reader of the result has passed,
// orders all other writes.

/// Adds n and returns the value before. Thread safety: any thread.
inline std::uint32_t atomic_count(std::uint32_t& where, std::uint32_t n = 1) {
  return std::atomic_ref(where).fetch_add(n, std::memory_order_relaxed);
}

/// Sets the flag to 1. A flag that is set already is not written, so its cache line stays shared.
/// Thread safety: any thread.
inline void atomic_mark(std::uint8_t& flag) {
  const std::atomic_ref word(flag);
  if (word.load(std::memory_order_relaxed) == 0) word.store(1, std::memory_order_relaxed);
}

/// Is the flag set, as far as this thread can see? Thread safety: any thread.
inline bool atomic_is_marked(std::uint8_t& flag) {
  return std::atomic_ref(flag).load(std::memory_order_relaxed) != 0;
}

/// Sets a flag without reading it first; faster if few threads set flags in a random pattern near
/// each other. Thread safety: any thread.
inline void atomic_set(std::uint8_t& flag) {
  std::atomic_ref(flag).store(1, std::memory_order_relaxed);
}

/// Lowers the word to `value` if that is less; true if it did. Another thread may lower it further
/// afterwards. With a priority in the word, operations reserve resources this way: the lowest
/// priority remains, whatever the timing. Thread safety: any thread.
template <std::unsigned_integral Word>
bool atomic_min(Word& where, std::type_identity_t<Word> value) {
  const std::atomic_ref word(where);
  Word seen = word.load(std::memory_order_relaxed);
  while (value < seen) {
    if (word.compare_exchange_weak(seen, value, std::memory_order_relaxed)) return true;
  }
  return false;
}

/// A number below 2^31 with a lock in its free bit, for many small objects such as the neighbour
/// lists of vertices. A waiting thread spins, so hold the lock for at most some hundred
/// instructions. Thread safety: hold() any thread; get() and set() the holder, or one thread if no
/// other accesses the word.
class NumberWithLock {
 public:
  /// Holds the lock for its lifetime.
  class Held {
   public:
    explicit Held(std::uint32_t& word) : word_(word) {
      constexpr int spins = 1000;  // after these the holder has probably lost its core
      // Acquire pairs with the release by the previous holder.
      for (int tries = 0; (word_.fetch_or(held, std::memory_order_acquire) & held) != 0;
           tries += tries < spins)
        if (tries == spins) std::this_thread::yield();
    }
    ~Held() { word_.fetch_and(~held, std::memory_order_release); }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

   private:
    std::atomic_ref<std::uint32_t> word_;
  };

  [[nodiscard]] Held hold() { return Held(word_); }

  // Relaxed rather than plain, because other threads may try to lock meanwhile and so write the
  // word.

  std::uint32_t get() { return std::atomic_ref(word_).load(std::memory_order_relaxed) & ~held; }
  void set(std::uint32_t number) {
    const std::atomic_ref word(word_);
    word.store(number | (word.load(std::memory_order_relaxed) & held), std::memory_order_relaxed);
  }

 private:
  static constexpr std::uint32_t held = 1U << 31U;
  std::uint32_t word_ = 0;
};

/// A value that is seldom needed, made when a thread first asks for it. Others that ask meanwhile
/// wait; from then on asking costs one load. What is made must not depend on the thread that asks.
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
