/// @file
/// Distance between two threads: the time for a cache line to go from one to the other and back.
/// Virtual machines move their cores: the two may be hyperthreads of one core at one time and far
/// apart at another, so figures on two threads mean nothing without it. In a header, because the
/// two threads must belong to the OpenMP runtime of the program: others would share their cores
/// with its waiting threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace ductile::bench {

/// A ball that two threads throw to each other, in batches; keeps the time of the fastest batch.
class PingPong {
 public:
  /// Throws and catches, one thread with each side; they return together, after a few milliseconds
  /// if something holds one of them up. Thread safety: one thread a side.
  void play(int side) {
    for (int batch = 0; batch < batches && !late_.load(std::memory_order_relaxed); ++batch) {
      const auto start = std::chrono::steady_clock::now();
      for (int i = 0; i < throws; ++i) {
        const int now = 2 * (batch * throws + i) + side;
        if (!await(now)) return;
        ball_.store(now + 1, std::memory_order_release);  // pairs with the acquire in await
      }
      const std::chrono::duration<double, std::nano> taken =
          std::chrono::steady_clock::now() - start;
      if (side == 0) best_ns_ = std::min(best_ns_, taken.count() / throws);
    }
  }

  /// Nanoseconds there and back; 0 if no batch was completed. Thread safety: after both returned.
  double round_trip_ns() const { return best_ns_ < never ? best_ns_ : 0; }

 private:
  static constexpr int batches = 10;
  static constexpr int throws = 100;
  static constexpr double never = 1e30;

  bool await(int value) {
    for (unsigned spins = 1; ball_.load(std::memory_order_acquire) != value; ++spins) {
      if (spins % 1024 == 0 && std::chrono::steady_clock::now() > deadline_)
        late_.store(true, std::memory_order_relaxed);  // only ends the game early
      if (late_.load(std::memory_order_relaxed)) return false;
    }
    return true;
  }

  alignas(128) std::atomic<int> ball_{0};
  alignas(128) std::atomic<bool> late_{false};
  std::chrono::steady_clock::time_point deadline_ =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(20);
  double best_ns_ = never;  // of side 0's batches
};

/// Nanoseconds of a round trip between two threads, 0 if they did not run at once.
inline double ping_pong_ns() {
  PingPong game;
#ifdef _OPENMP
  int side = 0;
#pragma omp parallel num_threads(2)
  {
    int mine = 0;
#pragma omp atomic capture
    mine = side++;
    game.play(mine);
  }
#else
  std::thread other([&] { game.play(1); });
  game.play(0);
  other.join();
#endif
  return game.round_trip_ns();
}

}  // namespace ductile::bench
