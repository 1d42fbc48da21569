#include "ductile/runtime/detail/buckets.hpp"

#include <algorithm>

namespace ductile::runtime::detail {

void sort_and_make_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace ductile::runtime::detail
