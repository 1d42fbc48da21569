/// @file
/// Batch: an array of a fixed capacity that one thread fills and somebody else then empties.
/// Its memory comes with the first element and stays until release().
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace ductile::runtime::detail {

template <class T>
class Batch {
 public:
  Batch() = default;
  ~Batch() { release(); }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  bool full() const { return next_ == end_; }  ///< or without memory yet
  std::span<T> items() { return {begin_, next_}; }

  /// Precondition: !full(). Changes nothing if moving or copying the item throws.
  template <class Item>
  void append(Item&& item) {
    std::construct_at(next_, std::forward<Item>(item)), ++next_;
  }

  /// Precondition: no memory yet. Throws std::bad_alloc.
  void reserve(std::size_t capacity) {
    begin_ = next_ = std::allocator<T>().allocate(capacity);
    end_ = begin_ + capacity;
  }
  bool reserved() const { return begin_ != nullptr; }

  void clear() {
    if constexpr (!std::is_trivially_destructible_v<T>) std::destroy(begin_, next_);
    next_ = begin_;
  }
  void release() {
    clear();
    if (reserved()) std::allocator<T>().deallocate(begin_, static_cast<std::size_t>(end_ - begin_));
    begin_ = next_ = end_ = nullptr;
  }

 private:
  T* next_ = nullptr;
  T* end_ = nullptr;
  T* begin_ = nullptr;
};

}  // namespace ductile::runtime::detail
