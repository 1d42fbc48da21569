/// @file
/// AllNumbers: work that takes no memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ductile::runtime {

/// 0, 1, ..., size() - 1.
class AllNumbers {
 public:
  explicit AllNumbers(std::size_t count) : count_(count) {}
  std::size_t size() const { return count_; }
  std::uint32_t operator[](std::size_t i) const { return static_cast<std::uint32_t>(i); }

 private:
  std::size_t count_;
};

}  // namespace ductile::runtime
