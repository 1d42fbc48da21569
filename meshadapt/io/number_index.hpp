/// @file
/// NumberIndex: finds the place of a number in a list, because files number nodes and cells freely.
/// It takes memory in proportion to the list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace ductile::meshadapt {

class NumberIndex {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  NumberIndex() = default;
  explicit NumberIndex(const std::vector<std::uint64_t>& numbers);

  /// The place of the number, or none. Thread safety: any thread.
  std::size_t find(std::uint64_t number) const;
  /// The place of a number that is in the list twice, or none.
  std::size_t repeated() const { return repeated_; }

 private:
  std::uint64_t first_ = 0;
  bool is_dense_ = true;
  std::size_t repeated_ = none;
  std::vector<std::size_t> place_of_;                          ///< [number - first_], if dense
  std::vector<std::pair<std::uint64_t, std::size_t>> sorted_;  ///< otherwise
};

}  // namespace ductile::meshadapt
