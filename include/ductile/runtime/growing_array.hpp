/// @file
/// GrowingArray: an array for graphs that grow while they are worked on. Unless it is small its
/// memory comes in pages straight from the system: where that can do so (Linux) growing takes
/// addresses that were held free behind it, or moves page table entries, and copies nothing, and
/// what is new is first touched, and so placed near, by whoever writes it, unless a FreshMemory has
/// asked for it before.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::runtime {

namespace detail {

/// Bytes that are zero until they are written. Throws std::bad_alloc. Thread safety: one thread.
class GrowingMemory {
 public:
  GrowingMemory() = default;
  GrowingMemory(GrowingMemory&& other) noexcept { swap(other); }
  GrowingMemory& operator=(GrowingMemory&& other) noexcept {
    swap(other);
    return *this;
  }
  GrowingMemory(const GrowingMemory&) = delete;
  GrowingMemory& operator=(const GrowingMemory&) = delete;
  ~GrowingMemory();

  std::byte* data() const { return data_; }
  std::size_t bytes() const { return bytes_; }

  /// Makes room for at least so many bytes. Contents stay, but may move.
  void reserve(std::size_t bytes);

  /// Adds the pages of the first so many bytes, save those added before, and a few more.
  void add_pages(std::size_t bytes, FreshMemory& fresh);

  /// Whether pages come straight from the system.
  bool is_mapped() const { return space_ != 0; }

 private:
  void swap(GrowingMemory& other) {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    std::swap(space_, other.space_);
    std::swap(added_, other.added_);
  }
  void reserve_from_malloc(std::size_t bytes);
  void reserve_pages(std::size_t bytes);
  void move_to_larger_space(std::size_t wanted);

  std::byte* data_ = nullptr;
  std::size_t bytes_ = 0;  // that may be written
  std::size_t space_ = 0;  // of addresses held, at least as many; none where malloc gave it
  std::size_t added_ = 0;  // of which pages have been asked for
};

}  // namespace detail

template <class T>
requires(std::is_trivially_copyable_v<T> &&
         alignof(T) <= alignof(std::max_align_t)) class GrowingArray;

/// Memory that arrays no longer want. The system takes it page by page: by all threads of an
/// executor and in one loop for all arrays, where one thread alone would hold up the others.
class SpentMemory {
 public:
  /// Gives all of it back, which the destructor does on its own thread. Thread safety: one caller;
  /// runs on the executor.
  void give_back(const Executor& executor);

 private:
  template <class T>
  requires(std::is_trivially_copyable_v<T> &&
           alignof(T) <= alignof(std::max_align_t)) friend class GrowingArray;

  struct Part {
    detail::GrowingMemory memory;
    std::size_t used;  // bytes, the first ones
  };
  std::vector<Part> parts_;
};

/// Thread safety: elements as those of an array; what changes the size, one thread.
template <class T>
requires(std::is_trivially_copyable_v<T> &&
         alignof(T) <= alignof(std::max_align_t)) class GrowingArray {
 public:
  GrowingArray() = default;
  GrowingArray(GrowingArray&& other) noexcept
      : memory_(std::move(other.memory_)),
        size_(std::exchange(other.size_, 0)),
        touched_(std::exchange(other.touched_, 0)) {}
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    std::swap(touched_, other.touched_);
    return *this;
  }

  std::size_t size() const { return size_; }
  T* data() { return reinterpret_cast<T*>(memory_.data()); }
  const T* data() const { return reinterpret_cast<const T*>(memory_.data()); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }

  /// Shrinks, which gives no memory back, or grows: what is new is as if made of zero bytes.
  /// Pointers into the array are valid until it grows. Throws std::bad_alloc, and is as before
  /// then.
  void resize(std::size_t n) {
    const std::size_t before = size_;
    resize_for_overwrite(n);
    if (n > before)  // what was there before it shrank
      std::fill(reinterpret_cast<std::byte*>(data() + before),
                reinterpret_cast<std::byte*>(data() + std::max(before, std::min(n, touched_))),
                std::byte{0});
  }

  /// The same, but that there may be n elements if it throws; pages for what is new are added to
  /// `fresh`: for elements that are read before most are written. A page that is first read is
  /// there twice, and every thread is interrupted where one then writes it.
  void resize(std::size_t n, FreshMemory& fresh) {
    resize(n);
    memory_.add_pages(n * sizeof(T), fresh);
  }

  /// As resize(n), but what is new may hold anything.
  void resize_for_overwrite(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / 2 / sizeof(T)) throw std::bad_alloc();
    if (n * sizeof(T) > memory_.bytes()) memory_.reserve((n + n / 4) * sizeof(T));
    touched_ = std::max(touched_, size_);
    size_ = n;
  }

  /// The same; pages for what is new, all of which is about to be written, are added to `fresh`.
  void resize_for_overwrite(std::size_t n, FreshMemory& fresh) {
    resize_for_overwrite(n);
    memory_.add_pages(n * sizeof(T), fresh);
  }

  /// Empties the array and leaves its memory to others to give back. Throws std::bad_alloc.
  void release(SpentMemory& spent) {
    const std::size_t used = std::max(size_, touched_) * sizeof(T);
    spent.parts_.push_back({std::move(memory_), used});
    size_ = touched_ = 0;
  }

  /// Empties the array and gives its memory back by all threads of an executor.
  void release(const Executor& executor) {
    SpentMemory spent;
    release(spent);
    spent.give_back(executor);
  }

  /// Bytes there is room for; those never written take no memory, unless the array is small.
  std::size_t bytes() const { return memory_.bytes(); }

  friend bool operator==(const GrowingArray& a, const GrowingArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  detail::GrowingMemory memory_;
  std::size_t size_ = 0;
  std::size_t touched_ = 0;  // the largest size there was before the last change
};

}  // namespace ductile::runtime
