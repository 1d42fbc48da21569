/// @file
/// ChunkList: an append-only list in chunks that double in length, so that elements never move
/// and memory is kept from one filling to the next. The building block of per-thread buffers.
/// Thread safety: one thread at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace ductile::runtime {

template <class T>
class ChunkList {
 public:
  ChunkList() = default;
  ~ChunkList() { rewind(); }
  ChunkList(const ChunkList&) = delete;
  ChunkList& operator=(const ChunkList&) = delete;

  /// No place for one more element; grow() makes some.
  bool full() const { return next_ == end_; }
  bool empty() const { return used_ == 0; }

  /// Adds T{arguments...}; changes nothing if that throws. Precondition: !full().
  template <class... Arguments>
  void append(Arguments&&... arguments) {
    // Where many lists grow in turn, the processor does not see by itself what comes next in each.
    const auto ahead = reinterpret_cast<std::uintptr_t>(next_) + write_ahead;
    __builtin_prefetch(reinterpret_cast<const void*>(ahead), 1);
    ::new (static_cast<void*>(next_)) T{std::forward<Arguments>(arguments)...};
    ++next_;
  }

  /// Starts the next chunk. Precondition: full(). Throws std::bad_alloc and changes nothing then.
  void grow() {
    if (used_ == chunks_.size()) add_chunk();
    const Chunk& chunk = chunks_[used_++];
    next_ = chunk.begin;
    end_ = chunk.begin + chunk.capacity;
  }

  std::size_t size() const {
    if (used_ == 0) return 0;
    std::size_t sum = static_cast<std::size_t>(next_ - chunks_[used_ - 1].begin);
    for (std::size_t c = 0; c + 1 < used_; ++c) sum += chunks_[c].capacity;
    return sum;
  }

  /// Calls visit(element) for all elements in the order they were appended.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (std::size_t c = 0; c < used_; ++c) {
      T* const end = c + 1 == used_ ? next_ : chunks_[c].begin + chunks_[c].capacity;
      for (T* element = chunks_[c].begin; element != end; ++element) visit(*element);
    }
  }

  /// Removes all elements and keeps the memory.
  void rewind() {
    if constexpr (!std::is_trivially_destructible_v<T>)
      for_each([](T& element) { std::destroy_at(&element); });
    used_ = 0;
    next_ = end_ = nullptr;
  }

  /// Removes all elements and gives the memory back.
  void release() {
    rewind();
    std::vector<Chunk>().swap(chunks_);
  }

 private:
  struct Chunk {
    std::size_t capacity;
    T* begin;
    Chunk(std::size_t n) : capacity(n), begin(std::allocator<T>().allocate(n)) {}
    Chunk(Chunk&& other) noexcept
        : capacity(other.capacity), begin(std::exchange(other.begin, nullptr)) {}
    Chunk& operator=(Chunk&&) = delete;
    ~Chunk() {
      if (begin != nullptr) std::allocator<T>().deallocate(begin, capacity);
    }
  };

  static constexpr std::size_t write_ahead = 512;  // bytes
  static constexpr std::size_t first_capacity = std::max<std::size_t>(1, 512 / sizeof(T));
  static constexpr std::size_t last_capacity = std::max<std::size_t>(1, 65536 / sizeof(T));

  void add_chunk() {
    const std::size_t n = chunks_.empty() ? first_capacity : 2 * chunks_.back().capacity;
    chunks_.emplace_back(std::min(n, last_capacity));
  }

  T* next_ = nullptr;     // where the next element goes, in chunks_[used_ - 1]
  T* end_ = nullptr;      // end of that chunk
  std::size_t used_ = 0;  // chunks with elements
  std::vector<Chunk> chunks_;
};

}  // namespace ductile::runtime
