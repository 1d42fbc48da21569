/// @file
/// FilledArray: an array that grows, with one value in what is new. Unlike a vector's, its memory
/// is first touched by the threads that fill it, so it takes no time on one thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/fresh_memory.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Thread safety: elements as those of an array; what changes the size, one thread.
template <class T>
requires std::is_trivially_copyable_v<T>
class FilledArray {
 public:
  FilledArray() = default;
  /// n elements that hold `value`. Throws std::bad_alloc.
  FilledArray(const Executor& executor, std::size_t n, T value = {}) { resize(executor, n, value); }
  FilledArray(FilledArray&& other) noexcept { swap(other); }
  FilledArray& operator=(FilledArray&& other) noexcept {
    FilledArray(std::move(other)).swap(*this);
    return *this;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

  /// Grows to n elements, if there are fewer: what is new holds `value`. Throws std::bad_alloc.
  void resize(const Executor& executor, std::size_t n, T value) {
    if (n <= size_) return;
    if (n > capacity_) move_to(executor, std::max(n, capacity_ + capacity_ / 2));
    const auto fill = [value](T* begin, T* end) { std::fill(begin, end, value); };
    write_first(executor, values_.get() + size_, n - size_, fill, by_pages);
    size_ = n;
  }

  /// Forgets all elements and keeps the memory.
  void clear() { size_ = 0; }

 private:
  static constexpr std::size_t pages = std::max<std::size_t>(1, 32768 / sizeof(T));
  static constexpr LoopOptions by_pages{.grain = pages, .serial_below = 4 * pages};

  void swap(FilledArray& other) {
    std::swap(values_, other.values_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  void move_to(const Executor& executor, std::size_t capacity) {
    auto larger = std::make_unique_for_overwrite<T[]>(capacity);
    parallel_for_ranges(
        executor, size_,
        [&](std::size_t begin, std::size_t end) {
          std::copy(values_.get() + begin, values_.get() + end, larger.get() + begin);
        },
        by_pages);
    values_ = std::move(larger);
    capacity_ = capacity;
  }

  std::unique_ptr<T[]> values_;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace ductile::runtime
