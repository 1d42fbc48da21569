/// @file
/// Slots: places for values that come and go, as many as asked for, made and touched first by many
/// threads. What they hold is kept until it is overwritten or there are to be more of them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// Thread safety: slots as the elements of an array; provide() one thread.
template <class T>
class Slots {
 public:
  Slots() = default;
  ~Slots() { release(); }
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  std::optional<T>& operator[](std::size_t i) { return begin_[i]; }
  const std::optional<T>& operator[](std::size_t i) const { return begin_[i]; }

  /// Sees to it that there are n slots; if there were fewer, all are empty afterwards.
  /// Throws std::bad_alloc.
  void provide(const Executor& executor, std::size_t n) {
    if (n <= size_) return;
    release();
    begin_ = std::allocator<std::optional<T>>().allocate(n);
    size_ = n;
    const auto make = [](auto* begin, auto* end) {
      std::uninitialized_value_construct(begin, end);
    };
    write_first(executor, begin_, n, make, {.grain = 256, .serial_below = 1024});
  }

 private:
  void release() {
    if (begin_ == nullptr) return;
    std::destroy_n(begin_, size_);
    std::allocator<std::optional<T>>().deallocate(begin_, size_);
    begin_ = nullptr;
    size_ = 0;
  }

  std::optional<T>* begin_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace ductile::runtime::detail
