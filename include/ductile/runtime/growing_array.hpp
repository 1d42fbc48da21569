/// @file
/// GrowingArray: an array for graphs that grow while they are worked on. Unless it is small, its
/// memory comes in pages directly from the system. On Linux, growing then uses reserved addresses
/// behind it or moves page table entries, and copies nothing. New pages are placed near the thread
/// that first writes them, unless a FreshMemory has requested them before.
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

  /// Makes room for at least this many bytes. Contents are kept but may move.
  void reserve(std::size_t bytes);

  /// Adds the pages of the first `bytes` bytes, except those added before, and a few more.
  void add_pages(std::size_t bytes, FreshMemory& fresh);

  /// Do its pages come directly from the system?
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
  std::size_t bytes_ = 0;  // usable
  std::size_t space_ = 0;  // of reserved addresses, at least bytes_; 0 if the memory is malloc's
  std::size_t added_ = 0;  // bytes whose pages have been requested
};

}  // namespace detail

template <class T>
requires(std::is_trivially_copyable_v<T> &&
         alignof(T) <= alignof(std::max_align_t)) class GrowingArray;

/// Memory that arrays no longer need. The system frees it page by page, so all threads free it in
/// one loop for all arrays; one thread alone would hold up the others.
class SpentMemory {
 public:
  /// Gives all of it back; otherwise the destructor does so on its own thread. Thread safety: one
  /// caller; runs on the executor.
  void give_back(const Executor& executor);

 private:
  template <class T>
  requires(std::is_trivially_copyable_v<T> &&
           alignof(T) <= alignof(std::max_align_t)) friend class GrowingArray;

  struct Part {
    detail::GrowingMemory memory;
    std::size_t used;  // in use, from the beginning
  };
  std::vector<Part> parts_;
};

/// Thread safety: elements as those of an array; changes of size, one thread.
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

  /// Shrinks, without giving back memory, or grows; new elements consist of zero bytes. Pointers
  /// into the array are valid until it grows. If it throws std::bad_alloc, the array is unchanged.
  void resize(std::size_t n) {
    const std::size_t before = size_;
    resize_for_overwrite(n);
    if (n > before)  // clear leftovers from before it shrank
      std::fill(reinterpret_cast<std::byte*>(data() + before),
                reinterpret_cast<std::byte*>(data() + std::max(before, std::min(n, touched_))),
                std::byte{0});
  }

  /// The same, except that the array may have n elements if it throws; adds the pages of new
  /// elements to `fresh`. Use it for elements that are read before most are written: a page that is
  /// read first is mapped twice, and writing it later interrupts every thread.
  void resize(std::size_t n, FreshMemory& fresh) {
    resize(n);
    memory_.add_pages(n * sizeof(T), fresh);
  }

  /// As resize(n), but new elements are uninitialised.
  void resize_for_overwrite(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / 2 / sizeof(T)) throw std::bad_alloc();
    if (n * sizeof(T) > memory_.bytes()) memory_.reserve((n + n / 4) * sizeof(T));
    touched_ = std::max(touched_, size_);
    size_ = n;
  }

  /// The same; adds the pages of the new elements, all of which are about to be written, to
  /// `fresh`.
  void resize_for_overwrite(std::size_t n, FreshMemory& fresh) {
    resize_for_overwrite(n);
    memory_.add_pages(n * sizeof(T), fresh);
  }

  /// Empties the array and moves its memory to `spent`, to be freed later. Throws std::bad_alloc.
  void release(SpentMemory& spent) {
    const std::size_t used = std::max(size_, touched_) * sizeof(T);
    spent.parts_.push_back({std::move(memory_), used});
    size_ = touched_ = 0;
  }

  /// Empties the array and frees its memory on all threads of an executor.
  void release(const Executor& executor) {
    SpentMemory spent;
    release(spent);
    spent.give_back(executor);
  }

  /// Capacity in bytes; parts never written take no memory, unless the array is small.
  std::size_t bytes() const { return memory_.bytes(); }

  friend bool operator==(const GrowingArray& a, const GrowingArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  detail::GrowingMemory memory_;
  std::size_t size_ = 0;
  std::size_t touched_ = 0;  // the largest size before the last change
};

}  // namespace ductile::runtime
