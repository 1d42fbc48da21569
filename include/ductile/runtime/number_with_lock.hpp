/// @file
/// NumberWithLock: a lock for each of many small things, such as the neighbours of a vertex, that
/// takes no memory but a bit of a number which the thing has anyway.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace ductile::runtime {

/// A number below 2^31 that a lock lies beside. Who waits for it spins, so it is for what takes no
/// longer than some hundred instructions. Thread safety: hold() any thread; get() and set() whoever
/// holds it, or one thread if no other does anything with it.
class NumberWithLock {
 public:
  /// Keeps others that hold the same from going on, as long as it lives.
  class Held {
   public:
    explicit Held(std::uint32_t& word) : word_(word) {
      constexpr int spins = 1000;  // then whoever holds it may have lost its core
      // Acquire pairs with the release of whoever held it before.
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

  // Relaxed, and not plain, as others may try to hold it meanwhile, and so write what they find.

  std::uint32_t get() { return std::atomic_ref(word_).load(std::memory_order_relaxed) & ~held; }
  void set(std::uint32_t number) {
    const std::atomic_ref word(word_);
    word.store(number | (word.load(std::memory_order_relaxed) & held), std::memory_order_relaxed);
  }

 private:
  static constexpr std::uint32_t held = 1U << 31U;
  std::uint32_t word_ = 0;
};

}  // namespace ductile::runtime
